// SPDX-License-Identifier: MIT
// Text for a terminal: no line is wider than 100 columns where words allow it.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

#include <unistd.h>

namespace programs {

inline constexpr std::size_t widest_line = 100;

/// `text` with line breaks between words. Lines after the first begin with `indent` spaces; `begun` columns of the
/// first line are taken already. No line feed at the end.
inline std::string in_columns(const std::string& text, std::size_t indent, std::size_t begun = 0) {
  std::string result;
  std::size_t column = begun;
  for (std::size_t from = 0; from <= text.size();) {
    std::size_t end = text.find(' ', from);
    if (end == std::string::npos) end = text.size();
    const std::size_t length = end - from;
    if (from > 0) {
      const bool fits = column + 1 + length <= widest_line;
      result += fits ? " " : "\n" + std::string(indent, ' ');
      column = fits ? column + 1 : indent;
    }
    result.append(text, from, length);
    column += length;
    from = end + 1;
  }
  return result;
}

/// "name        text", the text beside the name, as wide as the widest line.
inline std::string entry(const std::string& name, const std::string& text) {
  constexpr std::size_t beside = 12;
  std::string line = name;
  line.resize(name.size() < beside ? beside : name.size() + 1, ' ');
  return line + in_columns(text, beside, line.size()) + "\n";
}

inline void print_entry(const std::string& name, const std::string& text) {
  std::fputs(entry(name, text).c_str(), stdout);
}

/// A line of its own that begins after `indent` spaces; if it is too long the rest is two further in.
inline void print_line(const std::string& text, std::size_t indent = 0) {
  std::printf("%s%s\n", std::string(indent, ' ').c_str(), in_columns(text, indent + 2, indent).c_str());
}

/// A line that scripts look for: a terminal gets it wrapped, a file whole.
inline void print_message(const std::string& text, std::size_t indent = 0) {
  if (isatty(STDOUT_FILENO) != 0) return print_line(text, indent);
  std::printf("%s%s\n", std::string(indent, ' ').c_str(), text.c_str());
}

}  // namespace programs
