// SPDX-License-Identifier: MIT
// CRC-32 of a model block: finds every burst of errors up to 32 bits and every odd number of flipped bits.
// No protection against forgery.
#pragma once

#include <cstddef>
#include <cstdint>

#include "pinnquad/core/instruction_set.hpp"

namespace pinnquad {

namespace detail {
/// Remainders of the sixteen half bytes: 64 bytes of flash; a table by bytes would be a kilobyte and twice as fast.
struct Crc32HalfBytes {
  std::uint32_t remainder[16];
};
constexpr Crc32HalfBytes crc32_table() noexcept {
  Crc32HalfBytes table{};
  for (std::uint32_t value = 0; value < 16; ++value) {
    std::uint32_t remainder = value;
    for (int bit = 0; bit < 4; ++bit) remainder = (remainder >> 1) ^ ((remainder & 1u) != 0 ? 0xedb88320u : 0u);
    table.remainder[value] = remainder;
  }
  return table;
}
inline constexpr Crc32HalfBytes crc32_half_bytes = crc32_table();
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// CRC-32 of IEEE 802.3 (polynomial 0x04c11db7, reflected; start and final exclusive-or 0xffffffff), as zlib computes
/// it: crc32 of "123456789" is 0xcbf43926. `before` is the CRC of what stands before these bytes.
constexpr std::uint32_t crc32(const unsigned char* bytes, std::size_t length, std::uint32_t before = 0) noexcept {
  std::uint32_t remainder = ~before;
  for (std::size_t i = 0; i < length; ++i) {
    remainder ^= bytes[i];
    remainder = (remainder >> 4) ^ detail::crc32_half_bytes.remainder[remainder & 15u];
    remainder = (remainder >> 4) ^ detail::crc32_half_bytes.remainder[remainder & 15u];
  }
  return ~remainder;
}

}  // namespace PINNQUAD_INSTRUCTION_SET

}  // namespace pinnquad
