// SPDX-License-Identifier: MIT
// Tables of numbers as comma-separated text: a header that names the columns, then one row per line.
// Numbers are written with the fewest digits that read back to the same bits; no locale plays a part.
#pragma once

#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/data/atomic_file.hpp"
#include "pinnquad/data/file_error.hpp"
#include "pinnquad/data/regular_file.hpp"

namespace pinnquad {

/// A table of numbers; every row as long as the header.
struct CsvTable {
  std::vector<std::string> header;
  std::vector<std::vector<double>> rows;
};

namespace detail {

/// A cell as a message shows it: quoted, cut, and on one line whatever bytes it holds.
inline std::string quoted_cell(std::string_view cell) {
  constexpr std::size_t most_shown = 40;
  if (cell.empty()) return "an empty cell";
  std::string shown = "\"";
  for (const char c : cell.substr(0, most_shown)) shown += c >= ' ' && c <= '~' ? c : '?';
  return shown + (cell.size() > most_shown ? "...\"" : "\"");
}

/// Shortest text that reads back to the same bits.
inline std::string number_text(double value) {
  char buffer[32];
  const std::to_chars_result result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, result.ptr);
}

inline std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// The whole cell as a finite number; a leading plus sign is accepted.
inline bool parse_number(std::string_view cell, double& value) {
  const char* first = cell.data();
  const char* const last = first + cell.size();
  if (cell.size() > 1 && cell[0] == '+' && cell[1] != '-') ++first;
  const std::from_chars_result result = std::from_chars(first, last, value);
  return result.ec == std::errc() && result.ptr == last && is_finite(value);
}

/// The fields of one line, blanks around them removed.
inline void split_fields(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

inline std::string file_text(const std::string& path) {
  const std::string expected = "a readable file";
  require_regular_file(path);
  errno = 0;
  struct CloseFile {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) throw InputError(path, 0, 0, expected, "none (" + system_reason(errno, "it does not open") + ")");
  std::string text;
  std::vector<char> block(std::size_t{1} << 16);
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), file.get())) {
    text.append(block.data(), count);
    if (text.size() > most_input_bytes) refuse_size(path);
  }
  if (std::ferror(file.get())) {
    throw InputError(path, 0, 0, expected, "a read error (" + system_reason(errno, "reason unknown") + ")");
  }
  return text;
}

/// Field index (from 0) of each wanted column in the header line.
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
      throw InputError(path, 1, 0, "a column named " + name,
                       "none of that name among " + std::to_string(header.size()) + " columns");
    }
    fields.push_back(found);
  }
  return fields;
}

/// Reads the named columns and calls `on_row(values, line, fields)` for each row: its values in the order of `columns`,
/// its line, and the field index (from 0) of each column. Returns nothing: the callee keeps what it wants.
template <class OnRow>
void for_each_csv_row(const std::string& path, const std::vector<std::string>& columns, std::size_t minimum_rows,
                      OnRow on_row) {
  const std::string text = file_text(path);
  std::string_view rest = text;
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (rest.substr(0, byte_order_mark.size()) == byte_order_mark) rest.remove_prefix(byte_order_mark.size());
  while (!rest.empty() && (rest.back() == '\n' || rest.back() == '\r')) rest.remove_suffix(1);
  if (rest.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    throw InputError(path, 1, 0, "a header that names the columns", "an empty file");
  }

  const auto next_line = [&rest] {
    const std::size_t end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  };
  std::vector<std::string_view> cells;
  split_fields(next_line(), cells);
  const std::size_t width = cells.size();
  const std::vector<std::size_t> fields = locate_columns(path, cells, columns);

  std::vector<double> values(columns.size());
  std::size_t line_number = 1;
  std::size_t rows = 0;
  for (; !rest.empty(); ++rows) {
    const std::string_view line = next_line();
    ++line_number;
    split_fields(line, cells);
    if (cells.size() != width) {
      const std::size_t first_wrong = (cells.size() < width ? cells.size() : width) + 1;
      throw InputError(path, line_number, trimmed(line).empty() ? 0 : first_wrong,
                       std::to_string(width) + " fields as in the header",
                       trimmed(line).empty() ? "an empty line" : std::to_string(cells.size()));
    }
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string_view cell = cells[fields[i]];
      if (!parse_number(cell, values[i])) {
        throw InputError(path, line_number, fields[i] + 1, "a finite number in column " + columns[i],
                         quoted_cell(cell));
      }
    }
    on_row(std::as_const(values), line_number, fields);
  }
  if (rows < minimum_rows) {
    throw InputError(path, line_number, 0, "at least " + std::to_string(minimum_rows) + " rows of data",
                     std::to_string(rows));
  }
}

}  // namespace detail

/// Reads the named columns of a table, in the order asked for. In the file they may stand in any order; other columns
/// are ignored and may hold text. LF and CRLF, a byte order mark, blanks around cells, empty lines at the end:
/// accepted. Throws InputError: no readable or an empty file, a missing or doubled column, a row of other length, a
/// cell that is empty, text, NaN, Inf or beyond the range of a double, fewer than `minimum_rows` rows.
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

/// Writes a table; the file appears whole or not at all. NaN and Inf are written as nan and inf (gnuplot leaves them
/// out; `read_csv` refuses them). Throws OutputError if the file cannot be written, std::invalid_argument for a row of
/// other length than the header or a column name that CSV cannot hold.
inline void write_csv(const std::string& path, const std::vector<std::string>& header,
                      const std::vector<std::vector<double>>& rows) {
  std::string text;
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (header[i].empty() || header[i] != detail::trimmed(header[i]) ||
        header[i].find_first_of(",\"\r\n") != std::string::npos) {
      throw std::invalid_argument("write_csv: expected a plain column name, found " + detail::quoted_cell(header[i]));
    }
    text += (i > 0 ? "," : "") + header[i];
  }
  text += '\n';
  for (const std::vector<double>& row : rows) {
    if (row.size() != header.size()) {
      throw std::invalid_argument("write_csv: expected rows of " + std::to_string(header.size()) +
                                  " numbers as in the header, found " + std::to_string(row.size()));
    }
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += ',';
      char buffer[32];
      text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, row[i]).ptr);
    }
    text += '\n';
  }
  AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

inline void write_csv(const std::string& path, const CsvTable& table) { write_csv(path, table.header, table.rows); }

}  // namespace pinnquad
