// SPDX-License-Identifier: MIT
#include "pinnquad/exported/checksum.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <random>
#include <vector>

using pinnquad::crc32;

namespace {

constexpr std::array<unsigned char, 9> digits = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};

/// The definition, bit by bit: polynomial division, most significant bit first, of the reflected bytes.
std::uint32_t crc32_by_definition(const std::vector<unsigned char>& bytes) {
  std::vector<int> bits;
  for (const unsigned char byte : bytes) {
    for (int bit = 0; bit < 8; ++bit) bits.push_back((byte >> bit) & 1);
  }
  for (int bit = 0; bit < 32; ++bit) bits.push_back(0);
  for (std::size_t bit = 0; bit < 32; ++bit) bits[bit] ^= 1;
  for (std::size_t first = 0; first + 32 < bits.size(); ++first) {
    if (bits[first] == 0) continue;
    for (std::size_t power = 0; power <= 32; ++power) {
      const bool term = power == 0 || ((0x04c11db7u >> (32 - power)) & 1u) != 0;
      if (term) bits[first + power] ^= 1;
    }
  }
  std::uint32_t remainder = 0;
  for (std::size_t bit = 0; bit < 32; ++bit) {
    remainder |= static_cast<std::uint32_t>(bits[bits.size() - 32 + bit]) << bit;
  }
  return ~remainder;
}

}  // namespace

TEST_CASE("the check value of CRC-32, at compile time") {
  static_assert(crc32(digits.data(), digits.size()) == 0xcbf43926u);
  static_assert(crc32(digits.data(), 0) == 0);
  CHECK(crc32_by_definition({digits.begin(), digits.end()}) == 0xcbf43926u);
}

TEST_CASE("as by definition for bytes of any length, and piece by piece") {
  std::mt19937 engine(1);
  for (std::size_t length = 1; length < 200; length += 7) {
    std::vector<unsigned char> bytes(length);
    for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(engine() & 255u);
    const std::uint32_t whole = crc32(bytes.data(), length);
    CHECK(whole == crc32_by_definition(bytes));
    const std::size_t part = length / 3;
    CHECK(crc32(bytes.data() + part, length - part, crc32(bytes.data(), part)) == whole);
  }
}
