// SPDX-License-Identifier: MIT
// Which names a generated struct may have, wherever its header is included: no keyword, no name that the language or a
// macro of the standard library has taken.
#pragma once

#include <string_view>

namespace pinnquad {

namespace detail {

/// Keywords and alternative tokens of C++ up to C++20, and what its headers and Eigen take at global scope: macros,
/// namespaces, types of the C library that flight.hpp brings with it, and functions that a struct of that name would hide.
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
    "assert", "errno", "linux", "unix", "stdin", "stdout", "stderr", "signbit", "isnan", "isinf", "isfinite", "offsetof",
    "main", "std", "pinnquad", "Eigen", "math_errhandling", "L_ctermid", "L_cuserid", "L_tmpnam", "P_tmpdir",
    "drand48_data", "fd_mask", "fd_set", "itimerspec", "lconv", "random_data", "sched_param", "sigevent", "timespec",
    "timeval", "timex", "tm", "u_char", "u_int", "u_long", "u_short", "uint", "ulong", "ushort", "va_list",
    "abort", "abs", "acos", "asin", "atan", "atof", "atoi", "ceil", "clock", "cos", "div", "exit", "exp", "fabs", "floor",
    "fmod", "free", "gamma", "index", "j0", "j1", "jn", "labs", "log", "malloc", "pow", "qsort", "rand", "read", "remove",
    "round", "signal", "sin", "sqrt", "system", "tan", "time", "write", "y0", "y1", "yn"};
// clang-format on

}  // namespace detail

/// True for a name that a struct at global scope may have: letters, digits and underscores, the first a letter, no two
/// underscores in a row, at least one lower-case letter (NULL, EOF and M_PI are macros, as are M_PIf and what begins with
/// EIGEN_), no `_t` at the end (POSIX has these), no keyword.
inline bool is_identifier(std::string_view name) {
  const auto lower = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto letter = [lower](char c) { return lower(c) || (c >= 'A' && c <= 'Z'); };
  if (name.empty() || !letter(name[0]) || name.find("__") != std::string_view::npos) return false;
  bool has_lower = false;
  for (const char c : name) {
    if (!letter(c) && !(c >= '0' && c <= '9') && c != '_') return false;
    has_lower = has_lower || lower(c);
  }
  if (!has_lower || name.substr(0, 2) == "M_" || name.substr(0, 6) == "EIGEN_") return false;
  if (name.size() > 2 && name.substr(name.size() - 2) == "_t") return false;
  for (const std::string_view taken : detail::taken_names) {
    if (name == taken) return false;
  }
  return true;
}

}  // namespace pinnquad
