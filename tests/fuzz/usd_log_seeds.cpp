// SPDX-License-Identifier: MIT
// Writes uSD logs, versions 1 and 2, closed and not, into a folder, for the fuzzer to begin with: usd_log_seeds DIR
#include <cstdint>
#include <string>

#include "fuzz/seeds.hpp"
#include "pinnquad/exported/checksum.hpp"

namespace {

std::string number(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(static_cast<unsigned char>(value >> (8 * i)));
  return text;
}
std::string name(const std::string& text) { return text + '\0'; }

/// Two kinds of events, and rows of both.
std::string log(unsigned version) {
  const int clock_bytes = version == 1 ? 4 : 8;
  std::string bytes = "\xbc" + number(version, 2) + number(2, 2);
  bytes += number(7, 2) + name("pose") + number(3, 2) + name("x(f)") + name("n(H)") + name("i(b)");
  bytes += number(9, 2) + name("motors") + number(2, 2) + name("m1(h)") + name("m2(I)");
  for (std::uint64_t row = 1; row <= 3; ++row) {
    bytes += number(7, 2) + number(1000 * row, clock_bytes) + number(0x3fc00000, 4) + number(row, 2) + number(255, 1);
    bytes += number(9, 2) + number(1000 * row + 1, clock_bytes) + number(row, 2) + number(row << 16, 4);
  }
  return bytes;
}

}  // namespace

int main(int argument_count, char** arguments) {
  std::vector<std::string> seeds;
  for (const unsigned version : {1u, 2u}) {
    const std::string open = log(version);
    const std::uint32_t sum = pinnquad::crc32(reinterpret_cast<const unsigned char*>(open.data()), open.size());
    seeds.insert(seeds.end(), {open, open + number(sum, 4), open.substr(0, open.size() - 3)});
  }
  return pinnquad_test::write_seeds(argument_count, arguments, seeds);
}
