// SPDX-License-Identifier: MIT
#include "logs/dataflash.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "logs/motor_order.hpp"
#include "logs/ulog_types.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/logs/flight_log.hpp"

namespace pinnquad::logs {
namespace dataflash {
namespace {

using ulog::Basic;

constexpr std::string_view head{"\xa3\x95", 2};
constexpr std::size_t head_size = 3;  ///< and the message's type
constexpr unsigned char format_type = 0x80;
constexpr std::size_t format_size = 89;
/// The begin of every such log: the format of formats.
constexpr std::string_view magic{
    "\xa3\x95\x80\x80\x59"
    "FMT",
    8};

enum class Kind { number, half, text, none };

/// The meaning of a letter of a format.
struct Letter {
  char letter;
  std::size_t size;
  Kind kind;
  Basic type;
  double divisor;
};

constexpr std::array<Letter, 21> letters{
    {{'a', 64, Kind::none, Basic::int16, 1},     {'b', 1, Kind::number, Basic::int8, 1},
     {'B', 1, Kind::number, Basic::uint8, 1},    {'c', 2, Kind::number, Basic::int16, 100},
     {'C', 2, Kind::number, Basic::uint16, 100}, {'d', 8, Kind::number, Basic::float64, 1},
     {'e', 4, Kind::number, Basic::int32, 100},  {'E', 4, Kind::number, Basic::uint32, 100},
     {'f', 4, Kind::number, Basic::float32, 1},  {'g', 2, Kind::half, Basic::uint16, 1},
     {'h', 2, Kind::number, Basic::int16, 1},    {'H', 2, Kind::number, Basic::uint16, 1},
     {'i', 4, Kind::number, Basic::int32, 1},    {'I', 4, Kind::number, Basic::uint32, 1},
     {'L', 4, Kind::number, Basic::int32, 1e7},  {'M', 1, Kind::number, Basic::int8, 1},
     {'n', 4, Kind::text, Basic::character, 1},  {'N', 16, Kind::text, Basic::character, 1},
     {'q', 8, Kind::number, Basic::int64, 1},    {'Q', 8, Kind::number, Basic::uint64, 1},
     {'Z', 64, Kind::text, Basic::character, 1}}};

const Letter* letter_named(char name) {
  const auto* found =
      std::find_if(letters.begin(), letters.end(), [name](const Letter& one) { return one.letter == name; });
  return found == letters.end() ? nullptr : found;
}

/// Binary16.
double half_number(const char* at) {
  const auto bits = ulog::little_endian<std::uint16_t>(at);
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  const double sign = (bits & 0x8000) != 0 ? -1 : 1;
  if (exponent == 31) return fraction == 0 ? sign * HUGE_VAL : std::nan("");
  return sign * (exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25));
}

double number_of(const Letter& letter, const char* at) {
  return letter.kind == Kind::half ? half_number(at) : ulog::number(letter.type, at) / letter.divisor;
}

struct Column {
  std::string name;
  const Letter* letter;
  std::size_t offset;  ///< behind the head
};

struct Format {
  std::string name;
  std::size_t size = 0;  ///< with the head
  std::vector<Column> columns;
  const Column* clock = nullptr;
  double ticks_per_s = 1;
  const Column* instance = nullptr;
  bool is_wanted = false;

  const Column* column(std::string_view wanted) const {
    for (const Column& one : columns) {
      if (one.name == wanted) return &one;
    }
    return nullptr;
  }
};

class Reader {
 public:
  Reader(std::string_view file, const std::string& name, const LogSelection& selection)
      : file_(file), name_(name), selection_(selection) {
    log_.source = name;
    if (!is_dataflash_log(file)) {
      throw InputError(name, 0, 0, "a DataFlash log, which begins with A3 95 80 80 59 FMT (A3 ... hexadecimal)",
                       file.size() < magic.size() ? "only " + std::to_string(file.size()) + " bytes" : "other bytes");
    }
  }

  FlightLog read() {
    std::uint64_t next_report = 0;
    for (at_ = 0; at_ < file_.size();) {
      selection_.report(at_, file_.size(), next_report);
      if (!step()) lose();
    }
    if (places_lost_ > 0) {
      log_.warnings.push_back(printable(name_) + ": byte " + std::to_string(first_lost_) + ": " +
                              std::to_string(bytes_lost_) + " bytes in " + std::to_string(places_lost_) +
                              (places_lost_ == 1 ? " place" : " places, this the first,") +
                              " are no message: left out");
    }
    say_motor_range();
    name_motors();
    return std::move(log_);
  }

