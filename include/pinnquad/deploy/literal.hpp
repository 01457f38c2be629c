// SPDX-License-Identifier: MIT
// Numbers and texts as literals of C++: every number reads back bit for bit, no text breaks out of its quotes, and no locale
// plays a part.
#pragma once

#include <charconv>
#include <ostream>
#include <stdexcept>
#include <string>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/io/file_error.hpp"

namespace pinnquad::detail {

/// Shortest text that reads back as the same value, marked as a literal of its type.
inline std::string literal(float value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  std::string result(text, end);
  if (result.find_first_of(".en") == std::string::npos) result += ".0";
  return result + "f";
}
inline std::string literal(double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  std::string result(text, end);
  if (result.find_first_of(".en") == std::string::npos) result += ".0";
  return result;
}

/// A C++ string literal of printable(text). A second '?' in a row is escaped: no trigraph.
inline std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : printable(text)) {
    if (c == '"' || c == '\\' || (c == '?' && result.back() == '?')) result += '\\';
    result += c;
  }
  return result + '"';
}
inline std::string literal(const char* text) { return quoted(text); }
inline std::string literal(const std::string& text) { return quoted(text); }
inline std::string literal(int value) { return std::to_string(value); }

/// Values in braces, several to a line.
template <class Range>
void write_braced(std::ostream& out, const Range& values, const std::string& indent) {
  constexpr int per_line = 8;
  out << '{';
  int column = 0;
  bool first = true;
  for (const auto& value : values) {
    if (!first) out << ',';
    if (column == 0 && values.size() > per_line) out << '\n' << indent << "    ";
    if (column != 0 || (values.size() <= per_line && !first)) out << ' ';
    out << literal(value);
    first = false;
    column = (column + 1) % per_line;
  }
  out << '}';
}

/// Throws std::invalid_argument, one line, for a number that is not finite: it has no literal and must not fly.
template <class Numbers>
void require_finite(const Numbers& numbers, const std::string& name) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!is_finite(numbers[i])) {
      throw std::invalid_argument("export: number " + std::to_string(i + 1) + " of " + name + " is not finite");
    }
  }
}

}  // namespace pinnquad::detail
