// SPDX-License-Identifier: MIT
// Where the table of a text file begins, and how its cells are parted: spreadsheets, Blackbox Explorer and NumPy write
// keys and values, comments or a row of units around the names of the columns.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pinnquad/logs/flight_log.hpp"

namespace pinnquad::logs {

struct CsvHead {
  std::size_t records = 0;         ///< up to the names, and the units below them: the rows follow
  std::size_t line = 1;            ///< of the names
  char separator = ',';            ///< or a semicolon, or a tab
  std::vector<std::string> names;  ///< of the columns, without quotation marks
  std::vector<std::string> units;  ///< by column: from a row of units, or none
  std::vector<std::pair<std::string, std::string>> facts;  ///< rows of a key and a value above the names
};

/// Reads as many records as it takes. Throws InputError, one line: no names of columns, names that come twice.
CsvHead csv_head(const std::string& path);

/// The cells of a record between separators that are not commas; in quotation marks a separator is none.
void split_cells(std::string_view record, char separator, std::vector<std::string_view>& cells);

/// "0,035": a number whose decimal mark is a comma.
bool has_decimal_comma(std::string_view cell);

/// Decimal digits with a point, or a comma where `separator` is none; an empty cell and "nan" are NaN, "inf" is
/// infinite. False for text.
bool cell_number(std::string_view cell, double& value, char separator = ',');

/// True for blanks alone.
bool is_blank(std::string_view text);

/// Keeps the numbers of a line of a log's head: one is a parameter, several between commas are "motorOutput[0]", ...
void keep_parameters(FlightLog& log, const std::string& key, const std::string& value);

}  // namespace pinnquad::logs
