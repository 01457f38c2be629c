// SPDX-License-Identifier: MIT
#include "logs/ulog.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "logs/file_window.hpp"
#include "logs/ulog_format.hpp"
#include "logs/ulog_messages.hpp"
#include "logs/ulog_types.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/logs/flight_log.hpp"

namespace pinnquad::logs {
namespace ulog {

constexpr double ticks_per_s = 1e6;

/// Makes a FlightLog of messages.
class Reader {
 public:
  Reader(FileWindow& file, const std::string& name, const LogSelection& selection)
      : selection_(selection), size_(file.size()), messages_(file, name, log_.warnings) {
    log_.source = name;
  }

  FlightLog read() {
    messages_.walk(*this);
    return std::move(log_);
  }

  bool in_data() const noexcept { return rows_ > 0; }

  void progress(std::uint64_t bytes) { selection_.report(bytes, size_, next_progress_); }

  bool fits(const Message& message) {
    switch (message.type) {
      case 'S': return message.content == sync_message.substr(message_header_size);
      case 'O':
      case 'R': return message.content.size() == 2;
      case 'D': {
        const auto topic = subscription(message);
        return topic != topics_.end() && topic->second.takes(message.content.size() - 2);
      }
      case 'A': return message.content.size() > 3;
      case 'L': return message.content.size() >= 9;
      case 'C': return message.content.size() >= 11;
      case 'F':
      case 'I':
      case 'M':
      case 'P':
      case 'Q': return message.content.size() > 3;
      default: return false;
    }
  }

