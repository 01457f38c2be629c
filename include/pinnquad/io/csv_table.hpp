// SPDX-License-Identifier: MIT
// Tables as comma-separated text: a header that names the columns, then one row per line. Cells as RFC 4180 has them: a
// cell in quotation marks may hold commas, line ends and, doubled, quotation marks. Blanks around a cell do not count.
// Numbers are written with the fewest digits that read back to the same bits; no locale plays a part.
#pragma once

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/text_file.hpp"

namespace pinnquad {

/// A cell as a message shows it: quoted, cut, and on one line whatever bytes it holds.
std::string quoted_cell(std::string_view cell);

namespace detail {

std::string_view trimmed(std::string_view text);

/// Where in a record a character stands, to tell whether it is inside quotation marks. They open a cell only at its
/// beginning: in `5" propeller` there is none.
enum class Quotation { begin, plain, quoted, closed };

/// The place behind `text`, which begins at `place`.
Quotation followed(Quotation place, std::string_view text) noexcept;

}  // namespace detail

/// The cells of a record. In one with quotation marks `unquoted` is to be given: it holds the text of the quoted cells,
/// and a cell that goes on behind its closing mark is taken as it stands.
void split_fields(std::string_view record, std::vector<std::string_view>& fields, std::string* unquoted = nullptr);

/// Field index (from 0) of each wanted column in the header line of a file. Throws InputError, one line, for a column
/// that is missing or there twice, and for cells between semicolons or tabs.
std::vector<std::size_t> locate_columns(const std::string& path, const std::vector<std::string_view>& header,
                                        const std::vector<std::string>& columns);

namespace detail {

/// Text as a cell that reads back as the same text: in quotation marks where it needs them.
std::string csv_cell(std::string_view text);

/// Most records of so many cells that a file can hold: one per line, a digit and a separator per cell.
std::size_t most_records(const std::string& path, std::size_t cells);

/// The records of a comma-separated file: a line each, or more where a quoted cell holds line ends. A byte order mark
/// is skipped. Memory holds a block and a record.
class CsvRecords {
 public:
  explicit CsvRecords(const std::string& path) : file_(path), buffer_(read_block) {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    fill();
    if (unread().substr(0, byte_order_mark.size()) == byte_order_mark) begin_ += byte_order_mark.size();
  }

  /// The next record without its line end, LF or CRLF; valid until the next call. False at the end of the file.
  /// Throws InputError: a quoted cell without end, a record of more than 16 MiB, a read error.
  bool next(std::string_view& record) {
    line_ = next_line_;
    Quotation place = Quotation::begin;
    std::size_t searched = 0, read = 0;  // from begin_
    has_quotes_ = false;
    for (;;) {
      std::string_view text = unread();
      std::size_t end = text.find('\n', searched);
      if (end == std::string_view::npos) {
        searched = text.size();
        if (fill()) continue;
        if (searched == 0) return false;
        text = unread();  // it has been moved
        end = text.size();
      }
      ++next_line_;
      if (has_quotes_ || text.substr(read, end - read).find('"') != std::string_view::npos) {
        has_quotes_ = true;
        place = followed(place, text.substr(read, end - read));
        read = end;
        if (place == Quotation::quoted) {
          if (end == text.size()) {
            throw InputError(file_.path(), line_, 0, "a closing quotation mark", "the end of the file");
          }
          searched = end + 1;
          continue;
        }
      }
      begin_ += end < text.size() ? end + 1 : end;
      record = text.substr(0, end);
      if (!record.empty() && record.back() == '\r') record.remove_suffix(1);
      return true;
    }
  }

  /// Where the last record begins, from 1.
  std::size_t line() const noexcept { return line_; }
  /// Bytes of the file up to the last record's end.
  std::uintmax_t bytes() const noexcept { return file_.bytes_read() - (end_ - begin_); }
  /// The cells of the last record; valid until the next call of this, or of next().
  void split(std::string_view record, std::vector<std::string_view>& cells) {
    split_fields(record, cells, has_quotes_ ? &unquoted_ : nullptr);
  }

 private:
  std::string_view unread() const noexcept { return {buffer_.data() + begin_, end_ - begin_}; }

  /// Puts what is unread to the front of the buffer and more behind it; false at the end of the file.
  bool fill() {
    constexpr std::size_t longest_record = std::size_t{1} << 24;
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    if (end_ > longest_record) throw InputError(file_.path(), line_, 0, "a record of at most 16 MiB", "a longer one");
    if (buffer_.size() < end_ + read_block) buffer_.resize(2 * buffer_.size());
    const std::size_t count = file_.read(buffer_.data() + end_, read_block);
    end_ += count;
    return count > 0;
  }

  TextFile file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;
  std::size_t line_ = 1, next_line_ = 1;
  bool has_quotes_ = false;
  std::string unquoted_;
};

/// The names of a file's columns as its header has them; none of an empty file.
std::vector<std::string> csv_header(const std::string& path);

/// Reads the named columns and calls `on_row(values, line, fields)` for each row: its values in the order of `columns`,
/// its line, and the field index (from 0) of each column.
template <class OnRow>
void for_each_csv_row(const std::string& path, const std::vector<std::string>& columns, std::size_t minimum_rows,
                      OnRow on_row) {
  CsvRecords records(path);
  std::string_view record;
  const auto is_blank = [](std::string_view text) { return text.find_first_not_of(" \t\r") == std::string_view::npos; };
  if (!records.next(record) || is_blank(record)) {
    while (records.next(record) && is_blank(record)) {
    }
    if (is_blank(record)) throw InputError(path, 1, 0, "a header that names the columns", "an empty file");
    record = {};
  }
  std::vector<std::string_view> cells;
  records.split(record, cells);
  const std::size_t width = cells.size();
  const std::vector<std::size_t> fields = locate_columns(path, cells, columns);

  std::vector<double> values(columns.size());
  std::size_t rows = 0;
  const auto take_row = [&](std::size_t line) {
    records.split(record, cells);
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

/// Writes a table row by row; the file appears whole, on commit(), or not at all. NaN and Inf are written as nan and
/// inf (a plot leaves them out; `read_csv` refuses them). Throws OutputError if the file cannot be written,
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
  std::string text_;  ///< not yet handed to the file
};

}  // namespace detail

/// The cells as a line with its end, in quotation marks where they need them (RFC 4180): of tables that hold text.
std::string csv_line(const std::vector<std::string>& cells);

/// The rows of a table: the named columns, in the order asked for. In the file they may stand in any order; other
/// columns are ignored and may hold text. LF and CRLF, a byte order mark, blanks around cells, empty lines at the end,
/// quotation marks as in RFC 4180: accepted. Throws InputError: no readable or an empty file, a missing or doubled
/// column, a row of other length, a cell that is empty, text, NaN, Inf or beyond the range of a double, fewer than
/// `minimum_rows` rows.
std::vector<std::vector<double>> read_csv(const std::string& path, const std::vector<std::string>& columns,
                                          std::size_t minimum_rows = 1);

/// Writes a table that stands in memory; see CsvWriter.
void write_csv(const std::string& path, const std::vector<std::string>& header,
               const std::vector<std::vector<double>>& rows);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/io/impl/csv_table.hpp"
#endif
