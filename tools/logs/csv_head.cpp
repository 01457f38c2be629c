// SPDX-License-Identifier: MIT
#include "logs/csv_head.hpp"

#include <algorithm>
#include <cctype>
#include <deque>
#include <limits>
#include <map>
#include <string_view>

#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/file_error.hpp"

namespace pinnquad::logs {
namespace {

constexpr std::size_t most_records_above = 2000;  // Blackbox Explorer writes 150 to 300 keys
constexpr std::size_t fewest_columns = 4;         // of a table under rows of another width

/// A record with its cells by the separator that has most of them.
struct Record {
  std::size_t line = 0;
  char separator = ',';
  bool blank = false, comment = false;
  std::string text;  ///< behind a comment's sign
  std::vector<std::string> cells;

  /// Its cells by another record's separator: in a row of numbers commas may be decimal ones.
  Record parted_as(const Record& names) const {
    if (separator == names.separator) return *this;
    Record other = *this;
    std::vector<std::string_view> parts;
    split_cells(text, names.separator, parts);
    other.separator = names.separator;
    other.cells.assign(parts.begin(), parts.end());
    return other;
  }

  std::size_t numbers() const {
    double ignored = 0;
    return static_cast<std::size_t>(std::count_if(cells.begin(), cells.end(), [&](const std::string& cell) {
      return !cell.empty() && cell != "-" && cell_number(cell, ignored, separator);
    }));
  }
  std::size_t filled() const {
    return static_cast<std::size_t>(
        std::count_if(cells.begin(), cells.end(), [](const std::string& cell) { return !cell.empty(); }));
  }
  bool is_names() const { return numbers() == 0 && filled() > 0; }
  /// As wide as the names, with numbers in half of what it holds, or more.
  bool is_row_below(const Record& names) const {
    const Record row = parted_as(names);
    return row.cells.size() == names.cells.size() && row.numbers() > 0 && 2 * row.numbers() >= row.filled();
  }
};

class Head {
 public:
  explicit Head(const std::string& path) : path_(path), records_(path) {}

  CsvHead read() {
    if (!has(0) || at(0).blank) {
      throw InputError(path_, 1, 0, "a header that names the columns", has(1) ? "an empty line" : "an empty file");
    }
    const std::size_t first = first_that_is_no_comment();
    std::size_t names = table_below(first);
    if (!has(names)) {
      throw InputError(path_, at(0).line, 0, "a header that names the columns", "comments alone");
    }
    // NumPy writes the names behind a comment's sign
    const bool commented =
        names > 0 && at(names - 1).comment && at(names - 1).is_names() && at(names).is_row_below(at(names - 1));
    if (commented) --names;
    return head_of(names);
  }

 private:
  bool has(std::size_t index) {
    std::string_view text;
    while (seen_.size() <= index) {
      if (!records_.next(text)) return false;
      seen_.push_back(record_of(text));
    }
    return true;
  }
  const Record& at(std::size_t index) const { return seen_[index]; }

  Record record_of(std::string_view text) {
    Record record;
    record.line = records_.line();
    record.blank = is_blank(text);
    const std::size_t begin = text.find_first_not_of(" \t");
    for (const std::string_view sign : {"#", "%", "//"}) {
      if (begin == std::string_view::npos || text.substr(begin, sign.size()) != sign) continue;
      record.comment = true;
      text.remove_prefix(begin + sign.size());
      break;
    }
    std::vector<std::string_view> cells;
    records_.split(text, cells);
    for (const char separator : {';', '\t'}) {
      std::vector<std::string_view> other;
      split_cells(text, separator, other);
      if (other.size() <= cells.size()) continue;
      record.separator = separator;
      cells = other;
    }
    record.text = text;
    record.cells.assign(cells.begin(), cells.end());
    return record;
  }

  std::size_t first_that_is_no_comment() {
    std::size_t first = 0;
    while (first < most_records_above && has(first) && (at(first).comment || at(first).blank)) ++first;
    return first;
  }

