// SPDX-License-Identifier: MIT
// A Crazyflie's log on its uSD card: events, each with named variables, as its firmware's deck driver says and
// its own reader reads (versions 1 and 2). Times are those of the firmware's clock.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "logs/flight_log.hpp"
#include "pinnquad/exported/checksum.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/text_file.hpp"

namespace programs {

namespace usd {

/// The byte that every such file begins with, and a version.
inline constexpr std::array<std::string_view, 2> magics = {{{"\xbc\x01\0", 3}, {"\xbc\x02\0", 3}}};

inline bool begins(std::string_view bytes) {
  return bytes.substr(0, 3) == magics[0] || bytes.substr(0, 3) == magics[1];
}

/// Little-endian numbers, one after the other.
class Bytes {
 public:
  Bytes(const std::string& path, const std::string& bytes, std::size_t end) : path_(path), bytes_(bytes), end_(end) {}

  std::size_t at() const { return at_; }
  bool holds(std::size_t count) const { return count <= end_ - at_; }

  template <class Number>
  Number number() {
    need(sizeof(Number));
    std::uint64_t bits = 0;
    for (std::size_t i = sizeof(Number); i-- > 0;) bits = bits << 8 | static_cast<unsigned char>(bytes_[at_ + i]);
    at_ += sizeof(Number);
    Number value;
    if constexpr (sizeof(Number) == 8) {
      std::memcpy(&value, &bits, 8);
    } else {
      const auto part = static_cast<std::uint32_t>(bits);
      if constexpr (sizeof(Number) == 4) {
        std::memcpy(&value, &part, 4);
      } else {
        value = static_cast<Number>(part);
      }
    }
    return value;
  }

  std::string text() {
    const std::size_t end = bytes_.find('\0', at_);
    if (end == std::string::npos || end >= end_) refuse("a name");
    std::string result = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return result;
  }

  [[noreturn]] void refuse(const std::string& expected) const {
    throw pinnquad::InputError(path_, 0, 0, expected + " at byte " + std::to_string(at_), "another, or the end");
  }

 private:
  void need(std::size_t count) const {
    if (!holds(count)) refuse("a number");
  }

  const std::string& path_;
  const std::string& bytes_;
  std::size_t end_, at_ = 0;
};

/// By the letter of its type.
inline double variable(Bytes& bytes, char type) {
  switch (type) {
    case 'B': return bytes.number<std::uint8_t>();
    case 'b': return bytes.number<std::int8_t>();
    case 'H': return bytes.number<std::uint16_t>();
    case 'h': return bytes.number<std::int16_t>();
    case 'I': return bytes.number<std::uint32_t>();
    case 'i': return bytes.number<std::int32_t>();
    case 'f': return static_cast<double>(bytes.number<float>());
    default: bytes.refuse("a type of a variable that is known");
  }
}
inline std::size_t size_of(char type) { return type == 'B' || type == 'b' ? 1 : (type == 'H' || type == 'h' ? 2 : 4); }

}  // namespace usd

/// A topic for each kind of event. What is whole of a log that ends early is read, and `warnings` say so. Throws
/// InputError, one line, for what is no such file.
inline FlightLog read_usd_log(const std::string& path) {
  const std::string content = pinnquad::file_text(path);
  constexpr std::size_t checksum_bytes = 4;
  FlightLog log;
  log.source = path;
  std::size_t end = content.size();
  const auto* raw = reinterpret_cast<const unsigned char*>(content.data());
  if (end > checksum_bytes) {
    std::uint32_t sum = 0;
    for (std::size_t i = 4; i-- > 0;) sum = sum << 8 | raw[end - checksum_bytes + i];
    if (pinnquad::crc32(raw, end - checksum_bytes) == sum) {
      end -= checksum_bytes;
    } else {
      log.warnings.push_back(path + ": its checksum does not hold: the log was not closed, or is damaged");
    }
  }
  usd::Bytes bytes(path, content, end);
  static_cast<void>(bytes.number<std::uint8_t>());
  const auto version = bytes.number<std::uint16_t>();
  struct Event {
    std::size_t topic, length = 0;
    std::string types;
  };
  std::map<std::uint16_t, Event> events;
  const auto kinds = bytes.number<std::uint16_t>();
  for (unsigned kind = 0; kind < kinds; ++kind) {
    const auto id = bytes.number<std::uint16_t>();
    Event event{log.topics.size(), 0, {}};
    LogTopic topic;
    topic.name = bytes.text();
    topic.file = path;
    topic.places_are_lines = false;
    const auto variables = bytes.number<std::uint16_t>();
    for (unsigned i = 0; i < variables; ++i) {
      const std::string variable = bytes.text();  // "name(f)"
      if (variable.size() < 4 || variable.back() != ')') bytes.refuse("a variable and its type");
      event.types += variable[variable.size() - 2];
      event.length += usd::size_of(event.types.back());
      topic.columns.push_back({variable.substr(0, variable.size() - 3), {}});
    }
    events[id] = event;
    log.topics.push_back(std::move(topic));
  }
  const std::size_t head = version == 1 ? 6 : 10;
  while (bytes.holds(head)) {
    const std::size_t place = bytes.at();
    const auto found = events.find(bytes.number<std::uint16_t>());
    if (found == events.end()) bytes.refuse("an event that the file's head names");
    const double time_s =
        version == 1 ? 1e-3 * bytes.number<std::uint32_t>() : 1e-6 * static_cast<double>(bytes.number<std::uint64_t>());
    const Event& event = found->second;
    if (!bytes.holds(event.length)) break;
    LogTopic& topic = log.topics[event.topic];
    topic.time_s.push_back(time_s);
    topic.place.push_back(place);
    for (std::size_t i = 0; i < event.types.size(); ++i) {
      topic.columns[i].values.push_back(usd::variable(bytes, event.types[i]));
    }
  }
  return log;
}

}  // namespace programs
