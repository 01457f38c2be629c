// SPDX-License-Identifier: MIT
// Bodies of cpp_text.hpp.
#pragma once

#include "pinnquad/deploy/cpp_text.hpp"

namespace pinnquad {

PINNQUAD_BODY bool is_identifier(std::string_view name) {
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

PINNQUAD_BODY void require_identifier(const std::string& what, const std::string& name) {
  if (is_identifier(name)) return;
  throw std::invalid_argument(what + " " + printable(name) +
                              ": a C++ identifier was expected, no keyword and no name that C++ reserves");
}

namespace detail {

PINNQUAD_BODY void require_identifier(const std::string& name) {
  if (!is_identifier(name)) throw std::invalid_argument("export: '" + name + "' is not a C++ identifier");
}

PINNQUAD_BODY std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : printable(text)) {
    if (c == '"' || c == '\\' || (c == '?' && result.back() == '?')) result += '\\';
    result += c;
  }
  return result + '"';
}

}  // namespace detail
}  // namespace pinnquad
