// SPDX-License-Identifier: MIT
// Bodies of decimal.hpp.
#pragma once

#include "pinnquad/io/decimal.hpp"

namespace pinnquad {

PINNQUAD_BODY std::string number_text(double value) {
  char buffer[detail::longest_number];
  return std::string(buffer, detail::print_number(buffer, value));
}

PINNQUAD_BODY bool parse_number(std::string_view cell, double& value) {
  const char* first = cell.data();
  const char* const last = first + cell.size();
  if (cell.size() > 1 && cell[0] == '+' && cell[1] != '-') ++first;
  return detail::read_number(first, last, value);
}

PINNQUAD_BODY std::string hexadecimal(std::uint64_t value) {
  char text[17];
  const auto end = std::to_chars(text, text + 16, value, 16).ptr;
  const std::string digits(text, end);
  return "0x" + std::string(16 - digits.size(), '0') + digits;
}

}  // namespace pinnquad
