// SPDX-License-Identifier: MIT
// The parts of a ULog file, as PX4's public description of the format has it (docs.px4.io, "ULog File Format"):
// numbers in little-endian order, messages behind a header of three bytes, basic types of fields.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace pinnquad::logs::ulog {

inline constexpr std::string_view magic{"ULog\x01\x12\x35", 7};
inline constexpr std::size_t version_place = 7;
inline constexpr std::size_t file_header_size = 16;  ///< magic, version, time stamp of the log's start
inline constexpr std::uint8_t newest_known_version = 1;

inline constexpr std::size_t message_header_size = 3;  ///< size of what follows, 2 bytes; type
inline constexpr std::size_t longest_message = 65535;

/// Header and content of a sync message, which is what a reader looks for behind bytes that make no sense.
inline constexpr std::string_view sync_message{
    "\x08\x00S"
    "\x2f\x73\x13\x20\x25\x0c\xbb\x12",
    11};

/// The begin of the flag bits message, which may go on behind.
struct FlagBits {
  static constexpr std::size_t incompatible = 8, offsets = 16, offset_count = 3, size = 40;
  static constexpr unsigned data_appended = 1;  ///< of the first byte of `incompatible`
};

/// Something in a message that the format rules out. Who reads messages knows where it stands.
struct BadMessage {
  std::string expected;
  std::string found;
};

template <class Integer>
Integer little_endian(const char* at) noexcept {
  Integer value{};
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
  std::memcpy(&value, at, sizeof value);
#else
  std::uint64_t bits = 0;
  for (std::size_t byte = 0; byte < sizeof(Integer); ++byte) {
    bits |= std::uint64_t{static_cast<unsigned char>(at[byte])} << (8 * byte);
  }
  value = static_cast<Integer>(bits);
#endif
  return value;
}

template <class Real, class Bits>
double real(const char* at) noexcept {
  const Bits bits = little_endian<Bits>(at);
  Real value;
  static_assert(sizeof value == sizeof bits, "a number has as many bytes as its bits");
  std::memcpy(&value, &bits, sizeof value);
  return static_cast<double>(value);
}

enum class Basic { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64, boolean, character };

struct BasicType {
  std::string_view name;
  Basic type;
  std::size_t size;
};

inline constexpr std::array<BasicType, 12> basic_types{{{"int8_t", Basic::int8, 1},
                                                        {"uint8_t", Basic::uint8, 1},
                                                        {"int16_t", Basic::int16, 2},
                                                        {"uint16_t", Basic::uint16, 2},
                                                        {"int32_t", Basic::int32, 4},
                                                        {"uint32_t", Basic::uint32, 4},
                                                        {"int64_t", Basic::int64, 8},
                                                        {"uint64_t", Basic::uint64, 8},
                                                        {"float", Basic::float32, 4},
                                                        {"double", Basic::float64, 8},
                                                        {"bool", Basic::boolean, 1},
                                                        {"char", Basic::character, 1}}};

/// Null for what is the name of a format.
inline const BasicType* basic_type(std::string_view name) noexcept {
  const auto* found =
      std::find_if(basic_types.begin(), basic_types.end(), [name](const BasicType& type) { return type.name == name; });
  return found == basic_types.end() ? nullptr : found;
}

/// The number of such a type whose bytes begin there. Integers beyond 2^53 are rounded.
inline double number(Basic type, const char* at) noexcept {
  switch (type) {
    case Basic::int8: return little_endian<std::int8_t>(at);
    case Basic::int16: return little_endian<std::int16_t>(at);
    case Basic::uint16: return little_endian<std::uint16_t>(at);
    case Basic::int32: return little_endian<std::int32_t>(at);
    case Basic::uint32: return little_endian<std::uint32_t>(at);
    case Basic::int64: return static_cast<double>(little_endian<std::int64_t>(at));
    case Basic::uint64: return static_cast<double>(little_endian<std::uint64_t>(at));
    case Basic::float32: return real<float, std::uint32_t>(at);
    case Basic::float64: return real<double, std::uint64_t>(at);
    case Basic::uint8:
    case Basic::boolean:
    case Basic::character: break;
  }
  return little_endian<std::uint8_t>(at);
}

/// The text of a char array: up to a zero, if one ends it early.
inline std::string_view text_of(std::string_view bytes) noexcept {
  return bytes.substr(0, std::min(bytes.find('\0'), bytes.size()));
}

}  // namespace pinnquad::logs::ulog
