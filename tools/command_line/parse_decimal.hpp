// SPDX-License-Identifier: MIT
// Numbers taken as they are written, or refused.
#pragma once

#include <charconv>
#include <string>
#include <system_error>
#include <type_traits>

namespace programs {

/// The whole text as a plain decimal number from `least` to `most`. No signs but a minus, no octal or hexadecimal, no
/// leading zeros of a whole number, no NaN, no Inf.
template <class Number>
bool parse_decimal(const std::string& text, Number least, Number most, Number& value) {
  if constexpr (std::is_integral_v<Number>) {
    if (text.empty() || text.find_first_not_of("0123456789") != std::string::npos) return false;
    if (text.size() > 1 && text[0] == '0') return false;
  }
  Number read{};
  const std::from_chars_result result = std::from_chars(text.data(), text.data() + text.size(), read);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) return false;
  if (!(read >= least && read <= most)) return false;
  value = read;
  return true;
}

}  // namespace programs
