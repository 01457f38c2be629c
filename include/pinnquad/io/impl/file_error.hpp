// SPDX-License-Identifier: MIT
// Bodies of file_error.hpp.
#pragma once

#include "pinnquad/io/file_error.hpp"

namespace pinnquad {
namespace detail {

/// Bytes of the well-formed UTF-8 character at the front of `text`, 0 if there is none; and its code point.
PINNQUAD_BODY std::size_t first_character(std::string_view text, std::uint32_t& code_point) {
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

PINNQUAD_BODY bool steers(std::uint32_t code_point) {
  const auto within = [code_point](std::uint32_t first, std::uint32_t last) {
    return code_point >= first && code_point <= last;
  };
  return code_point < 0x20 || within(0x7f, 0x9f) || code_point == 0x61c || within(0x200b, 0x200f) ||
         within(0x2028, 0x202e) || within(0x2066, 0x2069) || code_point == 0xfeff;
}

}  // namespace detail

PINNQUAD_BODY std::string printable(std::string_view text) {
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

PINNQUAD_BODY std::string system_reason(int error_number, const char* otherwise) {
  return error_number != 0 ? std::generic_category().message(error_number) : std::string(otherwise);
}

}  // namespace pinnquad
