// SPDX-License-Identifier: MIT
#include "logs/blackbox_header.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include "logs/blackbox_bytes.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/io/file_error.hpp"

namespace pinnquad::logs::blackbox {
namespace {

/// A whole number at the begin of a text; `otherwise` for none, and for one beyond 32 bits.
std::int64_t whole_number(std::string_view text, std::int64_t otherwise) {
  std::int32_t value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  return end.ec == std::errc() ? value : otherwise;
}

std::vector<std::string_view> parts_of(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0, end = 0; end != std::string_view::npos && !text.empty(); begin = end + 1) {
    end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end == std::string_view::npos ? end : end - begin));
  }
  return parts;
}

/// The float whose bits "0x3f800000" are; 1 for no positive number.
double real_of_bits(std::string_view text) {
  if (text.substr(0, 2) == "0x") text.remove_prefix(2);
  std::uint32_t bits = 0;
  std::from_chars(text.data(), text.data() + text.size(), bits, 16);
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return std::isfinite(value) && value > 0 ? static_cast<double>(value) : 1.0;
}

class HeaderLines {
 public:
  HeaderLines(std::string_view file, std::size_t begin, const std::string& name)
      : file_(file), name_(name), at_(begin) {}

  Header read() {
    constexpr std::size_t longest_line = 8192;
    while (file_.substr(at_, 2) == "H ") {
      const std::string_view rest = file_.substr(at_ + 2, longest_line);
      const std::size_t end = rest.find('\n'), colon = rest.find(':');
      if (end == std::string_view::npos || colon >= end) break;
      std::string_view value = rest.substr(colon + 1, end - colon - 1);
      if (!value.empty() && value.back() == '\r') value.remove_suffix(1);
      line(rest.substr(0, colon), value);
      at_ += 2 + end + 1;
    }
    header_.end = at_;
    finish();
    return std::move(header_);
  }

 private:
  [[noreturn]] void refuse(const std::string& expected, const std::string& found) const {
    throw InputError(name_, 0, 0, expected + " at byte " + std::to_string(at_), found);
  }

  void line(std::string_view key, std::string_view value) {
    if (key.size() > 8 && key.substr(0, 6) == "Field " && key[7] == ' ') {
      return fields(key[6], key.substr(8), value);
    }
    header_.texts[std::string(key)] = std::string(value);
  }

  void fields(char letter, std::string_view what, std::string_view value) {
    constexpr std::size_t most_fields = 512;
    constexpr std::string_view letters = "IPSGH";
    if (letters.find(letter) == std::string_view::npos) return;
    const std::vector<std::string_view> parts = parts_of(value, ',');
    std::vector<Field>& own = header_.frames[letter];
    if (what == "name" && letter == 'P') return;  // they are those of I
    if (what == "name") {
      if (parts.empty() || parts.size() > most_fields) {
        refuse("1 to 512 fields of a frame " + std::string(1, letter), std::to_string(parts.size()));
      }
      own.assign(parts.size(), Field{});
      for (std::size_t i = 0; i < parts.size(); ++i) own[i].name = std::string(parts[i]);
      if (letter == 'I') header_.frames['P'] = own;
      return;
    }
    if (what != "signed" && what != "predictor" && what != "encoding") return;
    if (parts.size() < own.size() || own.empty()) {
      refuse("as many numbers in \"Field " + std::string(1, letter) + " " + std::string(what) + "\" as it has names, " +
                 std::to_string(own.size()),
             std::to_string(parts.size()));
    }
    for (std::size_t i = 0; i < own.size(); ++i) {
      const int number = static_cast<int>(whole_number(parts[i], -1));
      if (what == "signed") {
        own[i].is_signed = number == 1;
        if (letter == 'I') header_.frames['P'][i].is_signed = own[i].is_signed;
      } else if (what == "predictor") {
        own[i].predictor = number;
        if (number < zero || number > least_motor) refuse("predictors 0 to 11", quoted_cell(parts[i]));
      } else {
        own[i].encoding = number;
        if (number < signed_bytes || number == 2 || number == 4 || number == 5 || number > tagged_3_variable) {
          refuse("an encoding that Betaflight or INAV writes (0, 1, 3, 6 to 10)", quoted_cell(parts[i]));
        }
      }
    }
  }

  std::string_view text(const char* key) const {
    const auto found = header_.texts.find(key);
    return found == header_.texts.end() ? std::string_view() : std::string_view(found->second);
  }

  void finish() {
    const std::vector<Field>* main = header_.fields('I');
    if (main == nullptr || main->size() < 2 || (*main)[1].name != "time") {
      refuse("a head whose \"Field I name\" begins with loopIteration,time", main == nullptr ? "none" : "other fields");
    }
    header_.data_version = static_cast<int>(whole_number(text("Data version"), 2));
    header_.every_i = std::max<std::int64_t>(1, whole_number(text("I interval"), 32));
    // "1/4", or since Betaflight 3.4 the 4 alone
    const std::vector<std::string_view> interval = parts_of(text("P interval"), '/');
    if (interval.size() == 2) header_.logged = std::max<std::int64_t>(1, whole_number(interval[0], 1));
    if (!interval.empty()) header_.of_iterations = std::max<std::int64_t>(1, whole_number(interval.back(), 1));
    header_.least_throttle = whole_number(text("minthrottle"), header_.least_throttle);
    header_.reference_voltage = whole_number(text("vbatref"), header_.reference_voltage);
    header_.least_motor = header_.least_throttle;
    header_.most_motor = whole_number(text("maxthrottle"), 0);
    const std::vector<std::string_view> motors = parts_of(text("motorOutput"), ',');
    if (motors.size() == 2) {
      header_.least_motor = whole_number(motors[0], header_.least_motor);
      header_.most_motor = whole_number(motors[1], header_.most_motor);
    }
    const std::string_view scale = text(header_.texts.count("gyro_scale") != 0 ? "gyro_scale" : "gyro.scale");
    if (!scale.empty()) header_.gyro_deg_s = real_of_bits(scale);
    header_.acceleration_1g = static_cast<double>(std::max<std::int64_t>(0, whole_number(text("acc_1G"), 0)));
  }

  std::string_view file_;
  const std::string& name_;
  std::size_t at_;
  Header header_;
};

}  // namespace

bool Header::is_inav() const {
  const auto found = texts.find("Firmware revision");
  return found != texts.end() && found->second.compare(0, 4, "INAV") == 0;
}

bool Header::is_at_least(int major, int minor) const {
  const auto found = texts.find("Firmware revision");
  if (found == texts.end()) return false;
  const std::vector<std::string_view> words = parts_of(found->second, ' ');
  if (words.size() < 2) return false;
  const std::vector<std::string_view> numbers = parts_of(words[1], '.');
  const std::int64_t own_major = numbers.empty() ? 0 : whole_number(numbers[0], 0);
  const std::int64_t own_minor = numbers.size() < 2 ? 0 : whole_number(numbers[1], 0);
  return own_major > major || (own_major == major && own_minor >= minor);
}

Header read_header(std::string_view file, std::size_t begin, const std::string& name) {
  return HeaderLines(file, begin, name).read();
}

}  // namespace pinnquad::logs::blackbox
