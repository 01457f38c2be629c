// SPDX-License-Identifier: MIT
// C++ as text. Literals: every number reads back bit for bit, no text breaks out of its quotes, and no locale plays a
// part. Names: of a type, the same from every compiler; and those that a generated struct may have, wherever its header
// is included.
#pragma once

#include <charconv>
#include <ostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "pinnquad/core/body.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/training/described_predictor.hpp"

namespace pinnquad {

namespace detail {

/// The first include of a generated header; none behind pinnquad_flight.hpp (docs/packages.md).
inline constexpr const char* flight_include = "#ifndef PINNQUAD_ONE_FILE\n#include \"pinnquad/flight.hpp\"\n#endif\n";

/// Keywords and alternative tokens of C++ up to C++20, and what its headers and Eigen take at global scope: macros,
/// namespaces, types of the C library that flight.hpp brings with it, and functions that a struct of that name would
/// hide.
inline constexpr std::string_view taken_names[] = {
    // clang-format off
    "alignas", "alignof", "and", "and_eq", "asm", "auto", "bitand", "bitor", "bool", "break", "case", "catch", "char",
    "char16_t", "char32_t", "char8_t", "class", "co_await", "co_return", "co_yield", "compl", "concept", "const",
    "const_cast", "consteval", "constexpr", "constinit", "continue", "decltype", "default", "delete", "do", "double",
    "dynamic_cast", "else", "enum", "explicit", "export", "extern", "false", "float", "for", "friend", "goto", "if",
    "inline", "int", "long", "mutable", "namespace", "new", "noexcept", "not", "not_eq", "nullptr", "operator", "or",
    "or_eq", "private", "protected", "public", "register", "reinterpret_cast", "requires", "return", "short", "signed",
    "sizeof", "static", "static_assert", "static_cast", "struct", "switch", "template", "this", "thread_local", "throw",
    "true", "try", "typedef", "typeid", "typename", "union", "unsigned", "using", "virtual", "void", "volatile",
    "wchar_t", "while", "xor", "xor_eq",
    "assert", "errno", "linux", "unix", "stdin", "stdout", "stderr", "signbit", "isnan", "isinf", "isfinite",
    "offsetof", "main", "std", "pinnquad", "Eigen", "math_errhandling", "L_ctermid", "L_cuserid", "L_tmpnam",
    "P_tmpdir", "drand48_data", "fd_mask", "fd_set", "itimerspec", "lconv", "random_data", "sched_param", "sigevent",
    "timespec", "timeval", "timex", "tm", "u_char", "u_int", "u_long", "u_short", "uint", "ulong", "ushort", "va_list",
    "abort", "abs", "acos", "asin", "atan", "atof", "atoi", "ceil", "clock", "cos", "div", "exit", "exp", "fabs",
    "floor", "fmod", "free", "gamma", "index", "j0", "j1", "jn", "labs", "log", "malloc", "pow", "qsort", "rand",
    "read", "remove", "round", "signal", "sin", "sqrt", "system", "tan", "time", "write", "y0", "y1", "yn"};
// clang-format on

}  // namespace detail

/// True for a name that a struct at global scope may have: letters, digits and underscores, the first a letter, no two
/// underscores in a row, at least one lower-case letter (NULL, EOF and M_PI are macros, as are M_PIf and what begins
/// with EIGEN_), no `_t` at the end (POSIX has these), no keyword.
bool is_identifier(std::string_view name);
/// Throws std::invalid_argument for a name that is none; `what` was given it.
void require_identifier(const std::string& what, const std::string& name);

namespace detail {

/// Throws std::invalid_argument, one line, for a name that no struct may have.
void require_identifier(const std::string& name);

/// Shortest text that reads back as the same value, marked as a literal of its type.
template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
std::string literal(Number value) {
  char text[40];
  std::string result(text, std::to_chars(text, text + sizeof text, value).ptr);
  if (!std::is_integral_v<Number> && result.find_first_of(".en") == std::string::npos) result += ".0";
  return std::is_same_v<Number, float> ? result + 'f' : result;
}

/// A C++ string literal of printable(text). A second '?' in a row is escaped: no trigraph.
std::string quoted(const std::string& text);
inline std::string literal(const char* text) { return quoted(text); }
inline std::string literal(const std::string& text) { return quoted(text); }

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

}  // namespace detail
}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/cpp_text.hpp"
#endif
