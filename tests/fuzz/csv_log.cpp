// SPDX-License-Identifier: MIT
// libFuzzer target over the reader of logs that are CSV tables: whatever the bytes, there is a topic whose columns are
// as long as its clock, or one line that says what is wrong; what was read, written down and read again is the same.
// Build and run: scripts/heavy/fuzz.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "fuzz/fuzzing.hpp"
#include "fuzz/memory_file.hpp"
#include "logs/csv_head.hpp"
#include "logs/csv_log.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/file_error.hpp"

namespace {

using pinnquad::logs::LogTopic;
using pinnquad_test::expect;
using pinnquad_test::MemoryFile;

pinnquad_test::Tally tally;

bool same(double a, double b) { return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0; }

std::string quoted(const std::string& text) {
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + '"';
}

/// The topic as a table: numbers, then texts, every text in quotation marks.
std::string written(const LogTopic& topic) {
  std::string table;
  const auto end_cell = [&table](std::size_t index, std::size_t count) { table += index + 1 < count ? ',' : '\n'; };
  const std::size_t numbers = topic.columns.size(), cells = numbers + topic.texts.size();
  for (std::size_t i = 0; i < cells; ++i) {
    table += quoted(i < numbers ? topic.columns[i].name : topic.texts[i - numbers].name);
    end_cell(i, cells);
  }
  for (std::size_t row = 0; row < topic.size(); ++row) {
    for (std::size_t i = 0; i < cells; ++i) {
      table += i < numbers ? pinnquad::number_text(topic.columns[i].values[row])
                           : quoted(topic.texts[i - numbers].values[row]);
      end_cell(i, cells);
    }
  }
  return table;
}

void check(const LogTopic& topic) {
  for (const auto& column : topic.columns)
    expect(column.values.size() == topic.size(), "columns are as long as the clock");
  for (const auto& text : topic.texts) {
    expect(text.values.size() == topic.size(), "texts are as long as the clock");
    expect(text.first_text < topic.size(), "a text has a cell that is no number");
    double ignored = 0;
    const bool is_list = text.values[0].substr(0, 1) == "[";  // among lists a number is another length
    expect(is_list || !pinnquad::logs::cell_number(text.values[text.first_text], ignored), "that cell is no number");
  }
  const MemoryFile file(written(topic));
  if (!pinnquad::logs::csv_head(file.path()).units.empty()) {  // words above numbers: the file had other separators
    ++tally.count["a first row that would be units"];
    return;
  }
  const LogTopic again = pinnquad::logs::read_csv_topic(file.path());
  expect(again.size() == topic.size() && again.columns.size() == topic.columns.size(), "written and read is the same");
  for (std::size_t i = 0; i < topic.columns.size(); ++i) {
    expect(again.columns[i].name == topic.columns[i].name, "names survive");
    for (std::size_t row = 0; row < topic.size(); ++row) {
      expect(same(again.columns[i].values[row], topic.columns[i].values[row]), "numbers survive");
    }
  }
  expect(again.texts.size() == topic.texts.size(), "texts survive");
  for (std::size_t i = 0; i < topic.texts.size(); ++i) {
    expect(again.texts[i].name == topic.texts[i].name && again.texts[i].values == topic.texts[i].values,
           "texts survive");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(std::string(reinterpret_cast<const char*>(data), size));
  try {
    pinnquad::logs::LogSelection selection;
    if (size % 2 == 0) selection.clock_column = "t";
    const LogTopic topic = pinnquad::logs::read_csv_topic(file.path(), selection);
    check(topic);
    ++tally.count[topic.size() > 0 ? "ok" : "no row"];
  } catch (const pinnquad::InputError& error) {
    pinnquad_test::expect_one_line(error.what());
    ++tally.count["refused"];
  }
  return 0;
}
