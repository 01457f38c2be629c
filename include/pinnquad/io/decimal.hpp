// SPDX-License-Identifier: MIT
// Numbers as decimal text: the fewest digits that read back to the same bits. No locale plays a part.
// By <charconv>; where the standard library has it for integers only, by the C library in the "C" locale.
#pragma once

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>

#include "pinnquad/core/finite.hpp"

// PINNQUAD_NUMBERS_BY_LOCALE, defined for a whole program, takes the second way where both are: for tests.
#if !defined(__cpp_lib_to_chars) && !defined(PINNQUAD_NUMBERS_BY_LOCALE)
#define PINNQUAD_NUMBERS_BY_LOCALE
#endif

#if defined(PINNQUAD_NUMBERS_BY_LOCALE)
#include <locale.h>
#if defined(__APPLE__) || defined(__FreeBSD__)
#include <xlocale.h>
#endif
#endif

namespace pinnquad {
namespace detail {

/// Longest text of a double that number_text() gives, with room to spare.
inline constexpr std::size_t longest_number = 40;

#if defined(PINNQUAD_NUMBERS_BY_LOCALE)

/// The "C" locale for what this thread does while this lives; a decimal comma elsewhere does not matter.
class PlainLocale {
 public:
  PlainLocale() noexcept : before_(uselocale(plain())) {}
  ~PlainLocale() { uselocale(before_); }
  PlainLocale(const PlainLocale&) = delete;
  PlainLocale& operator=(const PlainLocale&) = delete;

 private:
  static locale_t plain() noexcept {
    static const locale_t locale = newlocale(LC_ALL_MASK, "C", locale_t{});
    return locale;
  }
  locale_t before_;
};

/// True for text as from_chars takes it: sign, digits with a point, exponent. strtod also takes blanks, a plus sign and
/// hexadecimal.
inline bool is_decimal(const char* first, const char* last) noexcept {
  const auto digits = [&] {
    const char* begin = first;
    while (first != last && *first >= '0' && *first <= '9') ++first;
    return first - begin;
  };
  if (first != last && *first == '-') ++first;
  auto count = digits();
  if (first != last && *first == '.') {
    ++first;
    count += digits();
  }
  if (count == 0) return false;
  if (first != last && (*first == 'e' || *first == 'E')) {
    ++first;
    if (first != last && (*first == '+' || *first == '-')) ++first;
    if (digits() == 0) return false;
  }
  return first == last;
}

/// The whole of [first, last) as the nearest number; false for text, and for what only infinity is nearest to.
inline bool read_number(const char* first, const char* last, double& value) {
  if (!is_decimal(first, last)) return false;
  const std::string text(first, last);  // ends with the zero that strtod wants
  const PlainLocale plain;
  value = std::strtod(text.c_str(), nullptr);
  return is_finite(value);
}

/// Writes the number and returns its end; the buffer holds `longest_number`.
inline char* print_number(char* buffer, double value) {
  const PlainLocale plain;
  if (!is_finite(value)) return buffer + std::snprintf(buffer, longest_number, "%g", value);  // inf, nan
  int digits = 1;
  int length = 0;
  do {
    length = std::snprintf(buffer, longest_number, "%.*e", digits - 1, value);
  } while (std::strtod(buffer, nullptr) != value && ++digits <= 17);
  // without an exponent if that is not longer, as to_chars has it
  const int exponent = std::atoi(std::string_view(buffer, static_cast<std::size_t>(length)).rfind('e') + 1 + buffer);
  char fixed[400];
  const int decimals = digits - 1 > exponent ? digits - 1 - exponent : 0;
  const int fixed_length = std::snprintf(fixed, sizeof fixed, "%.*f", decimals, value);
  if (fixed_length > length) return buffer + length;
  for (int i = 0; i < fixed_length; ++i) buffer[i] = fixed[i];
  return buffer + fixed_length;
}

#else

/// True if a decimal number that from_chars finds out of range is too small for a double, not too large.
inline bool is_tiny(const char* first, const char* last) noexcept {
  long long magnitude = 0;  // of the first digit that is not 0: its place before the point, or less 0 behind it
  bool behind_point = false, found = false;
  for (; first != last && *first != 'e' && *first != 'E'; ++first) {
    found = found || (*first >= '1' && *first <= '9');
    if (*first == '.') behind_point = true;
    if (*first >= '0' && *first <= '9' && found != behind_point) magnitude += behind_point ? -1 : 1;
  }
  if (first == last || ++first == last) return magnitude <= 0;
  if (*first == '+') ++first;
  long long exponent = 0;
  const bool minus = first != last && *first == '-';
  if (std::from_chars(first, last, exponent).ec != std::errc()) return minus;
  return magnitude + exponent <= 0;
}

/// The whole of [first, last) as the nearest number; false for text, and for what only infinity is nearest to.
inline bool read_number(const char* first, const char* last, double& value) {
  const std::from_chars_result result = std::from_chars(first, last, value);
  if (result.ptr != last) return false;
  if (result.ec == std::errc::result_out_of_range && is_tiny(first, last)) {
    value = *first == '-' ? -0.0 : 0.0;
    return true;
  }
  return result.ec == std::errc() && is_finite(value);
}

/// Writes the number and returns its end; the buffer holds `longest_number`.
inline char* print_number(char* buffer, double value) {
  return std::to_chars(buffer, buffer + longest_number, value).ptr;
}

#endif

}  // namespace detail

/// Shortest text that reads back to the same bits.
inline std::string number_text(double value) {
  char buffer[detail::longest_number];
  return std::string(buffer, detail::print_number(buffer, value));
}

/// The whole cell as a finite number; a leading plus sign is accepted.
inline bool parse_number(std::string_view cell, double& value) {
  const char* first = cell.data();
  const char* const last = first + cell.size();
  if (cell.size() > 1 && cell[0] == '+' && cell[1] != '-') ++first;
  return detail::read_number(first, last, value);
}

/// "0x" and sixteen digits: how hashes are written.
inline std::string hexadecimal(std::uint64_t value) {
  char text[17];
  const auto end = std::to_chars(text, text + 16, value, 16).ptr;
  const std::string digits(text, end);
  return "0x" + std::string(16 - digits.size(), '0') + digits;
}

}  // namespace pinnquad
