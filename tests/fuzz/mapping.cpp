// SPDX-License-Identifier: MIT
// libFuzzer target over mappings of flight logs: whatever the bytes, there is a mapping or one line that says what is
// wrong; and what a mapping makes of a small table and of a log of topics are rows of finite numbers, or one line.
// Build and run: scripts/heavy/fuzz.
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "fuzz/fuzzing.hpp"
#include "fuzz/line_mutator.hpp"
#include "logs/derived_motion.hpp"
#include "logs/log_parts.hpp"
#include "logs/mapping.hpp"
#include "logs/row_checks.hpp"
#include "pinnquad/io/file_error.hpp"

namespace {

using pinnquad_test::expect;

pinnquad_test::Tally tally;
pinnquad_test::LineMutator lines;

/// Columns of a topic by which any of its quantities could be told, some with cells that are no number.
pinnquad::logs::LogTopic topic(const std::string& name, std::size_t rows, double period_s) {
  pinnquad::logs::LogTopic result;
  result.name = name;
  result.file = "memory";
  const char* names[] = {"t", "a", "b", "c", "d", "e", "f"};
  for (const char* column : names) result.columns.push_back({column, {}});
  result.texts.push_back({"flight", {}, 0});
  for (std::size_t row = 0; row < rows; ++row) {
    const double t = static_cast<double>(row) * period_s;
    result.time_s.push_back(name.empty() ? std::nan("") : t);
    result.place.push_back(row + 2);
    result.columns[0].values.push_back(t);
    result.columns[1].values.push_back(row % 17 == 3 ? std::nan("") : 0.9 * std::cos(t));
    result.columns[2].values.push_back(0.9 * std::sin(t));
    result.columns[3].values.push_back(0.1 * std::cos(3 * t));
    result.columns[4].values.push_back(0.1 * std::sin(3 * t) + 0.4);
    result.columns[5].values.push_back(1500 + 100 * std::sin(t));
    result.columns[6].values.push_back(-9.8 + (row % 23 == 5 ? 1e300 : 0.0));
    result.texts[0].values.push_back(row < rows / 2 ? "one" : "two");
  }
  return result;
}

const pinnquad::logs::FlightLog& log() {
  static const pinnquad::logs::FlightLog made = [] {
    pinnquad::logs::FlightLog result;
    result.source = "memory";
    result.topics.push_back(topic("", 80, 0.01));
    result.topics.push_back(topic("x", 30, 0.03));
    return result;
  }();
  return made;
}

void use(const pinnquad::logs::Mapping& mapping) {
  for (pinnquad::logs::LogPart& part : pinnquad::logs::parts_of(log(), "log", mapping)) {
    pinnquad::logs::BoundLog bound = pinnquad::logs::bind_log(part.log, mapping, std::nullopt);
    pinnquad::logs::CommonRows rows = pinnquad::logs::common_rows(bound, std::nullopt, mapping.file.empty());
    const double period_s = rows.period_s;
    const std::size_t all = rows.rows();
    const pinnquad::logs::LogRows made = pinnquad::logs::rows_of_log(std::move(rows), bound, mapping, "log");
    expect(made.flight.size() + made.incomplete + made.window_ends == all, "every row is kept or counted");
    const pinnquad::logs::RowMask out = pinnquad::logs::on_the_ground(made, mapping, period_s);
    expect(out.size() == made.flight.size(), "a rule speaks of every row");
    for (const pinnquad::Sample& sample : made.flight) {
      for (const double u : sample.commands) expect(u >= 0 && u <= 1, "commands are 0 to 1");
    }
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  return lines(data, size, max_size, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const pinnquad::logs::Mapping mapping =
        pinnquad::logs::parse_mapping(std::string(reinterpret_cast<const char*>(data), size), "mapping.toml");
    ++tally.count["ok"];
    lines.accepted(data, size);
    use(mapping);
    ++tally.count["used"];
  } catch (const pinnquad::InputError& error) {
    pinnquad_test::expect_one_line(error.what());
    ++tally.count["refused"];
  }
  return 0;
}
