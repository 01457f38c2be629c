// SPDX-License-Identifier: MIT
#include "logs/csv_log.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <system_error>
#include <utility>
#include <vector>

#include "logs/list_cells.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/text_file.hpp"
#include "pinnquad/logs/flight_log.hpp"

namespace pinnquad::logs {
namespace {

/// "0,035": a number whose decimal mark is a comma.
bool has_decimal_comma(std::string_view cell) {
  const std::size_t comma = cell.find(',');
  if (comma == std::string_view::npos || cell.find(',', comma + 1) != std::string_view::npos) return false;
  std::string with_point(cell);
  with_point[comma] = '.';
  double ignored = 0;
  return parse_number(with_point, ignored);
}

/// One pass over a table. A column is of numbers until a cell is none.
class Table {
 public:
  static constexpr std::size_t no_text = static_cast<std::size_t>(-1);

  Table(const std::string& path, const LogSelection& selection) : path_(path), selection_(selection), records_(path) {
    std::error_code ignored;
    bytes_ = std::filesystem::file_size(path, ignored);
    read_header();
    most_rows_ = detail::most_records(path, names_.size());
    first_text_.assign(names_.size(), no_text);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const auto& labels = selection.label_columns;
      if (std::find(labels.begin(), labels.end(), names_[i]) != labels.end()) first_text_[i] = 0;
    }
  }

  const std::vector<std::string>& names() const noexcept { return names_; }
  /// Of each column, the first row whose cell is no number.
  const std::vector<std::size_t>& first_text() const noexcept { return first_text_; }
  void set_first_text(const std::vector<std::size_t>& first_text) { first_text_ = first_text; }
  /// False where a column turned out to be text when there were rows already: they are not among its texts.
  bool complete() const noexcept { return complete_; }

  /// The rows, without a clock. Throws InputError: a row of other length, a decimal comma.
  LogTopic read() {
    const std::size_t size = names_.size();
    std::vector<std::vector<double>> numbers(size);
    std::vector<std::vector<std::string>> texts(size);
    LogTopic topic;
    topic.file = path_;
    topic.place.reserve(most_rows_);
    for (; records_.next(record_); topic.place.push_back(records_.line())) {
      if (topic.place.size() % rows_per_report == 0) report();
      if (is_blank(record_)) {
        require_end();
        break;
      }
      records_.split(record_, cells_);
      if (cells_.size() != size) refuse_length();
      for (std::size_t i = 0; i < size; ++i) {
        double value = 0;
        if (first_text_[i] == no_text && !cell_number(cells_[i], value)) {
          if (has_decimal_comma(cells_[i])) refuse_decimal_comma(i + 1, cells_[i]);
          first_text_[i] = topic.place.size();
          complete_ = complete_ && topic.place.empty();
        }
        if (first_text_[i] != no_text) {
          texts[i].emplace_back(cells_[i]);
        } else {
          if (numbers[i].empty()) numbers[i].reserve(most_rows_);  // growing would hold a column twice
          numbers[i].push_back(value);
        }
      }
    }
    for (std::size_t i = 0; i < size; ++i) {
      if (first_text_[i] != no_text) {
        topic.texts.push_back({names_[i], std::move(texts[i]), first_text_[i]});
      } else {
        topic.columns.push_back({names_[i], std::move(numbers[i])});
      }
    }
    return topic;
  }

 private:
  static constexpr std::size_t rows_per_report = 4096;

  static bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r") == std::string_view::npos; }

  void report() {
    if (bytes_ > 0) selection_.report(static_cast<double>(records_.bytes()) / static_cast<double>(bytes_));
  }

  void read_header() {
    constexpr std::size_t most_columns = 10000;
    if (!records_.next(record_) || is_blank(record_)) {
      throw InputError(path_, 1, 0, "a header that names the columns",
                       records_.bytes() == bytes_ ? "an empty file" : "an empty line");
    }
    refuse_other_separators();
    records_.split(record_, cells_);
    if (cells_.size() > most_columns) {
      throw InputError(path_, 1, 0, "at most " + std::to_string(most_columns) + " columns",
                       std::to_string(cells_.size()));
    }
    names_.assign(cells_.begin(), cells_.end());
    std::map<std::string_view, std::size_t> first;
    bool all_numbers = true;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      double ignored = 0;
      all_numbers = all_numbers && cell_number(names_[i], ignored);
      const auto [same, is_new] = first.emplace(names_[i], i + 1);
      if (!is_new && !names_[i].empty()) {
        throw InputError(path_, 1, i + 1, "columns of different names",
                         quoted_cell(names_[i]) + " again (the first is column " + std::to_string(same->second) + ")");
      }
    }
    if (all_numbers) throw InputError(path_, 1, 0, "a header that names the columns", "numbers");
  }

