// SPDX-License-Identifier: MIT
#include "logs/csv_log.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <system_error>
#include <utility>
#include <vector>

#include "logs/csv_head.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/text_file.hpp"
#include "pinnquad/logs/flight_log.hpp"

namespace pinnquad::logs {
namespace {

/// One pass over a table. A column is of numbers until a cell is none.
class Table {
 public:
  static constexpr std::size_t no_text = static_cast<std::size_t>(-1);

  /// `may_be_cut`: a last row without a line end is left out, for a logger that lost its power leaves such rows.
  Table(const std::string& path, const LogSelection& selection, bool may_be_cut)
      : path_(path), selection_(selection), records_(path) {
    std::error_code ignored;
    bytes_ = std::filesystem::file_size(path, ignored);
    const int last = last_byte(path);
    ends_in_row_ = may_be_cut && last != '\n' && last != '\r';
    head_ = csv_head(path);
    names_ = head_.names;
    for (std::size_t i = 0; i < head_.records; ++i) records_.next(record_);
    most_rows_ = detail::most_records(path, names_.size());
    first_text_.assign(names_.size(), no_text);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const auto& labels = selection.label_columns;
      if (std::find(labels.begin(), labels.end(), names_[i]) != labels.end()) first_text_[i] = 0;
    }
  }

  const CsvHead& head() const noexcept { return head_; }
  /// Of each column, the first row whose cell is no number.
  const std::vector<std::size_t>& first_text() const noexcept { return first_text_; }
  void set_first_text(const std::vector<std::size_t>& first_text) { first_text_ = first_text; }
  /// The last row, where the file ends before its line does; 0: none. It is not among the rows.
  std::size_t cut_line() const noexcept { return cut_line_; }
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
      if (head_.separator == ',') {
        records_.split(record_, cells_);
      } else {
        split_cells(record_, head_.separator, cells_);
      }
      if (cells_.size() <= size && ends_in_row_ && records_.bytes() >= bytes_) {
        cut_line_ = records_.line();
        break;
      }
      if (cells_.size() != size) refuse_length();
      for (std::size_t i = 0; i < size; ++i) {
        double value = 0;
        if (first_text_[i] == no_text && !cell_number(cells_[i], value, head_.separator)) {
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
        topic.columns.push_back({names_[i], std::move(numbers[i]), head_.units.empty() ? "" : head_.units[i]});
      }
    }
    return topic;
  }

 private:
  static constexpr std::size_t rows_per_report = 4096;

  static int last_byte(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    file.seekg(-1, std::ios::end);
    return file.get();
  }

  void report() {
    if (bytes_ > 0) selection_.report(static_cast<double>(records_.bytes()) / static_cast<double>(bytes_));
  }

  [[noreturn]] void refuse_decimal_comma(std::size_t column, std::string_view cell) {
    throw InputError(path_, records_.line(), column,
                     "numbers with a decimal point, or semicolons between the cells (export the table so)",
                     quoted_cell(cell));
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
  CsvHead head_;
  std::vector<std::string_view> cells_;
  std::vector<std::string> names_;
  std::vector<std::size_t> first_text_;
  bool complete_ = true, ends_in_row_ = false;
  std::size_t cut_line_ = 0;
};

constexpr std::size_t most_numbers = 64, most_depth = 4;

/// The numbers of a list and the place of each: "[1][0]". False if the text is no list of numbers.
bool read_list(std::string_view text, std::vector<double>& numbers, std::vector<std::string>* places) {
  constexpr std::string_view between = ", \t\n\r";
  std::vector<std::size_t> counts;
  numbers.clear();
  const auto count_one = [&counts] {
    if (!counts.empty()) ++counts.back();
  };
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '[') {
      if (counts.size() == most_depth || (counts.empty() && i > 0)) return false;
      counts.push_back(0);
      ++i;
    } else if (text[i] == ']') {
      if (counts.empty()) return false;
      counts.pop_back();
      count_one();
      ++i;
      if (counts.empty()) return text.find_first_not_of(between, i) == std::string_view::npos && !numbers.empty();
    } else if (between.find(text[i]) != std::string_view::npos) {
      ++i;
    } else {
      const std::size_t end = text.find_first_of(", \t\n\r[]", i);
      double value = 0;
      if (counts.empty() || end == std::string_view::npos || numbers.size() == most_numbers) return false;
      if (!cell_number(text.substr(i, end - i), value)) return false;
      numbers.push_back(value);
      if (places != nullptr) {
        std::string place;
        for (const std::size_t count : counts) place += '[' + std::to_string(count) + ']';
        places->push_back(std::move(place));
      }
      count_one();
      i = end;
    }
  }
  return false;
}