  /// The names of a wider table under rows of keys and values; `first` where its own rows follow.
  std::size_t table_below(std::size_t first) {
    if (!has(first)) return first;
    const bool own = has(first + 1) && at(first).cells.size() >= fewest_columns &&
                     at(first + 1).parted_as(at(first)).cells.size() == at(first).cells.size();
    for (std::size_t i = first + 1; !own && i < first + most_records_above && has(i + 1); ++i) {
      const Record& names = at(i);
      const bool wider = names.cells.size() >= std::max(fewest_columns, at(first).cells.size() + 1);
      if (!wider || !names.is_names() || names.filled() != names.cells.size()) continue;
      if (at(i + 1).is_row_below(names) || (has(i + 2) && is_units(i + 1, i))) return i;
    }
    return first;
  }

  /// Words below the names, and numbers below the words.
  bool is_units(std::size_t index, std::size_t names) {
    if (!has(index + 1)) return false;
    const Record record = at(index).parted_as(at(names));
    const bool is_short = std::all_of(record.cells.begin(), record.cells.end(),
                                      [](const std::string& cell) { return cell.size() <= 16; });
    return record.cells.size() == at(names).cells.size() && record.is_names() && is_short &&
           at(index + 1).is_row_below(at(names));
  }

  CsvHead head_of(std::size_t index) {
    constexpr std::size_t most_columns = 10000;
    const Record& record = at(index);
    CsvHead head;
    head.line = record.line;
    head.separator = record.separator;
    head.records = index + 1;
    head.names = record.cells;
    if (head.names.size() > most_columns) {
      throw InputError(path_, head.line, 0, "at most " + std::to_string(most_columns) + " columns",
                       std::to_string(head.names.size()));
    }
    std::map<std::string_view, std::size_t> first;
    for (std::size_t i = 0; i < head.names.size(); ++i) {
      const auto [same, is_new] = first.emplace(head.names[i], i + 1);
      if (!is_new && !head.names[i].empty()) {
        throw InputError(
            path_, head.line, i + 1, "columns of different names",
            quoted_cell(head.names[i]) + " again (the first is column " + std::to_string(same->second) + ")");
      }
    }
    if (record.numbers() > 0 && record.numbers() == record.filled()) {
      throw InputError(path_, head.line, 0, "a header that names the columns", "numbers");
    }
    if (has(index + 1) && is_units(index + 1, index)) {
      head.units = at(index + 1).parted_as(record).cells;
      for (std::string& unit : head.units) {
        if (unit.size() > 2 && (unit.front() == '[' || unit.front() == '(')) unit = unit.substr(1, unit.size() - 2);
      }
      head.records += 1;
    }
    for (std::size_t i = 0; i < index; ++i) {
      const auto& cells = at(i).cells;
      if (cells.size() < 2 || cells[0].empty() || at(i).comment) continue;
      std::string value = cells[1];
      for (std::size_t k = 2; k < cells.size(); ++k) value += "," + cells[k];
      head.facts.emplace_back(cells[0], value);
    }
    return head;
  }

  const std::string& path_;
  detail::CsvRecords records_;
  std::deque<Record> seen_;  // what it holds stays where it is
};

}  // namespace

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r") == std::string_view::npos; }

void keep_parameters(FlightLog& log, const std::string& key, const std::string& value) {
  std::vector<std::string_view> parts;
  split_cells(value, ',', parts);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    double number = 0;
    if (!parse_number(parts[i], number)) continue;
    log.parameters[parts.size() == 1 ? key : key + "[" + std::to_string(i) + "]"] = number;
  }
}

CsvHead csv_head(const std::string& path) { return Head(path).read(); }

void split_cells(std::string_view record, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= record.size(); ++i) {
    if (i < record.size() && record[i] == '"') quoted = !quoted;
    if (i < record.size() && (quoted || record[i] != separator)) continue;
    std::string_view cell = detail::trimmed(record.substr(begin, i - begin));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
    cells.push_back(cell);
    begin = i + 1;
  }
}

bool has_decimal_comma(std::string_view cell) {
  const std::size_t comma = cell.find(',');
  if (comma == std::string_view::npos || cell.find(',', comma + 1) != std::string_view::npos) return false;
  std::string with_point(cell);
  with_point[comma] = '.';
  double ignored = 0;
  return parse_number(with_point, ignored);
}

bool cell_number(std::string_view cell, double& value, char separator) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  if (parse_number(cell, value)) return true;
  if (separator != ',' && has_decimal_comma(cell)) {
    std::string with_point(cell);
    with_point[cell.find(',')] = '.';
    return parse_number(with_point, value);
  }
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

}  // namespace pinnquad::logs