  /// Semicolons and tabs between the cells: where there is a decimal comma too, the message points at it.
  void refuse_other_separators() {
    const auto count = [this](char c) { return std::count(record_.begin(), record_.end(), c); };
    const char separator = count(';') > count(',') ? ';' : '\t';
    if (count(separator) <= count(',')) return;
    const std::string what = separator == ';' ? "semicolons" : "tabs";
    while (records_.next(record_)) {
      std::size_t column = 1;
      for (std::string_view rest = record_;; ++column) {
        const std::size_t end = rest.find(separator);
        const std::string_view cell = rest.substr(0, end);
        if (has_decimal_comma(detail::trimmed(cell))) refuse_decimal_comma(column, cell, " between " + what);
        if (end == std::string_view::npos) break;
        rest.remove_prefix(end + 1);
      }
    }
    throw InputError(path_, 1, 0, "commas between the cells (export the table with them)", what);
  }

  [[noreturn]] void refuse_decimal_comma(std::size_t column, std::string_view cell, const std::string& where = "") {
    throw InputError(path_, records_.line(), column,
                     "numbers with a decimal point, commas between the cells (export the table so)",
                     quoted_cell(cell) + where);
  }

  [[noreturn]] void refuse_length() {
    const bool twice = cells_.size() == 2 * names_.size() || (cells_.size() > names_.size() + 3 && names_.size() > 3);
    throw InputError(path_, records_.line(), std::min(cells_.size(), names_.size()) + 1,
                     std::to_string(names_.size()) + " cells as in the header",
                     std::to_string(cells_.size()) + (twice ? " (are there decimal commas?)" : ""));
  }

  /// Empty lines may only be the last ones.
  void require_end() {
    const std::size_t line = records_.line();
    while (records_.next(record_)) {
      if (!is_blank(record_)) throw InputError(path_, line, 0, "a row", "an empty line");
    }
  }

  std::string path_;
  const LogSelection& selection_;
  detail::CsvRecords records_;
  std::uintmax_t bytes_ = 0;
  std::size_t most_rows_ = 0;
  std::string_view record_;
  std::vector<std::string_view> cells_;
  std::vector<std::string> names_;
  std::vector<std::size_t> first_text_;
  bool complete_ = true;
};

/// Seconds by the column that is the clock.
void set_clock(LogTopic& topic, const Table& table, const LogSelection& selection) {
  topic.time_s.assign(topic.place.size(), std::numeric_limits<double>::quiet_NaN());
  if (selection.clock_column.empty()) return;
  const auto& names = table.names();
  const auto named = std::find(names.begin(), names.end(), selection.clock_column);
  if (named == names.end()) {
    throw InputError(topic.file, 1, 0, "a column named " + selection.clock_column,
                     "none of that name among " + std::to_string(names.size()) + " columns");
  }
  const LogColumn* const clock = topic.column(selection.clock_column);
  if (clock == nullptr) {
    const LogText* const text = topic.text(selection.clock_column);
    throw InputError(topic.file, static_cast<std::size_t>(topic.place[text->first_text]),
                     static_cast<std::size_t>(named - names.begin()) + 1,
                     "a number in column " + selection.clock_column, quoted_cell(text->values[text->first_text]));
  }
  for (std::size_t i = 0; i < topic.size(); ++i) topic.time_s[i] = clock->values[i] / selection.clock_ticks_per_s;
}

}  // namespace

bool cell_number(std::string_view cell, double& value) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  if (parse_number(cell, value)) return true;
  const bool minus = !cell.empty() && cell[0] == '-';
  if (!cell.empty() && (minus || cell[0] == '+')) cell.remove_prefix(1);
  std::string word;
  if (cell.size() <= 8) {
    for (const char c : cell) word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (cell.empty() || word == "nan") {
    value = nan;
  } else if (word == "inf" || word == "infinity") {
    value = minus ? -infinity : infinity;
  } else {
    return false;
  }
  return true;
}

LogTopic read_csv_topic(const std::string& path, const LogSelection& selection) {
  Table table(path, selection);
  LogTopic topic = table.read();
  if (!table.complete()) {
    Table again(path, selection);
    again.set_first_text(table.first_text());
    topic = again.read();
  }
  expand_lists(topic);
  set_clock(topic, table, selection);
  return topic;
}

FlightLog read_csv_log(const std::string& path, const LogSelection& selection) {
  FlightLog log;
  log.source = path;
  log.topics.push_back(read_csv_topic(path, selection));
  if (log.topics[0].place.empty()) throw InputError(path, 2, 0, "a row of data", "none");
  return log;
}

}  // namespace pinnquad::logs
