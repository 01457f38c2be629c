// SPDX-License-Identifier: MIT
// Tables of numbers as comma-separated text: a header that names the columns, then one row per line.
// Numbers are written with the fewest digits that read back to the same bits; no locale plays a part.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/csv_cells.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/text_file.hpp"

namespace pinnquad {

/// A table of numbers; every row as long as the header.
struct CsvTable {
  std::vector<std::string> header;
  std::vector<std::vector<double>> rows;
};

/// Field index (from 0) of each wanted column in the header line of a file. Throws InputError, one line, for a column that is
/// missing or there twice, and for cells between semicolons or tabs.
inline std::vector<std::size_t> locate_columns(const std::string& path, const std::vector<std::string_view>& header,
                                               const std::vector<std::string>& columns) {
  std::vector<std::size_t> fields;
  for (const std::string& name : columns) {
    const std::size_t missing = header.size();
    std::size_t found = missing;
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (header[i] != name) continue;
      if (found != missing) {
        throw InputError(path, 1, i + 1, "one column named " + name,
                         "a second one (the first is column " + std::to_string(found + 1) + ")");
      }
      found = i;
    }
    if (found == missing) {
      const bool semicolons = header.size() == 1 && header[0].find(';') != std::string_view::npos;
      const bool tabs = header.size() == 1 && header[0].find('\t') != std::string_view::npos;
      if (semicolons || tabs) {
        throw InputError(path, 1, 0, "commas between the cells (export the table with them)",
                         semicolons ? "semicolons" : "tabs");
      }
      throw InputError(path, 1, 0, "a column named " + name,
                       "none of that name among " + std::to_string(header.size()) + " columns");
    }
    fields.push_back(found);
  }
  return fields;
}

namespace detail {

/// The names of a file's columns as its header has them; none of an empty file.
inline std::vector<std::string> csv_header(const std::string& path) {
  CsvRecords records(path);
  std::string_view record;
  std::string unquoted;
  std::vector<std::string_view> cells;
  if (records.next(record)) {
    if (records.has_quotes()) {
      split_quoted_fields(record, cells, unquoted);
    } else {
      split_fields(record, cells);
    }
  }
  return {cells.begin(), cells.end()};
}

/// Reads the named columns and calls `on_row(values, line, fields)` for each row: its values in the order of `columns`,
/// its line, and the field index (from 0) of each column. Returns nothing: the callee keeps what it wants.
template <class OnRow>
void for_each_csv_row(const std::string& path, const std::vector<std::string>& columns, std::size_t minimum_rows,
                      OnRow on_row) {
  CsvRecords records(path);
  std::string_view record;
  std::string unquoted;
  std::vector<std::string_view> cells;
  const auto split = [&] {
    if (records.has_quotes()) {
      split_quoted_fields(record, cells, unquoted);
    } else {
      split_fields(record, cells);
    }
  };
  const auto is_blank = [](std::string_view text) { return text.find_first_not_of(" \t\r") == std::string_view::npos; };
  if (!records.next(record) || is_blank(record)) {
    while (records.next(record) && is_blank(record)) {
    }
    if (is_blank(record)) throw InputError(path, 1, 0, "a header that names the columns", "an empty file");
    record = {};
  }
  split();
  const std::size_t width = cells.size();
  const std::vector<std::size_t> fields = locate_columns(path, cells, columns);

  std::vector<double> values(columns.size());
  std::size_t rows = 0;
  const auto take_row = [&](std::size_t line) {
    split();
    if (cells.size() != width) {
      const std::size_t first_wrong = (cells.size() < width ? cells.size() : width) + 1;
      throw InputError(path, line, is_blank(record) ? 0 : first_wrong,
                       std::to_string(width) + " fields as in the header",
                       is_blank(record) ? "an empty line" : std::to_string(cells.size()));
    }
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (!parse_number(cells[fields[i]], values[i]) && !parse_number(trimmed(cells[fields[i]]), values[i])) {
        throw InputError(path, line, fields[i] + 1, "a finite number in column " + columns[i],
                         quoted_cell(cells[fields[i]]));
      }
    }
    on_row(std::as_const(values), line, fields);
    ++rows;
  };
  std::size_t last_line = 1;
  while (records.next(record)) {
    if (record.empty()) {  // allowed at the end of the file only
      const std::size_t empty_line = records.line();
      while (records.next(record) && record.empty()) {
      }
      if (record.empty()) break;
      record = {};
      take_row(empty_line);
      throw InputError(path, empty_line, 0, "a row", "an empty line");
    }
    take_row(records.line());
    last_line = records.line();
  }
  if (rows < minimum_rows) {
    throw InputError(path, last_line, 0, "at least " + std::to_string(minimum_rows) + " rows of data",
                     std::to_string(rows));
  }
}

}  // namespace detail

/// Reads the named columns of a table, in the order asked for. In the file they may stand in any order; other columns
/// are ignored and may hold text. LF and CRLF, a byte order mark, blanks around cells, empty lines at the end, quotation marks
/// as in RFC 4180: accepted. Throws InputError: no readable or an empty file, a missing or doubled column, a row of other
/// length, a cell that is empty, text, NaN, Inf or beyond the range of a double, fewer than `minimum_rows` rows.
inline CsvTable read_csv(const std::string& path, const std::vector<std::string>& columns,
                         std::size_t minimum_rows = 1) {
  CsvTable table;
  table.header = columns;
  detail::for_each_csv_row(path, columns, minimum_rows,
                           [&table](const std::vector<double>& values, std::size_t, const std::vector<std::size_t>&) {
                             table.rows.push_back(values);
                           });
  return table;
}

/// Writes a table row by row; the file appears whole, on commit(), or not at all. NaN and Inf are written as nan and inf
/// (gnuplot leaves them out; `read_csv` refuses them). Throws OutputError if the file cannot be written,
/// std::invalid_argument for a row of other length than the header and a column without a name.
class CsvWriter {
 public:
  CsvWriter(const std::string& path, const std::vector<std::string>& header) : file_(path), width_(header.size()) {
    for (std::size_t i = 0; i < width_; ++i) {
      if (header[i].empty()) throw std::invalid_argument("write_csv: expected a column name, found an empty one");
      text_ += (i > 0 ? "," : "") + detail::csv_cell(header[i]);
    }
    text_ += '\n';
  }

  void row(const double* values, std::size_t count) {
    if (count != width_) {
      throw std::invalid_argument("write_csv: expected rows of " + std::to_string(width_) +
                                  " numbers as in the header, found " + std::to_string(count));
    }
    for (std::size_t i = 0; i < count; ++i) {
      char number[detail::longest_number];
      if (i > 0) text_ += ',';
      text_.append(number, detail::print_number(number, values[i]));
    }
    text_ += '\n';
    if (text_.size() >= block) flush();
  }
  void commit() {
    flush();
    file_.commit();
  }

 private:
  static constexpr std::size_t block = std::size_t{1} << 16;

  void flush() {
    file_.stream().write(text_.data(), static_cast<std::streamsize>(text_.size()));
    text_.clear();
  }

  AtomicFile file_;
  std::size_t width_;
  std::string text_;  ///< what is not yet handed to the file
};

/// Writes a table that stands in memory; see CsvWriter.
inline void write_csv(const std::string& path, const std::vector<std::string>& header,
                      const std::vector<std::vector<double>>& rows) {
  CsvWriter writer(path, header);
  for (const std::vector<double>& row : rows) writer.row(row.data(), row.size());
  writer.commit();
}

inline void write_csv(const std::string& path, const CsvTable& table) { write_csv(path, table.header, table.rows); }

}  // namespace pinnquad
