// SPDX-License-Identifier: MIT
// libFuzzer target over a Crazyflie's uSD logs: whatever the bytes, there are topics whose columns are as long as their
// clock, or one line that says what is wrong; and a log that ends early has the rows of the whole one, up to there.
// Build and run: scripts/heavy/fuzz.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

#include "fuzz/fuzzing.hpp"
#include "fuzz/memory_file.hpp"
#include "logs/usd_log.hpp"
#include "pinnquad/io/file_error.hpp"

namespace {

using pinnquad::logs::FlightLog;
using pinnquad_test::expect;

pinnquad_test::Tally tally;

std::optional<FlightLog> read(const std::string& bytes) {
  const pinnquad_test::MemoryFile file(bytes);
  try {
    return pinnquad::logs::read_usd_log(file.path());
  } catch (const pinnquad::InputError& error) {
    pinnquad_test::expect_one_line(error.what());
    return std::nullopt;
  }
}

std::size_t rows(const FlightLog& log) {
  std::size_t all = 0;
  for (const auto& topic : log.topics) {
    expect(topic.place.size() == topic.size(), "each row has a place");
    for (const auto& column : topic.columns) {
      expect(column.values.size() == topic.size(), "columns are as long as the clock");
    }
    all += topic.size();
  }
  return all;
}

bool same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const std::optional<FlightLog> log = read(bytes);
  if (!log) {
    ++tally.count["refused"];
    return 0;
  }
  const std::size_t all = rows(*log);
  ++tally.count[all > 0 ? "ok" : "no row"];
  const std::optional<FlightLog> early = read(bytes.substr(0, size - 1 - size % 7));
  if (!early) return 0;  // its head is not whole
  expect(early->topics.size() == log->topics.size(), "a whole head names the same topics");
  expect(rows(*early) <= all, "a log that ends early has no more rows");
  for (std::size_t i = 0; i < log->topics.size(); ++i) {
    for (std::size_t row = 0; row < early->topics[i].size(); ++row) {
      expect(same(early->topics[i].time_s[row], log->topics[i].time_s[row]), "a row is what it was in the whole log");
    }
  }
  return 0;
}
