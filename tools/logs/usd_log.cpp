// SPDX-License-Identifier: MIT
#include "logs/usd_log.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "logs/integrated_attitude.hpp"
#include "logs/ulog_types.hpp"
#include "pinnquad/exported/checksum.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/text_file.hpp"

namespace pinnquad::logs {
namespace {

/// The byte that every such file begins with, and a version.
constexpr std::array<std::string_view, 2> magics = {{{"\xbc\x01\0", 3}, {"\xbc\x02\0", 3}}};

/// Little-endian numbers, one after the other.
class Bytes {
 public:
  Bytes(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  std::size_t at() const { return at_; }
  bool holds(std::size_t count) const { return count <= bytes_.size() - at_; }

  double number(ulog::Basic type, std::size_t size) {
    if (!holds(size)) refuse("a number");
    at_ += size;
    return ulog::number(type, bytes_.data() + at_ - size);
  }
  unsigned u16() { return static_cast<unsigned>(number(ulog::Basic::uint16, 2)); }

  std::string text() {
    const std::size_t end = bytes_.find('\0', at_);
    if (end == std::string_view::npos) refuse("a name");
    const std::size_t begin = at_;
    at_ = end + 1;
    return std::string(bytes_.substr(begin, end - begin));
  }

  [[noreturn]] void refuse(const std::string& expected) const {
    throw InputError(path_, 0, 0, expected + " at byte " + std::to_string(at_), "another, or the end");
  }

 private:
  const std::string& path_;
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// The type of a letter; null for none.
const ulog::BasicType* type_of(char letter) {
  constexpr std::string_view letters = "bBhHiI";  // as the first basic types
  if (letter == 'f') return ulog::basic_type("float");
  const std::size_t found = letters.find(letter);
  return found == std::string_view::npos ? nullptr : &ulog::basic_types[found];
}

}  // namespace

bool is_usd_log(std::string_view begin) {
  return std::find(magics.begin(), magics.end(), begin.substr(0, 3)) != magics.end();
}

FlightLog read_usd_log(const std::string& path) {
  const std::string content = file_text(path);
  constexpr std::size_t checksum_bytes = 4;
  FlightLog log;
  log.source = path;
  std::string_view whole = content;
  if (whole.size() > checksum_bytes) {
    const std::size_t end = whole.size() - checksum_bytes;
    const auto sum = ulog::little_endian<std::uint32_t>(whole.data() + end);
    if (crc32(reinterpret_cast<const unsigned char*>(whole.data()), end) == sum) {
      whole.remove_suffix(checksum_bytes);
    } else {
      log.warnings.push_back(path + ": its checksum does not hold: the log was not closed, or is damaged");
    }
  }
  Bytes bytes(path, whole);
  static_cast<void>(bytes.number(ulog::Basic::uint8, 1));
  const unsigned version = bytes.u16();
  struct Event {
    std::size_t topic, length = 0;
    std::vector<ulog::BasicType> types;
  };
  std::map<unsigned, Event> events;
  const unsigned kinds = bytes.u16();
  for (unsigned kind = 0; kind < kinds; ++kind) {
    const unsigned id = bytes.u16();
    Event event{log.topics.size(), 0, {}};
    LogTopic topic = LogTopic::of_bytes(bytes.text(), 0, path);
    const unsigned variables = bytes.u16();
    for (unsigned i = 0; i < variables; ++i) {
      const std::string variable = bytes.text();  // "name(f)"
      if (variable.size() < 4 || variable.back() != ')') bytes.refuse("a variable and its type");
      const ulog::BasicType* const type = type_of(variable[variable.size() - 2]);
      if (type == nullptr) bytes.refuse("a type of a variable that is known");
      event.types.push_back(*type);
      event.length += type->size;
      topic.columns.push_back({variable.substr(0, variable.size() - 3), {}, {}});
    }
    events[id] = event;
    log.topics.push_back(std::move(topic));
  }
  const std::size_t head = version == 1 ? 6 : 10;
  while (bytes.holds(head)) {
    const std::size_t place = bytes.at();
    const auto found = events.find(bytes.u16());
    if (found == events.end()) bytes.refuse("an event that the file's head names");
    const double time_s =
        version == 1 ? 1e-3 * bytes.number(ulog::Basic::uint32, 4) : 1e-6 * bytes.number(ulog::Basic::uint64, 8);
    const Event& event = found->second;
    if (!bytes.holds(event.length)) break;
    LogTopic& topic = log.topics[event.topic];
    topic.time_s.push_back(time_s);
    topic.place.push_back(place);
    for (std::size_t i = 0; i < event.types.size(); ++i) {
      topic.columns[i].values.push_back(bytes.number(event.types[i].type, event.types[i].size));
    }
  }
  for (LogTopic& topic : log.topics) {
    if (topic.size() == 0 || topic.column("stateEstimate.qw") != nullptr) continue;
    add_integrated_attitude(topic, {"gyro.x", "gyro.y", "gyro.z"}, {"acc.x", "acc.y", "acc.z"}, 1);
  }
  return log;
}

}  // namespace pinnquad::logs
