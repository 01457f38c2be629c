// SPDX-License-Identifier: MIT
// A ULog file message by message: through its sections, on behind bytes that make no sense, up to where it was cut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "logs/file_window.hpp"
#include "logs/ulog_types.hpp"
#include "pinnquad/io/file_error.hpp"

namespace pinnquad::logs::ulog {

struct Message {
  char type = 0;
  std::string_view content;
  std::uint64_t place = 0;  ///< of its header's first byte in the file
};

/// The outcome of reading a message.
enum class Taken { yes, unknown };

/// Hands over every message of a file. A message that a crash cut is left out. What is wrong is an error before the
/// first row of data, where all is needed; behind it, the walk goes on at the next sync message. What is lost is said
/// in `warnings`.
class Messages {
 public:
  Messages(FileWindow& file, std::string name, std::vector<std::string>& warnings)
      : file_(file), name_(std::move(name)), warnings_(warnings) {}

  /// `reader.take(message)` may throw BadMessage; `reader.fits(message)` says whether one is as its type demands;
  /// `reader.in_data()` whether a row has been read; `reader.progress(bytes)` is told how far the walk is.
  /// Throws InputError: no ULog file, one of an incompatible kind, a bad message before the data.
  template <class Reader>
  void walk(Reader& reader) {
    check_header();
    for (const auto& [begin, end] : sections()) {
      position_ = begin;
      end_ = end;
      while (position_ < end_) {
        reader.progress(position_);
        try {
          step(reader);
        } catch (const BadMessage& bad) {
          if (!reader.in_data()) refuse(position_, bad.expected, bad.found);
          resynchronise(bad);
        }
      }
    }
    if (unknown_ > 0) {
      warn(first_unknown_, std::to_string(unknown_) + (unknown_ == 1 ? " message" : " messages") +
                               " of unknown type or of a topic that was not announced left out, this the first");
    }
    if (unsaid_ > 0) warnings_.push_back(shown() + ": " + std::to_string(unsaid_) + " more places like these");
  }

  /// For a reader's own warnings.
  void warn(std::uint64_t place, const std::string& what) {
    constexpr std::size_t most = 20;
    if (warnings_.size() >= most) {
      ++unsaid_;
    } else {
      warnings_.push_back(shown() + ": byte " + std::to_string(place) + ": " + what);
    }
  }

 private:
  using Section = std::pair<std::uint64_t, std::uint64_t>;

  std::string shown() const { return printable(name_); }

  [[noreturn]] void refuse(std::uint64_t place, const std::string& expected, const std::string& found) const {
    throw InputError(name_, 0, 0, expected + " at byte " + std::to_string(place), found);
  }

  void check_header() {
    const std::string_view header = file_.at(0, file_header_size);
    if (header.substr(0, magic.size()) != magic) {
      throw InputError(name_, 0, 0, "a ULog file, which begins with ULog 01 12 35 (hexadecimal)",
                       header.size() < magic.size() && magic.substr(0, header.size()) == header
                           ? "only " + std::to_string(header.size()) + " bytes"
                           : "other bytes");
    }
    if (header.size() < file_header_size) {
      throw InputError(name_, 0, 0, "a header of 16 bytes", "only " + std::to_string(header.size()));
    }
    const auto version = static_cast<std::uint8_t>(header[version_place]);
    if (version > newest_known_version) {
      warn(version_place, "version " + std::to_string(version) + " of the format, which is newer than this reader");
    }
  }

  /// The log itself, and what a crash dump appended to it.
  std::vector<Section> sections() {
    const std::uint64_t size = file_.size();
    Message flags;
    if (!whole(file_.at(file_header_size, longest_whole), flags) || flags.type != 'B')
      return {{file_header_size, size}};
    const std::uint64_t after = file_header_size + message_header_size + flags.content.size();
    if (flags.content.size() < FlagBits::size) {
      refuse(file_header_size, "flag bits of 40 bytes", std::to_string(flags.content.size()));
    }
    const std::string_view incompatible = flags.content.substr(FlagBits::incompatible, 8);
    const auto first = static_cast<unsigned char>(incompatible[0]);
    if ((first & ~FlagBits::data_appended) != 0 || incompatible.find_first_not_of('\0', 1) != std::string_view::npos) {
      refuse(file_header_size, "a log that this reader can take in",
             "one whose flag bits say that it needs a newer one");
    }
    std::vector<Section> result;
    std::uint64_t begin = after;
    for (std::size_t i = 0; i < FlagBits::offset_count && (first & FlagBits::data_appended) != 0; ++i) {
      const auto offset = little_endian<std::uint64_t>(flags.content.data() + FlagBits::offsets + 8 * i);
      if (offset == 0) break;
      if (offset < begin) {
        refuse(file_header_size, "data appended behind byte " + std::to_string(begin),
               "at byte " + std::to_string(offset));
      }
      if (offset > size) {
        warn(size, "the file ends here, before the data that were appended to it at byte " + std::to_string(offset));
        break;
      }
      result.emplace_back(begin, offset);
      begin = offset;
    }
    result.emplace_back(begin, size);
    return result;
  }

  /// The message at the begin of these bytes; false where it does not end within them.
  static bool whole(std::string_view bytes, Message& message) {
    if (bytes.size() < message_header_size) return false;
    const auto size = little_endian<std::uint16_t>(bytes.data());
    if (size > bytes.size() - message_header_size) return false;
    message.type = bytes[2];
    message.content = bytes.substr(message_header_size, size);
    return true;
  }

  template <class Reader>
  void step(Reader& reader) {
    constexpr std::uint64_t two = 2 * longest_whole;
    static_assert(two <= FileWindow::most, "a message and the one behind it are looked at together");
    const std::string_view bytes = file_.at(position_, static_cast<std::size_t>(std::min(two, end_ - position_)));
    Message message{0, {}, position_};
    if (!whole(bytes, message)) {
      if (file_.find(sync_message, position_ + 1, end_) < end_)
        throw BadMessage{"a message that ends before the next sync message", "a longer one"};
      warn(position_, "the log ends in the middle of a message; what stands before it has been read");
      position_ = end_;
      return;
    }
    const std::size_t size = message_header_size + message.content.size();
    if (message.type != 'D' && message.content.find(sync_message) != std::string_view::npos) {
      throw BadMessage{"a message that ends before the next sync message", "a longer one"};
    }
    if (reader.take(message) == Taken::unknown) {
      // of a newer logger, which is to be ignored, or of bytes that were damaged: then what follows makes no sense
      // either
      Message following;
      if (bytes.size() > size && !(whole(bytes.substr(size), following) && reader.fits(following))) {
        throw BadMessage{"a message of a known type and topic", "another one, and no message behind it"};
      }
      if (unknown_++ == 0) first_unknown_ = position_;
    }
    position_ += size;
  }

  void resynchronise(const BadMessage& bad) {
    const std::uint64_t next = file_.find(sync_message, position_ + 1, end_);
    const std::string lost = std::to_string(next - position_);
    warn(position_,
         "expected " + bad.expected + ", found " + bad.found + ": " + lost +
             (next < end_ ? " bytes left out, up to the next sync message" : " bytes left out, up to the end"));
    position_ = next;
  }

  static constexpr std::size_t longest_whole = message_header_size + longest_message;

  FileWindow& file_;
  std::string name_;
  std::vector<std::string>& warnings_;
  std::uint64_t position_ = 0, end_ = 0;
  std::uint64_t first_unknown_ = 0;
  std::size_t unknown_ = 0, unsaid_ = 0;
};

}  // namespace pinnquad::logs::ulog