  Taken take(const Message& message) {
    constexpr std::string_view known = "SORDALCFIMPQ";
    if (known.find(message.type) == std::string_view::npos) {
      const bool letter = (message.type >= 'A' && message.type <= 'Z') || (message.type >= 'a' && message.type <= 'z');
      if (letter && message.type != 'B' && !message.content.empty()) return Taken::unknown;
      throw BadMessage{"a message with a letter for its type", "none"};
    }
    const auto topic = message.type == 'D' ? subscription(message) : topics_.end();
    if (message.type == 'D' && message.content.size() >= 2 && topic == topics_.end()) return Taken::unknown;
    const bool sound =
        topic != topics_.end() ? topic->second.takes(message.content.size() - 2) : message.type != 'D' && fits(message);
    if (!sound) {
      throw BadMessage{std::string("a message of type ") + message.type + " as long as that type demands",
                       std::to_string(message.content.size()) + " bytes"};
    }
    switch (message.type) {
      case 'D': row(topic->second, message); break;
      case 'A': subscribe(message); break;
      case 'R': topics_.erase(little_endian<std::uint16_t>(message.content.data())); break;
      case 'F': formats_.add(parse_format(message.content)); break;
      case 'P': parameter(message); break;
      case 'L':
      case 'C': is_running_ = true; break;
      case 'O': ++log_.dropouts; break;
      default: break;
    }
    return Taken::yes;
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  /// A topic under the number that its rows carry.
  struct Subscription {
    bool wanted = false;
    std::string name;
    int instance = 0;
    std::size_t size = 0;
    std::size_t last_padding = 0;
    std::size_t clock = none;          ///< offset of its time stamp
    std::size_t topic = none;          ///< in the log, from its first row on
    std::vector<Leaf> numbers, texts;  ///< of which values are wanted
    std::vector<std::size_t> columns;  ///< of the numbers, in the log's topic

    bool takes(std::size_t bytes) const noexcept { return bytes <= size && bytes >= size - last_padding; }
  };
  using Subscriptions = std::unordered_map<std::uint16_t, Subscription>;

  Subscriptions::iterator subscription(const Message& message) {
    if (message.content.size() < 2) return topics_.end();
    return topics_.find(little_endian<std::uint16_t>(message.content.data()));
  }

  void subscribe(const Message& message) {
    is_running_ = true;
    Subscription topic;
    topic.instance = little_endian<std::uint8_t>(message.content.data());
    const auto id = little_endian<std::uint16_t>(message.content.data() + 1);
    topic.name = message.content.substr(3);
    if (!formats_.has(topic.name)) {
      throw BadMessage{"a topic whose format stands before it", quoted_cell(topic.name)};
    }
    const auto known = topics_.find(id);
    if (known != topics_.end()) {
      if (known->second.name == topic.name && known->second.instance == topic.instance) return;
      throw BadMessage{"one topic with the number " + std::to_string(id), known->second.name + " and " + topic.name};
    }
    topic.size = formats_.size(topic.name);
    topic.last_padding = formats_.last_padding(topic.name);
    topic.wanted = selection_.wants(topic.name);
    topic.clock = formats_.offset(topic.name, "uint64_t", "timestamp");
    if (topic.clock + 8 > topic.size) {
      topic.clock = none;
      if (topic.wanted) messages_.warn(message.place, topic.name + " has no timestamp of type uint64_t: left out");
      topic.wanted = false;
    }
    topics_.emplace(id, std::move(topic));
  }

  void row(Subscription& from, const Message& message) {
    if (from.wanted && from.topic == none) open(from);
    ++rows_;
    if (from.clock == none) return;
    // a logger may leave out padding at the end, which is behind the last number
    const char* const data = message.content.data() + 2;
    if (!from.wanted) return;
    const double time_s = number(Basic::uint64, data + from.clock) / ticks_per_s;
    LogTopic& topic = log_.topics[from.topic];
    constexpr std::size_t few = 1024;
    if (topic.size() >= few && topic.size() == topic.time_s.capacity()) make_room(topic, from, message.place);
    topic.time_s.push_back(time_s);
    topic.place.push_back(message.place);
    for (std::size_t i = 0; i < from.numbers.size(); ++i) {
      const Leaf& leaf = from.numbers[i];
      const double value = number(leaf.type, data + leaf.offset);
      topic.columns[from.columns[i]].values.push_back(value);
    }
    for (std::size_t i = 0; i < from.texts.size(); ++i) {
      topic.texts[i].values.emplace_back(text_of({data + from.texts[i].offset, from.texts[i].length}));
    }
  }

  /// As much as the rows that are to come take where the rest of the file is like what is before `place`: columns that
  /// grow are there twice, and have half as much too much.
  void make_room(LogTopic& topic, const Subscription& from, std::uint64_t place) const {
    constexpr double spare = 1.02;
    const double share = static_cast<double>(place) / static_cast<double>(size_);
    const auto rows = 1 + static_cast<std::size_t>(spare * static_cast<double>(topic.size()) / share);
    topic.time_s.reserve(rows);
    topic.place.reserve(rows);
    for (const std::size_t column : from.columns) topic.columns[column].values.reserve(rows);
  }

  /// Columns, which a hostile format can have many of, only for a topic that has a row.
  void open(Subscription& from) {
    std::vector<std::string> names;
    for (Leaf& leaf : formats_.leaves(from.name)) {
      if (leaf.type == Basic::character) {
        from.texts.push_back(std::move(leaf));
        continue;
      }
      names.push_back(leaf.column);
      if (!selection_.wants(from.name, leaf.column)) continue;
      from.columns.push_back(names.size() - 1);
      from.numbers.push_back(std::move(leaf));
    }
    const auto [known, is_new] = opened_.emplace(std::make_pair(from.name, from.instance), log_.topics.size());
    from.topic = known->second;
    if (!is_new) return;
    LogTopic topic = LogTopic::of_bytes(from.name, from.instance, log_.source);
    for (std::string& name : names) topic.columns.push_back({std::move(name), {}, {}});
    for (const Leaf& leaf : from.texts) topic.texts.push_back({leaf.column, {}});
    log_.topics.push_back(std::move(topic));
  }

  /// Key and value of a message that begins with the key's length.
  static Field key_of(std::string_view content, std::string_view& value) {
    const std::size_t length = little_endian<std::uint8_t>(content.data());
    if (length + 1 > content.size()) throw BadMessage{"a key that ends before its message", "a longer one"};
    value = content.substr(1 + length);
    return parse_field(content.substr(1, length));
  }

  /// As it stood when the log began. A bad one, on which no row depends, is left out, and said.
  void parameter(const Message& message) {
    try {
      std::string_view value;
      const Field key = key_of(message.content, value);
      const BasicType* const type = basic_type(key.type);
      const bool known = type != nullptr && (type->type == Basic::int32 || type->type == Basic::float32);
      if (!known || key.is_array || value.size() != 4) {
        throw BadMessage{"a parameter of type int32_t or float", quoted_cell(message.content.substr(1))};
      }
      if (!is_running_) log_.parameters[key.name] = number(type->type, value.data());
    } catch (const BadMessage& bad) {
      messages_.warn(message.place, "expected " + bad.expected + ", found " + bad.found + ": left out");
    }
  }

  const LogSelection& selection_;
  std::uint64_t size_;  ///< of the file
  FlightLog log_;
  Messages messages_;
  Formats formats_;
  Subscriptions topics_;  ///< by number
  std::map<std::pair<std::string, int>, std::size_t> opened_;
  bool is_running_ = false;  ///< the log's definitions are over
  std::size_t rows_ = 0;
  std::uint64_t next_progress_ = 0;
};

}  // namespace ulog

FlightLog parse_ulog(std::string_view file, const std::string& name, const LogSelection& selection) {
  FileWindow window(file);
  return ulog::Reader(window, name, selection).read();
}

FlightLog read_ulog(const std::string& path, const LogSelection& selection) {
  FileWindow window(path);
  return ulog::Reader(window, path, selection).read();
}

}  // namespace pinnquad::logs
