// SPDX-License-Identifier: MIT
#include "logs/blackbox.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "logs/blackbox_bytes.hpp"
#include "logs/blackbox_header.hpp"
#include "logs/csv_head.hpp"
#include "logs/integrated_attitude.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/logs/flight_log.hpp"

namespace pinnquad::logs {
namespace blackbox {
namespace {

constexpr double g_m_s2 = 9.80665;
constexpr double ticks_per_s = 1e6;
constexpr std::size_t clock_field = 1;  ///< of a main frame, behind the iteration's count

using Numbers = std::vector<std::int64_t>;

bool starts_with(std::string_view text, std::string_view begin) { return text.substr(0, begin.size()) == begin; }

/// In two's complement, whatever a damaged log adds up.
std::int64_t sum(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

/// A column's unit as blackbox_decode has it, and the factor to it.
struct Shown {
  std::string unit;
  double factor = 1;
};

Shown shown_as(const std::string& field, const Header& header) {
  if (field == "time") return {" (us)"};
  if (starts_with(field, "gyroADC[") || starts_with(field, "gyroData[")) return {" (deg/s)", header.gyro_deg_s};
  if (starts_with(field, "accSmooth[") && header.acceleration_1g > 0)
    return {" (m/s/s)", g_m_s2 / header.acceleration_1g};
  if (field == "BaroAlt") return {" (cm)"};
  if (field == "amperageLatest" || field == "amperage") return {" (A)", 0.01};
  const bool hundredths = header.is_inav() ? header.is_at_least(2, 0) : header.is_at_least(4, 3);
  if (field == "vbatLatest" || field == "vbat") return {" (V)", hundredths ? 0.01 : 0.1};
  return {"", 1};
}

/// Frame by frame through one flight's log.
class Reader {
 public:
  Reader(std::string_view flight, std::size_t begin, const std::string& name, const LogSelection& selection)
      : file_(flight), name_(name), selection_(selection), header_(read_header(flight, begin, name)) {
    const std::size_t fields = header_.fields('I')->size();
    for (Numbers* frame : {&now_, &before_, &before_that_}) frame->assign(fields, 0);
    log_.source = name;
    open("", *header_.fields('I'), main_);
    if (const std::vector<Field>* gps = header_.fields('G')) open("gps", *gps, gps_);
    if (const std::vector<Field>* slow = header_.fields('S')) open("slow", *slow, slow_);
  }

  FlightLog read() {
    say_header();
    walk();
    if (lost_ > 0) {
      log_.warnings.push_back(printable(name_) + ": byte " + std::to_string(first_lost_) + ": " +
                              std::to_string(lost_) + (lost_ == 1 ? " damaged place" : " damaged places") +
                              ", this the first, and " + std::to_string(left_out_) +
                              " frames that build on them are left out");
    }
    if (main_.topic.size() > 0) add_attitude();
    for (Table* table : {&main_, &gps_, &slow_}) {
      if (table->topic.size() > 0) log_.topics.push_back(std::move(table->topic));
    }
    return std::move(log_);
  }

 private:
  struct Table {
    LogTopic topic;
    std::vector<double> factors;
    Numbers last;
  };

  /// The end of a decoded frame.
  struct Outcome {
    std::size_t end = 0;
    bool cut = false;  ///< the log ended within it
  };

  void open(const std::string& name, const std::vector<Field>& fields, Table& table) const {
    table.topic = LogTopic::of_bytes(name, 0, name_);
    table.last.assign(fields.size(), 0);
    for (const Field& field : fields) {
      const Shown shown = shown_as(field.name, header_);
      table.factors.push_back(shown.factor);
      table.topic.columns.push_back({field.name + shown.unit, {}});
    }
  }

  void say_header() {
    for (const auto& [key, text] : header_.texts) keep_parameters(log_, key, text);
    if (header_.most_motor <= header_.least_motor) return;
    log_.parameters["motorOutput[0]"] = static_cast<double>(header_.least_motor);
    log_.parameters["motorOutput[1]"] = static_cast<double>(header_.most_motor);
  }

  void walk() {
    constexpr std::string_view letters = "IPGHES";
    constexpr std::size_t longest_frame = 256;
    std::size_t at = header_.end;
    std::uint64_t next_report = 0;
    while (at < file_.size()) {
      selection_.report(at, file_.size(), next_report);
      const char letter = file_[at];
      if (letters.find(letter) == std::string_view::npos) {
        if (is_valid_ || main_.topic.size() == 0) lose(at, main_.topic.size() > 0);
        is_valid_ = false;
        ++at;
        continue;
      }
      const Outcome frame = decode(letter, at + 1);
      const bool at_end = ended_ || frame.end >= file_.size();  // pages of flash are filled behind a log's end
      const bool whole = at_end ? !frame.cut : letters.find(file_[frame.end]) != std::string_view::npos;
      if (frame.end - at - 1 > longest_frame || !whole) {
        lose(at, true);
        is_valid_ = false;
        ++at;
        continue;
      }
      complete(letter, at);
      if (ended_) break;
      at = frame.end;
    }
  }

  void lose(std::size_t place, bool count) {
    if (!count) return;
    if (lost_++ == 0) first_lost_ = place;
  }

  Outcome decode(char letter, std::size_t at) {
    FrameBytes bytes(file_, at);
    if (letter == 'E') {
      event(bytes);
    } else if (letter == 'I') {
      has_history_ ? numbers(bytes, 'I', now_, &before_, nullptr) : numbers(bytes, 'I', now_, nullptr, nullptr);
    } else if (letter == 'P') {
      skipped_ = skipped_iterations();
      has_history_ ? numbers(bytes, 'P', now_, &before_, &before_that_) : numbers(bytes, 'P', now_, nullptr, nullptr);
    } else if (letter == 'H') {
      next_home_.assign(header_.fields('H') == nullptr ? 0 : header_.fields('H')->size(), 0);
      numbers(bytes, 'H', next_home_, nullptr, nullptr);
    } else {
      Table& table = letter == 'G' ? gps_ : slow_;
      numbers(bytes, letter, table.last, nullptr, nullptr);
    }
    return {bytes.at(), bytes.ended()};
  }

  /// The fields of one frame. Fields of a group share their encoding's tag.
  void numbers(FrameBytes& bytes, char letter, Numbers& frame, const Numbers* before, const Numbers* before_that) {
    const std::vector<Field>* const fields = header_.fields(letter);
    if (fields == nullptr) return;
    std::array<std::int64_t, 8> group{};
    for (std::size_t i = 0; i < fields->size();) {
      const Field& field = (*fields)[i];
      if (field.predictor == counted) {
        frame[i] = sum(skipped_ + 1, before == nullptr ? 0 : (*before)[i]);
        ++i;
        continue;
      }
      std::size_t count = 1;
      switch (field.encoding) {
        case signed_bytes: group[0] = bytes.signed_number(); break;
        case unsigned_bytes: group[0] = bytes.unsigned_number(); break;
        case negative_14_bits: group[0] = bytes.negative_14(); break;
        case tagged_4_of_16:
          bytes.four_of_16(group, header_.data_version);
          count = 4;
          break;
        case tagged_3_of_32:
          bytes.three_of_32(group);
          count = 3;
          break;
        case tagged_3_variable:
          bytes.three_variable(group);
          count = 3;
          break;
        case tagged_8_variable:
          while (count < 8 && i + count < fields->size() && (*fields)[i + count].encoding == tagged_8_variable) ++count;
          bytes.variable_8(group, count);
          break;
        default: group[0] = 0; break;
      }
      const bool alone = count == 1 && field.encoding != tagged_8_variable;
      for (std::size_t k = 0; k < count && i < fields->size(); ++k, ++i) {
        const std::int64_t value = sum(group[k], predicted(*fields, i, frame, before, before_that));
        if (!alone) {
          frame[i] = value;
        } else if ((*fields)[i].is_signed) {
          frame[i] = static_cast<std::int32_t>(value);
        } else {
          frame[i] = static_cast<std::uint32_t>(value);
        }
      }
    }
  }

  std::int64_t predicted(const std::vector<Field>& fields, std::size_t i, const Numbers& frame, const Numbers* before,
                         const Numbers* before_that) const {
    switch (fields[i].predictor) {
      case least_throttle: return header_.least_throttle;
      case fixed_1500: return 1500;
      case reference_voltage: return header_.reference_voltage;
      case least_motor: return header_.least_motor;
      case first_motor: {
        for (std::size_t k = 0; k < i; ++k) {
          if (fields[k].name == "motor[0]") return frame[k];
        }
        return 0;
      }
      case previous: return before == nullptr ? 0 : (*before)[i];
      case straight_line: {
        if (before == nullptr) return 0;
        if (before_that == nullptr) return (*before)[i];
        const auto last = static_cast<std::uint64_t>((*before)[i]);
        return static_cast<std::int64_t>(2 * last - static_cast<std::uint64_t>((*before_that)[i]));
      }
      case average_of_two:
        if (before == nullptr) return 0;
        return before_that == nullptr ? (*before)[i] : sum((*before)[i], (*before_that)[i]) / 2;
      case home: {
        const std::size_t which = i > 0 && fields[i - 1].predictor == home ? 1 : 0;
        return which < home_.size() ? home_[which] : 0;
      }
      case last_time: return has_history_ ? before_[clock_field] : 0;
      default: return 0;
    }
  }

  /// Iterations without a frame, as the header's intervals have it, up to the next one that has.
  std::int64_t skipped_iterations() const {
    constexpr std::int64_t most = 5000;
    if (!has_last_) return 0;
    std::int64_t count = 0;
    const auto is_logged = [this](std::int64_t iteration) {
      return (iteration % header_.every_i + header_.logged - 1) % header_.of_iterations < header_.logged;
    };
    while (count < most && !is_logged(last_iteration_ + 1 + count)) ++count;
    return count;
  }

  void event(FrameBytes& bytes) {
    const auto skip = [&bytes](int count) {
      for (int i = 0; i < count; ++i) static_cast<void>(bytes.byte());
    };
    resumes_ = false;
    switch (bytes.byte()) {
      case 0:   // beep to synchronise by
      case 15:  // disarmed, why
      case 40:  // the gyroscope failed, how
        static_cast<void>(bytes.unsigned_number());
        break;
      case 10: skip(5); break;
      case 11: skip(4); break;
      case 12: skip(8); break;
      case 13:  // a setting changed in flight
        if (bytes.byte() > 127) {
          skip(4);
        } else {
          static_cast<void>(bytes.signed_number());
        }
        break;
      case 14:
        resumes_ = true;
        resumed_iteration_ = bytes.unsigned_number();
        resumed_time_ = bytes.unsigned_number();
        break;
      case 20:  // a cycle of G-tune
        skip(1);
        static_cast<void>(bytes.signed_number());
        skip(2);
        break;
      case 30:  // flight mode, now and before
        static_cast<void>(bytes.unsigned_number());
        static_cast<void>(bytes.unsigned_number());
        break;
      case 255: {
        constexpr std::string_view words{"End of log\0", 11};
        ended_ = file_.substr(bytes.at(), words.size()) == words;
        if (ended_) skip(static_cast<int>(words.size()));
        break;
      }
      default: break;
    }
  }

  void complete(char letter, std::size_t place) {
    switch (letter) {
      case 'I':
      case 'P': complete_main(letter, place); break;
      case 'H':
        home_ = next_home_;
        has_home_ = !home_.empty();
        break;
      case 'G': complete_gps(place); break;
      case 'S': row(slow_, slow_.last, last_time_, place); break;
      case 'E':
        if (!resumes_) break;
        if (has_last_ && resumed_time_ > last_time_ % wrap) ++log_.dropouts;
        last_iteration_ = resumed_iteration_;
        last_time_ = resumed_time_ + wrapped_;
        has_last_ = true;
        break;
      default: break;
    }
  }

  /// Behind the last time a clock of 32 bits that has run over.
  std::int64_t unwrapped(std::int64_t time) {
    const std::int64_t low = time & (wrap - 1);
    if (has_last_) {
      const std::int64_t last = last_time_ & (wrap - 1), ahead = (low - last) & (wrap - 1);
      if (low < last && ahead < longest_pause) wrapped_ += wrap;
    }
    return low + wrapped_;
  }

  void complete_main(char letter, std::size_t place) {
    constexpr std::int64_t most_iterations = 5000;
    now_[clock_field] = unwrapped(now_[clock_field]);
    const std::int64_t iteration = now_[0] & (wrap - 1), time = now_[clock_field];
    const bool follows = iteration >= last_iteration_ && iteration < last_iteration_ + most_iterations &&
                         time >= last_time_ && time < last_time_ + longest_pause;
    const bool was_valid = is_valid_;
    if (letter == 'I') is_valid_ = !has_last_ || follows;
    if (letter == 'P') is_valid_ = is_valid_ && follows;
    if (!is_valid_) {
      if (was_valid || letter == 'I') {
        lose(place, true);
        has_history_ = false;
      }
      ++left_out_;
      return;
    }
    last_iteration_ = iteration;
    last_time_ = time;
    has_last_ = true;
    row(main_, now_, time, place);
    before_that_ = letter == 'I' ? now_ : before_;
    before_ = now_;
    has_history_ = true;
  }

  void complete_gps(std::size_t place) {
    if (gps_.last.empty()) return;  // a letter where no frame is
    const std::vector<Field>& fields = *header_.fields('G');
    const bool needs_home =
        std::any_of(fields.begin(), fields.end(), [](const Field& field) { return field.predictor == home; });
    if ((needs_home && !has_home_) || !has_last_) return;
    const bool has_clock = fields[0].name == "time";
    if (has_clock) gps_.last[0] = unwrapped(gps_.last[0]);
    row(gps_, gps_.last, has_clock ? gps_.last[0] : last_time_, place);
  }

  static void row(Table& table, const Numbers& numbers, std::int64_t time, std::size_t place) {
    if (numbers.empty()) return;
    table.topic.time_s.push_back(static_cast<double>(time) / ticks_per_s);
    table.topic.place.push_back(place);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      table.topic.columns[i].values.push_back(static_cast<double>(numbers[i]) * table.factors[i]);
    }
  }

  /// As --simulate-imu has it.
  void add_attitude() {
    LogTopic& topic = main_.topic;
    if (topic.column("imuQuaternion[0]") != nullptr || topic.column("attitude[0]") != nullptr) return;
    const auto axes = [](const std::string& name, const std::string& unit) {
      return std::array<std::string, 3>{name + "[0]" + unit, name + "[1]" + unit, name + "[2]" + unit};
    };
    const bool modern = topic.column("gyroADC[0] (deg/s)") != nullptr;
    add_integrated_attitude(topic, axes(modern ? "gyroADC" : "gyroData", " (deg/s)"), axes("accSmooth", " (m/s/s)"),
                            1 / g_m_s2);
  }

  static constexpr std::int64_t wrap = std::int64_t{1} << 32;
  static constexpr std::int64_t longest_pause = 10'000'000;  ///< us between frames

  std::string_view file_;
  const std::string& name_;
  const LogSelection& selection_;
  Header header_;
  FlightLog log_;
  Table main_, gps_, slow_;
  Numbers now_, before_, before_that_;  ///< main frames: the one that is read, the last, the one before
  Numbers home_, next_home_;
  bool has_history_ = false, has_last_ = false, has_home_ = false, is_valid_ = false;
  bool resumes_ = false, ended_ = false;
  std::int64_t resumed_iteration_ = 0, resumed_time_ = 0;
  std::int64_t skipped_ = 0, last_iteration_ = 0, last_time_ = 0, wrapped_ = 0;
  std::size_t lost_ = 0, left_out_ = 0, first_lost_ = 0;
};

}  // namespace
}  // namespace blackbox

bool is_blackbox_log(std::string_view begin) { return begin.find(blackbox::magic) != std::string_view::npos; }

std::vector<std::size_t> blackbox_flights(std::string_view file) {
  std::vector<std::size_t> begins;
  for (std::size_t at = file.find(blackbox::magic); at != std::string_view::npos;
       at = file.find(blackbox::magic, at + blackbox::magic.size())) {
    begins.push_back(at);
  }
  return begins;
}

FlightLog parse_blackbox(std::string_view file, const std::string& name, const LogSelection& selection) {
  const std::vector<std::size_t> begins = blackbox_flights(file);
  if (selection.flight >= begins.size()) {
    throw InputError(name, 0, 0, "a blackbox log with a flight " + std::to_string(selection.flight + 1),
                     std::to_string(begins.size()) + " flights");
  }
  const std::size_t begin = begins[selection.flight];
  const std::size_t end = selection.flight + 1 < begins.size() ? begins[selection.flight + 1] : file.size();
  return blackbox::Reader(file.substr(0, end), begin, name, selection).read();
}

}  // namespace pinnquad::logs
