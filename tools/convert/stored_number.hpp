// SPDX-License-Identifier: MIT
// Numbers as files of weights store them, least significant byte first: double holds each of them exactly.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace programs {

/// Types of IEEE 754, and bfloat16: the upper half of a float.
enum class StoredNumber { float64, float32, float16, bfloat16 };

constexpr std::size_t bytes_of(StoredNumber type) {
  return type == StoredNumber::float64 ? 8 : (type == StoredNumber::float32 ? 4 : 2);
}

/// A sign, 5 bits of exponent (bias 15), 10 of the fraction.
inline double half_number(std::uint32_t bits) {
  const int exponent = static_cast<int>(bits >> 10 & 0x1f);
  const double fraction = static_cast<double>(bits & 0x3ff), sign = (bits & 0x8000) != 0 ? -1 : 1;
  if (exponent == 0x1f) {
    return fraction > 0 ? std::numeric_limits<double>::quiet_NaN() : sign * std::numeric_limits<double>::infinity();
  }
  return sign * (exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25));
}

/// The number of `bits`, of which the lowest bytes_of(type) bytes count.
inline double number_of(std::uint64_t bits, StoredNumber type) {
  if (type == StoredNumber::float64) {
    double number = 0;
    std::memcpy(&number, &bits, sizeof number);
    return number;
  }
  const auto narrow = static_cast<std::uint32_t>(bits);
  if (type == StoredNumber::float16) return half_number(narrow);
  const std::uint32_t single = type == StoredNumber::bfloat16 ? narrow << 16 : narrow;
  float number = 0;
  std::memcpy(&number, &single, sizeof number);
  return static_cast<double>(number);
}

/// The number whose bytes begin at `from`.
inline double number_at(const char* from, StoredNumber type) {
  std::uint64_t bits = 0;
  for (std::size_t i = bytes_of(type); i > 0; --i) bits = bits << 8 | static_cast<unsigned char>(from[i - 1]);
  return number_of(bits, type);
}

}  // namespace programs
