// SPDX-License-Identifier: MIT
// libFuzzer target over airframe files: whatever the bytes, there is an airframe that can hover, or one line that says
// what is wrong; and an airframe that was read, written down and read again has the same numbers.
// Build and run: scripts/heavy/fuzz.
#include <cstdint>
#include <string>

#include "airframe/toml_writer.hpp"
#include "fuzz/fuzzing.hpp"
#include "fuzz/line_mutator.hpp"
#include "fuzz/memory_file.hpp"
#include "pinnquad/io/file_error.hpp"

namespace {

using pinnquad_test::expect;
using pinnquad_test::MemoryFile;

pinnquad_test::Tally tally;
pinnquad_test::LineMutator lines;

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  return lines(data, size, max_size, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(std::string(reinterpret_cast<const char*>(data), size));
  programs::NamedAirframe airframe;
  try {
    airframe = programs::read_airframe_file(file.path());
  } catch (const pinnquad::InputError& error) {
    pinnquad_test::expect_one_line(error.what());
    ++tally.count["refused"];
    return 0;
  }
  ++tally.count["ok"];
  lines.accepted(data, size);
  expect(check_airframe(airframe.value) == pinnquad::Status::ok, "an airframe that was read is sound");
  const MemoryFile again(programs::airframe_toml(airframe));
  const programs::NamedAirframe read = programs::read_airframe_file(again.path());
  expect(read.name == airframe.name, "the name survives");
  expect(pinnquad::logs::same_numbers(read.value, airframe.value), "the numbers survive");
  return 0;
}
