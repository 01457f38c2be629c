// SPDX-License-Identifier: MIT
// libFuzzer target over the readers of blackbox and DataFlash logs: whatever the bytes, there are topics whose columns
// are as long as their clock, with what was lost said in a line, or one line that says what is wrong. Build and run:
// scripts/heavy/fuzz.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/fuzzing.hpp"
#include "fuzz/log_rules.hpp"
#include "logs/blackbox.hpp"
#include "logs/dataflash.hpp"
#include "pinnquad/io/file_error.hpp"

namespace {

using pinnquad::logs::FlightLog;
using pinnquad::logs::LogSelection;

pinnquad_test::Tally tally;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<char> memory(data, data + size);  // of its own: the sanitizer sees a read past the end
  const std::string_view bytes(memory.data(), memory.size());
  const bool is_dataflash = pinnquad::logs::is_dataflash_log(bytes);
  try {
    LogSelection selection;
    const std::size_t flights = is_dataflash ? 1 : pinnquad::logs::blackbox_flights(bytes).size();
    for (; selection.flight < std::min<std::size_t>(flights, 3); ++selection.flight) {
      const FlightLog log = is_dataflash ? pinnquad::logs::parse_dataflash(bytes, "x.bin", selection)
                                         : pinnquad::logs::parse_blackbox(bytes, "x.bbl", selection);
      pinnquad_test::expect_sound(log, size);
      ++tally.count[log.topics.empty() ? "no row" : log.warnings.empty() ? "ok" : "with a warning"];
    }
  } catch (const pinnquad::InputError& error) {
    pinnquad_test::expect_one_line(error.what());
    ++tally.count["refused"];
  }
  return 0;
}
