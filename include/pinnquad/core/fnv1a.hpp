// SPDX-License-Identifier: MIT
// FNV-1a, 64 bit: names a content (a flight, a model's shape) by a number. Usable at compile time.
// No protection against forgery.
#pragma once

#include <cstdint>
#include <string_view>

namespace pinnquad {
namespace detail {

/// One byte at a time. Source: Fowler, Noll, Vo.
struct Fnv1a {
  std::uint64_t hash = 0xcbf29ce484222325u;

  constexpr void absorb(unsigned char byte) noexcept {
    hash ^= byte;
    hash *= 0x100000001b3u;
  }

  /// Eight bytes, least significant first, whatever the byte order of the machine.
  constexpr void absorb_word(std::uint64_t word) noexcept {
    for (int byte = 0; byte < 8; ++byte) absorb(static_cast<unsigned char>((word >> (8 * byte)) & 0xffu));
  }

  /// The letters of a text, spaces left out, and a zero, so that "ab", "c" is not "a", "bc".
  constexpr void absorb_text(std::string_view text) noexcept {
    for (const char c : text) {
      if (c != ' ') absorb(static_cast<unsigned char>(c));
    }
    absorb(0);
  }
};

}  // namespace detail
}  // namespace pinnquad