 private:
  /// The message at the place; false where there is none.
  bool step() {
    if (file_.size() - at_ < head_size || file_.substr(at_, 2) != head) return false;
    const auto type = static_cast<unsigned char>(file_[at_ + 2]);
    if (type == format_type) {
      if (file_.size() - at_ < format_size) return false;
      if (!add_format(file_.substr(at_ + head_size, format_size - head_size))) return false;
      at_ += format_size;
      is_lost_ = false;
      return true;
    }
    Format& format = formats_[type];
    if (format.size == 0 || format.size > file_.size() - at_) return false;
    // bytes that look like a head in the middle of what was lost
    const std::size_t next = at_ + format.size;
    if (is_lost_ && next + 2 <= file_.size() && file_.substr(next, 2) != head) return false;
    take(type, format, file_.data() + at_ + head_size);
    at_ = next;
    is_lost_ = false;
    return true;
  }

  void lose() {
    const std::size_t next = std::min(file_.find(head, at_ + 1), file_.size());
    if (!is_lost_ && places_lost_++ == 0) first_lost_ = at_;
    is_lost_ = true;
    bytes_lost_ += next - at_;
    at_ = next;
  }

  /// A format that is not understood still says how long its messages are.
  bool add_format(std::string_view content) {
    const auto type = static_cast<unsigned char>(content[0]);
    const std::size_t size = static_cast<unsigned char>(content[1]);
    const std::string name(ulog::text_of(content.substr(2, 4)));
    const std::string_view text = ulog::text_of(content.substr(6, 16)), names = ulog::text_of(content.substr(22, 64));
    if (type == format_type) return true;
    const Format& known = formats_[type];
    if (known.size != 0) return known.name == name && known.size == size;
    if (size < head_size) return false;
    Format format;
    format.name = name;
    format.size = size;
    std::size_t offset = 0, begin = 0;
    for (const char one : text) {
      const Letter* const letter = letter_named(one);
      if (letter == nullptr) break;
      const std::size_t end = std::min(names.find(',', begin), names.size());
      if (begin < end) format.columns.push_back({std::string(names.substr(begin, end - begin)), letter, offset});
      begin = end + 1;
      offset += letter->size;
    }
    if (offset + head_size != size) {
      constexpr std::size_t most_warnings = 20;
      if (log_.warnings.size() < most_warnings) {
        log_.warnings.push_back(printable(name_) + ": byte " + std::to_string(at_) + ": the format " +
                                quoted_cell(text) + " of " + quoted_cell(name) + " is not " + std::to_string(size) +
                                " bytes of known letters: its messages are left out");
      }
      format.columns.clear();
    }
    Format& kept = formats_[type] = std::move(format);
    for (const auto& [clock, ticks] : {std::pair{"TimeUS", 1e6}, std::pair{"TimeMS", 1e3}}) {
      if (kept.clock != nullptr) break;
      kept.clock = kept.column(clock);
      kept.ticks_per_s = ticks;
      if (kept.clock != nullptr && kept.clock->letter->kind != Kind::number) kept.clock = nullptr;
    }
    kept.is_wanted = selection_.wants(name);
    return true;
  }

  std::string text_in(const Format& format, const char* column, const char* content) const {
    const Column* const found = format.column(column);
    if (found == nullptr || found->letter->kind != Kind::text) return "";
    return std::string(ulog::text_of({content + found->offset, found->letter->size}));
  }

  double number_in(const Format& format, const char* column, const char* content) const {
    const Column* const found = format.column(column);
    const bool is_number = found != nullptr && found->letter->kind != Kind::text && found->letter->kind != Kind::none;
    return is_number ? number_of(*found->letter, content + found->offset) : std::nan("");
  }

  void take(unsigned char type, Format& format, const char* content) {
    const double time_s = format.clock == nullptr
                              ? std::nan("")
                              : number_of(*format.clock->letter, content + format.clock->offset) / format.ticks_per_s;
    if (format.name == "PARM") {
      const std::string key = text_in(format, "Name", content);
      log_.parameters.emplace(key, number_in(format, "Value", content));  // the first: as it stood when the log began
    } else if (format.name == "FMTU") {
      mark_instance(number_in(format, "FmtType", content), text_in(format, "UnitIds", content));
    }
    if (format.is_wanted && format.clock != nullptr) row(type, format, content, time_s);
  }

  void mark_instance(double type, const std::string& units) {
    if (!(type >= 0 && type < 256)) return;
    Format& format = formats_[static_cast<std::size_t>(type)];
    const std::size_t at = units.find('#');
    if (at >= format.columns.size() || format.columns[at].letter->kind != Kind::number) return;
    format.instance = &format.columns[at];
  }

