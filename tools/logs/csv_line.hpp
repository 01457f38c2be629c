// SPDX-License-Identifier: MIT
// A line of a CSV file that holds text beside numbers; tables of numbers alone: pinnquad/io/csv_table.hpp.
#pragma once

#include <string>
#include <vector>

#include "pinnquad/io/csv_table.hpp"

namespace programs {

/// The cells with their line's end, in quotation marks where they need them (RFC 4180).
inline std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) line += (i > 0 ? "," : "") + pinnquad::detail::csv_cell(cells[i]);
  return line + "\n";
}

}  // namespace programs