/// A column of lists becomes columns of numbers: p[0], p[1], p[2]; of a matrix R[0][0], R[0][1] ... Numbers stand
/// between commas or blanks. Columns of other text stay, those too whose lists are not of one length.
void expand_lists(LogTopic& topic) {
  std::vector<LogText> texts;
  for (LogText& text : topic.texts) {
    std::vector<double> numbers;
    std::vector<std::string> places;
    if (text.values.empty() || !read_list(text.values[0], numbers, &places)) {
      texts.push_back(std::move(text));
      continue;
    }
    std::vector<std::vector<double>> values(numbers.size());
    std::size_t row = 0;
    for (; row < text.values.size(); ++row) {
      if (!read_list(text.values[row], numbers, nullptr) || numbers.size() != values.size()) break;
      for (std::size_t i = 0; i < values.size(); ++i) values[i].push_back(numbers[i]);
    }
    if (row < text.values.size()) {
      text.first_text = row;
      texts.push_back(std::move(text));
      continue;
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      // a list of one number is that number
      topic.columns.push_back({values.size() == 1 ? text.name : text.name + places[i], std::move(values[i])});
    }
  }
  topic.texts = std::move(texts);
}

/// Seconds by the column that is the clock.
void set_clock(LogTopic& topic, const Table& table, const LogSelection& selection) {
  topic.time_s.assign(topic.place.size(), std::numeric_limits<double>::quiet_NaN());
  if (selection.clock_column.empty()) return;
  const auto& names = table.head().names;
  const auto named = std::find(names.begin(), names.end(), selection.clock_column);
  if (named == names.end()) {
    throw InputError(topic.file, table.head().line, 0, "a column named " + selection.clock_column,
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

/// `cut_line`: null where a last row without a line end is as any other; else its line, 0 for none.
LogTopic read_table(const std::string& path, const LogSelection& selection, CsvHead& head, std::size_t* cut_line) {
  Table table(path, selection, cut_line != nullptr);
  head = table.head();
  LogTopic topic = table.read();
  if (cut_line != nullptr) *cut_line = table.cut_line();
  if (!table.complete()) {
    Table again(path, selection, cut_line != nullptr);
    again.set_first_text(table.first_text());
    topic = again.read();
  }
  expand_lists(topic);
  set_clock(topic, table, selection);
  return topic;
}

}  // namespace

LogTopic read_csv_topic(const std::string& path, const LogSelection& selection) {
  CsvHead head;
  return read_table(path, selection, head, nullptr);
}

FlightLog read_csv_log(const std::string& path, const LogSelection& selection) {
  FlightLog log;
  log.source = path;
  CsvHead head;
  std::size_t cut_line = 0;
  log.topics.push_back(read_table(path, selection, head, &cut_line));
  if (log.topics[0].place.empty()) throw InputError(path, head.line + 1, 0, "a row of data", "none");
  for (const auto& [key, value] : head.facts) keep_parameters(log, key, value);
  if (cut_line > 0) {
    log.warnings.push_back(printable(std::filesystem::path(path).stem().string()) + ": line " +
                           std::to_string(cut_line) + ", the last, has no line end, so it may be cut: left out");
  }
  return log;
}

}  // namespace pinnquad::logs
