// SPDX-License-Identifier: MIT
// The numbers of a blackbox frame, as Betaflight's and INAV's loggers write them: variable bytes, zigzag, groups of
// small numbers behind a tag. Behind the end all numbers are 0 and `ended()` is true.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace pinnquad::logs::blackbox {

/// How a field is written: the number in a header's "Field X encoding".
enum Encoding : int {
  signed_bytes = 0,
  unsigned_bytes = 1,
  negative_14_bits = 3,
  tagged_8_variable = 6,
  tagged_3_of_32 = 7,
  tagged_4_of_16 = 8,
  nothing = 9,
  tagged_3_variable = 10
};

class FrameBytes {
 public:
  FrameBytes() = default;
  FrameBytes(std::string_view bytes, std::size_t at) : bytes_(bytes), at_(at) {}

  std::size_t at() const noexcept { return at_; }
  bool ended() const noexcept { return ended_; }

  unsigned byte() noexcept {
    if (at_ < bytes_.size()) return static_cast<unsigned char>(bytes_[at_++]);
    ended_ = true;
    return 0;
  }

  /// Seven bits a byte, the lowest first; 0 for one of more than five bytes.
  std::uint32_t unsigned_number() noexcept {
    std::uint32_t value = 0;
    for (int i = 0; i < 5; ++i) {
      const unsigned next = byte();
      if (ended_) return 0;
      value |= static_cast<std::uint32_t>(next & 127u) << (7 * i);
      if (next < 128) return value;
    }
    return 0;
  }

  /// 0, -1, 1, -2 ... for 0, 1, 2, 3 ...
  std::int64_t signed_number() noexcept {
    const std::uint32_t value = unsigned_number();
    return static_cast<std::int32_t>((value >> 1) ^ (0u - (value & 1u)));
  }

  std::int64_t negative_14() noexcept { return -extended(unsigned_number() & 0x3fffu, 14); }

  /// Numbers behind one byte that says which of them are not 0; a lone one has no such byte.
  template <class Values>
  void variable_8(Values& values, std::size_t count) noexcept {
    const unsigned present = count == 1 ? 1 : byte();
    for (std::size_t i = 0; i < count; ++i) values[i] = (present >> i & 1u) != 0 ? signed_number() : 0;
    for (std::size_t i = count; count > 1 && i < 8; ++i) {
      if ((present >> i & 1u) != 0) static_cast<void>(signed_number());
    }
  }

  /// 2, 4 or 6 bits each, or 8 to 32 bits each as the first byte's low bits say.
  template <class Values>
  void three_of_32(Values& values) noexcept {
    const unsigned lead = byte();
    switch (lead >> 6) {
      case 0: two_bits(values, lead); break;
      case 1: {
        const unsigned next = byte();
        values[0] = extended(lead, 4);
        values[1] = extended(next >> 4, 4);
        values[2] = extended(next, 4);
        break;
      }
      case 2:
        values[0] = extended(lead, 6);
        values[1] = extended(byte(), 6);
        values[2] = extended(byte(), 6);
        break;
      default: whole_bytes(values, lead);
    }
  }

  /// 2 bits each, 5, 5 and 4, or 8, 7 and 7 in one run of bits, or as in three_of_32().
  template <class Values>
  void three_variable(Values& values) noexcept {
    const unsigned lead = byte();
    if (lead >> 6 == 0) return two_bits(values, lead);
    if (lead >> 6 == 3) return whole_bytes(values, lead);
    const unsigned second = byte();
    if (lead >> 6 == 1) {
      values[0] = extended(lead >> 1, 5);
      values[1] = extended((lead << 4) | (second >> 4), 5);
      values[2] = extended(second, 4);
      return;
    }
    const unsigned third = byte();
    values[0] = extended((lead << 2) | (second >> 6), 8);
    values[1] = extended((second << 1) | (third >> 7), 7);
    values[2] = extended(third, 7);
  }

  /// 0, 4, 8 or 16 bits each, as two bits of the first byte say. Version 1 of the data packs two fields of 4 bits in a
  /// byte, the second whatever its own tag; version 2 lets halves of bytes run on.
  template <class Values>
  void four_of_16(Values& values, int version) noexcept {
    unsigned tags = byte(), kept = 0;
    bool half = false;
    for (std::size_t i = 0; i < 4; ++i, tags >>= 2) {
      const unsigned bits = std::array<unsigned, 4>{0, 4, 8, 16}[tags & 3u];
      if (version < 2) {
        values[i] = 0;
        if (bits == 4) {
          const unsigned both = byte();
          values[i] = extended(both, 4);
          if (i + 1 == 4) break;
          values[++i] = extended(both >> 4, 4);
          tags >>= 2;
        } else if (bits == 8) {
          values[i] = extended(byte(), 8);
        } else if (bits == 16) {
          const unsigned low = byte();
          values[i] = extended(low | (byte() << 8), 16);
        }
        continue;
      }
      unsigned number = 0;
      for (unsigned left = bits / 4; left > 0;) {
        if (half) {
          number = number << 4 | (kept & 15u);
          half = false;
          --left;
        } else {
          kept = byte();
          half = left == 1;
          number = half ? number << 4 | kept >> 4 : number << 8 | kept;
          left -= half ? 1 : 2;
        }
      }
      values[i] = extended(number, bits);
    }
  }

 private:
  /// The lowest `bits` of a number in two's complement.
  static std::int64_t extended(std::uint32_t value, unsigned bits) noexcept {
    if (bits == 0) return 0;
    const std::int64_t range = std::int64_t{1} << bits, low = static_cast<std::int64_t>(value) & (range - 1);
    return low >= range / 2 ? low - range : low;
  }

  template <class Values>
  static void two_bits(Values& values, unsigned lead) noexcept {
    values[0] = extended(lead >> 4, 2);
    values[1] = extended(lead >> 2, 2);
    values[2] = extended(lead, 2);
  }

  template <class Values>
  void whole_bytes(Values& values, unsigned lead) noexcept {
    for (std::size_t i = 0; i < 3; ++i, lead >>= 2) {
      const unsigned count = (lead & 3u) + 1;
      std::uint32_t number = 0;
      for (unsigned k = 0; k < count; ++k) number |= static_cast<std::uint32_t>(byte()) << (8 * k);
      values[i] = extended(number, 8 * count);
    }
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  bool ended_ = false;
};

}  // namespace pinnquad::logs::blackbox
