// SPDX-License-Identifier: MIT
// Bodies of csv_table.hpp.
#pragma once

#include "pinnquad/io/csv_table.hpp"

namespace pinnquad {

PINNQUAD_BODY std::string quoted_cell(std::string_view cell) {
  constexpr std::size_t most_shown = 40;
  if (cell.empty()) return "an empty cell";
  std::string shown = "\"";
  for (const char c : cell.substr(0, most_shown)) shown += c >= ' ' && c <= '~' ? c : '?';
  return shown + (cell.size() > most_shown ? "...\"" : "\"");
}

namespace detail {

PINNQUAD_BODY std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

PINNQUAD_BODY Quotation followed(Quotation place, std::string_view text) noexcept {
  for (const char c : text) {
    if (place == Quotation::quoted) {
      if (c == '"') place = Quotation::closed;
    } else if (c == '"' && place == Quotation::closed) {
      place = Quotation::quoted;  // doubled: a mark of the text
    } else if (c == ',') {
      place = Quotation::begin;
    } else if (c == '"' && place == Quotation::begin) {
      place = Quotation::quoted;
    } else if (!(place == Quotation::begin && (c == ' ' || c == '\t'))) {
      place = Quotation::plain;
    }
  }
  return place;
}

}  // namespace detail

PINNQUAD_BODY void split_fields(std::string_view record, std::vector<std::string_view>& fields, std::string* unquoted) {
  fields.clear();
  if (unquoted != nullptr) {
    unquoted->clear();
    unquoted->reserve(record.size());  // then an append moves nothing
  }
  for (;;) {
    std::size_t comma = record.find(',');
    std::size_t i = unquoted != nullptr ? record.find_first_not_of(" \t") : std::string_view::npos;
    bool whole = false;
    if (i != std::string_view::npos && record[i] == '"') {
      const std::size_t begin = unquoted->size();
      for (++i; i < record.size(); ++i) {
        if (record[i] == '"') {
          if (i + 1 >= record.size() || record[i + 1] != '"') break;
          ++i;
        }
        *unquoted += record[i];
      }
      const std::size_t behind = record.find_first_not_of(" \t", i + 1);
      whole = i < record.size() && (behind == std::string_view::npos || record[behind] == ',');
      comma = behind == std::string_view::npos ? behind : record.find(',', behind);
      if (whole) fields.push_back(std::string_view(*unquoted).substr(begin));
    }
    if (!whole) fields.push_back(detail::trimmed(record.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    record.remove_prefix(comma + 1);
  }
}

PINNQUAD_BODY std::vector<std::size_t> locate_columns(const std::string& path,
                                                      const std::vector<std::string_view>& header,
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
      const std::string quantity = name.substr(0, name.find(" ["));
      for (std::size_t i = 0; i < header.size(); ++i) {
        if (quantity != header[i].substr(0, header[i].find(" ["))) continue;
        throw InputError(path, 1, i + 1, "a column named " + name, quoted_cell(header[i]));
      }
      throw InputError(path, 1, 0, "a column named " + name,
                       "none of that name among " + std::to_string(header.size()) + " columns");
    }
    fields.push_back(found);
  }
  return fields;
}

namespace detail {

PINNQUAD_BODY std::string csv_cell(std::string_view text) {
  if (trimmed(text) == text && text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string(2, c) : std::string(1, c);
  return cell + '"';
}

PINNQUAD_BODY std::size_t most_records(const std::string& path, std::size_t cells) {
  TextFile file(path);
  std::size_t bytes = 0, ends = 0;
  std::vector<char> block(read_block);
  while (const std::size_t count = file.read(block.data(), block.size())) {
    bytes += count;
    ends +=
        static_cast<std::size_t>(std::count(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(count), '\n'));
  }
  return std::min(ends, bytes / (2 * cells)) + 1;
}

PINNQUAD_BODY std::vector<std::string> csv_header(const std::string& path) {
  CsvRecords records(path);
  std::string_view record;
  if (!records.next(record)) return {};
  std::vector<std::string_view> cells;
  records.split(record, cells);
  return {cells.begin(), cells.end()};
}

}  // namespace detail

PINNQUAD_BODY std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) line += (i > 0 ? "," : "") + detail::csv_cell(cells[i]);
  return line + "\n";
}

PINNQUAD_BODY std::vector<std::vector<double>> read_csv(const std::string& path,
                                                        const std::vector<std::string>& columns,
                                                        std::size_t minimum_rows) {
  std::vector<std::vector<double>> rows;
  detail::for_each_csv_row(path, columns, minimum_rows,
                           [&rows](const std::vector<double>& values, std::size_t, const std::vector<std::size_t>&) {
                             rows.push_back(values);
                           });
  return rows;
}

PINNQUAD_BODY void write_csv(const std::string& path, const std::vector<std::string>& header,
                             const std::vector<std::vector<double>>& rows) {
  detail::CsvWriter writer(path, header);
  for (const std::vector<double>& row : rows) writer.row(row.data(), row.size());
  writer.commit();
}

}  // namespace pinnquad