  void row(unsigned char type, const Format& format, const char* content, double time_s) {
    const double number =
        format.instance == nullptr ? 0 : number_of(*format.instance->letter, content + format.instance->offset);
    const int instance = number >= 0 && number < 256 ? static_cast<int>(number) : 0;
    const auto [entry, is_new] = topics_.emplace(std::pair<int, int>{type, instance}, log_.topics.size());
    if (is_new) open(format, instance);
    LogTopic& topic = log_.topics[entry->second];
    topic.time_s.push_back(time_s);
    topic.place.push_back(at_);
    std::size_t numbers = 0, texts = 0;
    for (const Column& column : format.columns) {
      const char* const at = content + column.offset;
      if (column.letter->kind == Kind::text) {
        topic.texts[texts++].values.emplace_back(ulog::text_of({at, column.letter->size}));
      } else if (column.letter->kind != Kind::none) {
        topic.columns[numbers++].values.push_back(number_of(*column.letter, at));
      }
    }
  }

  void open(const Format& format, int instance) {
    LogTopic topic = LogTopic::of_bytes(format.name, instance, name_);
    for (const Column& column : format.columns) {
      if (column.letter->kind == Kind::text) topic.texts.push_back({column.name, {}});
      if (column.letter->kind == Kind::number || column.letter->kind == Kind::half)
        topic.columns.push_back({column.name, {}});
    }
    log_.topics.push_back(std::move(topic));
  }

  /// The outputs that SERVOn_FUNCTION gives to motors, as columns of RCOU: other outputs are servos. Without such
  /// parameters, before 3.5, the first outputs are the motors; before 3.4 C1 is Ch1.
  void name_motors() {
    constexpr int first_motor = 33, motors = 8, outputs = 16;  // motors 9 to 12 have other numbers
    for (LogTopic& topic : log_.topics) {
      if (topic.name != "RCOU" || topic.instance != 0) continue;
      const auto output_column = [&topic](const std::string& number) {
        const LogColumn* const column = topic.column("C" + number);
        return column != nullptr ? column : topic.column("Ch" + number);
      };
      bool said = false;
      std::map<int, const LogColumn*> found;  // by motor
      for (int output = 1; output <= outputs; ++output) {
        const std::string number = std::to_string(output);
        const LogColumn* const column = output_column(number);
        const double motor = log_.parameter("SERVO" + number + "_FUNCTION", 0) - first_motor + 1;
        const bool is_motor = motor >= 1 && motor <= motors;
        said = said || is_motor;
        if (column != nullptr && is_motor) found.emplace(static_cast<int>(motor), column);
      }
      for (int motor = 1; motor <= static_cast<int>(rotor_count) && !said; ++motor) {
        if (const LogColumn* const column = output_column(std::to_string(motor))) found.emplace(motor, column);
      }
      std::vector<LogColumn> named;
      for (const auto& [motor, column] : found) named.push_back({"Motor" + std::to_string(motor), column->values});
      topic.columns.insert(topic.columns.end(), named.begin(), named.end());
    }
  }

  void say_motor_range() {
    double least = log_.parameter("MOT_PWM_MIN", 0), most = log_.parameter("MOT_PWM_MAX", 0);
    if (!(least > 0 && most > least)) {  // as the firmware has it where they are 0, or older than these: the stick's
      const std::string stick = "RC" + std::to_string(std::lround(log_.parameter("RCMAP_THROTTLE", 3)));
      least = log_.parameter(stick + "_MIN", 1000);
      most = log_.parameter(stick + "_MAX", 2000);
    }
    const double begin =
        log_.parameter("MOT_SPIN_MIN", log_.parameter("THR_MIN", 0) / 1000);  // before 3.4: THR_MIN, MOT_THST_MAX
    const double end = log_.parameter("MOT_SPIN_MAX", log_.parameter("MOT_THST_MAX", 1));
    if (!(end > begin && most > least)) return;
    log_.parameters["motorOutput[0]"] = least + begin * (most - least);
    log_.parameters["motorOutput[1]"] = least + end * (most - least);
  }

  std::string_view file_;
  const std::string& name_;
  const LogSelection& selection_;
  FlightLog log_;
  std::array<Format, 256> formats_;
  std::map<std::pair<int, int>, std::size_t> topics_;  ///< by type and instance
  std::size_t at_ = 0;
  bool is_lost_ = false;
  std::size_t places_lost_ = 0, bytes_lost_ = 0, first_lost_ = 0;
};

}  // namespace
}  // namespace dataflash

bool is_dataflash_log(std::string_view begin) { return begin.substr(0, dataflash::magic.size()) == dataflash::magic; }

FlightLog parse_dataflash(std::string_view file, const std::string& name, const LogSelection& selection) {
  return dataflash::Reader(file, name, selection).read();
}

}  // namespace pinnquad::logs
