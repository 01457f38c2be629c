// SPDX-License-Identifier: MIT
// How deep a TOML or JSON text is nested, found before a parser sees it: parsers, and what walks the trees that they
// make, descend once per level and end with the stack.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include "pinnquad/io/file_error.hpp"

namespace pinnquad::logs {

/// Deepest nesting of what a program reads; a study has 4 levels, an airframe 2.
inline constexpr std::size_t deepest_nesting = 64;

/// Where the text or the comment of TOML or JSON that begins at `at` ends; `at` itself where none does.
inline std::size_t behind_text(const std::string& content, std::size_t at) {
  const char mark = content[at];
  if (mark == '#') return std::min(content.find('\n', at), content.size());
  if (mark != '"' && mark != '\'') return at;
  const std::string three(3, mark);
  const bool long_text = content.compare(at, 3, three) == 0;
  for (std::size_t i = at + (long_text ? 3 : 1); i < content.size(); ++i) {
    if (content[i] == '\\' && mark == '"') {
      ++i;
    } else if (!long_text && (content[i] == mark || content[i] == '\n')) {
      return i + 1;
    } else if (long_text && content.compare(i, 3, three) == 0) {
      return std::min(content.find_first_not_of(mark, i), i + 5);  // a long text may end in two marks of its own
    }
  }
  return content.size();
}

/// The place of a character, for the message.
inline InputError error_at(const std::string& content, std::size_t at, const std::string& path,
                           const std::string& expected, const std::string& found) {
  const auto before = content.begin() + static_cast<std::ptrdiff_t>(at);
  const auto line = 1 + static_cast<std::size_t>(std::count(content.begin(), before, '\n'));
  const std::size_t line_begin = at == 0 ? 0 : content.rfind('\n', at - 1) + 1;  // npos + 1 is 0
  return InputError(path, line, at - line_begin + 1, expected, found);
}

/// Throws InputError where brackets, or a key's dots, make more levels than `deepest_nesting`. `what` is TOML or JSON.
inline void require_shallow(const std::string& content, const std::string& path, const std::string& what) {
  std::size_t brackets = 0, dots = 0;  // those open; those of this key or number
  for (std::size_t i = 0; i < content.size();) {
    const std::size_t behind = behind_text(content, i);
    if (behind == i) {
      const char c = content[i];
      const bool opens = c == '[' || c == '{', closes = c == ']' || c == '}';
      if (opens) ++brackets;
      if (closes && brackets > 0) --brackets;
      if (opens || closes || c == '=' || c == ',' || c == '\n') dots = 0;
      if (c == '.') ++dots;
      if (std::max(brackets, dots) > deepest_nesting) {
        throw error_at(content, i, path, what + " of at most " + std::to_string(deepest_nesting) + " levels",
                       "one nested deeper");
      }
    }
    i = std::max(behind, i + 1);
  }
}
}  // namespace pinnquad::logs
