// SPDX-License-Identifier: MIT
// Errors of files, one line that a program prints before it exits with code 2: reading throws InputError, writing
// OutputError. And text from outside (a file's name) made fit for a message, a report or a generated file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace pinnquad {

namespace detail {

/// Bytes of the well-formed UTF-8 character at the front of `text`, 0 if there is none; and its code point.
inline std::size_t first_character(std::string_view text, std::uint32_t& code_point) {
  const auto byte = [text](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  const std::uint32_t first = byte(0);
  if (first < 0x80) {
    code_point = first;
    return 1;
  }
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  code_point = first & (0x7fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0u) != 0x80u) return 0;
    code_point = code_point << 6 | (byte(i) & 0x3fu);
  }
  constexpr std::uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code_point >= 0xd800 && code_point <= 0xdfff;
  return code_point < smallest[length] || code_point > 0x10ffff || surrogate ? 0 : length;
}

/// Control characters, line and paragraph separators, marks that turn the direction of writing.
inline bool steers(std::uint32_t code_point) {
  const auto within = [code_point](std::uint32_t first, std::uint32_t last) {
    return code_point >= first && code_point <= last;
  };
  return code_point < 0x20 || within(0x7f, 0x9f) || code_point == 0x61c || within(0x200b, 0x200f) ||
         within(0x2028, 0x202e) || within(0x2066, 0x2069) || code_point == 0xfeff;
}

}  // namespace detail

/// `text` with every byte that is no UTF-8 and every control character, line break and mark of direction as '?'.
inline std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    std::uint32_t code_point = 0;
    const std::size_t length = detail::first_character(text, code_point);
    if (length == 0 || detail::steers(code_point)) {
      result += '?';
    } else {
      result += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return result;
}

/// A file that cannot be read as what it should be. what() is one line: `path:line:column: expected ..., found ...`.
/// Line and column count from 1, a column is a field of a row; 0 means that there is none, and it is not printed.
/// The path is shown by printable().
struct InputError : std::runtime_error {
  InputError(const std::string& path_, std::size_t line_, std::size_t column_, const std::string& expected,
             const std::string& found)
      : std::runtime_error(printable(path_) + (line_ > 0 ? ":" + std::to_string(line_) : "") +
                           (line_ > 0 && column_ > 0 ? ":" + std::to_string(column_) : "") + ": expected " + expected +
                           ", found " + found),
        path(path_),
        line(line_),
        column(column_) {}

  std::string path;
  std::size_t line;
  std::size_t column;
};

/// A file that cannot be written. what() is one line: `cannot write path: reason`.
struct OutputError : std::runtime_error {
  OutputError(const std::string& path_, const std::string& reason)
      : std::runtime_error("cannot write " + printable(path_) + ": " + reason), path(path_) {}

  std::string path;
};

/// The system's words for an errno value, or `otherwise` when it is 0.
inline std::string system_reason(int error_number, const char* otherwise) {
  return error_number != 0 ? std::generic_category().message(error_number) : std::string(otherwise);
}

}  // namespace pinnquad
