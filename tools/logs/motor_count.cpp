// SPDX-License-Identifier: MIT
#include "logs/motor_count.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "logs/log_columns.hpp"
#include "pinnquad/io/file_error.hpp"

namespace pinnquad::logs {
namespace {

/// A name with one number in it: "control[3]", "m4".
struct Numbered {
  std::string before, behind;
  std::size_t number = 0;

  std::string at(std::size_t other) const { return before + std::to_string(other) + behind; }
};

std::optional<Numbered> numbered(const std::string& name) {
  const std::size_t last = name.find_last_of("0123456789");
  if (last == std::string::npos) return std::nullopt;
  std::size_t first = last;
  while (first > 0 && name[first - 1] >= '0' && name[first - 1] <= '9') --first;
  if (last - first > 2) return std::nullopt;
  Numbered result{name.substr(0, first), name.substr(last + 1), 0};
  for (std::size_t i = first; i <= last; ++i)
    result.number = 10 * result.number + static_cast<std::size_t>(name[i] - '0');
  return result;
}

std::string kind_of(std::size_t motors) {
  constexpr std::array<const char*, 9> kinds = {"",
                                                "a plane",
                                                "a plane with two motors or a tailsitter",
                                                "a tricopter",
                                                "a quadrotor whose motors stand elsewhere in the array",
                                                "a VTOL of four motors and a pusher",
                                                "a hexacopter",
                                                "a vehicle of seven motors",
                                                "an octocopter"};
  return motors < kinds.size() ? kinds[motors] : "a vehicle of " + std::to_string(motors) + " motors";
}

/// ArduPilot's FRAME_CLASS that is no quadrotor's, and a '+' by its FRAME_TYPE; empty for all others.
std::string other_frame(const FlightLog& log) {
  constexpr std::array<const char*, 16> classes = {"",
                                                   "a quadrotor",
                                                   "a hexacopter",
                                                   "an octocopter",
                                                   "eight motors in pairs",
                                                   "six motors in a Y",
                                                   "",
                                                   "a tricopter",
                                                   "one rotor and flaps",
                                                   "two rotors side by side",
                                                   "a tailsitter",
                                                   "a dodecahexacopter",
                                                   "",
                                                   "",
                                                   "a decacopter",
                                                   ""};
  const double kind = log.parameter("FRAME_CLASS", std::nan(""));
  const std::string key = std::isnan(kind) ? "FRAME" : "FRAME_TYPE";  // before 3.5 the first
  if (kind > 1) {
    const auto index = static_cast<std::size_t>(std::min(kind, 15.0));
    return "FRAME_CLASS " + std::to_string(index) +
           (classes[index][0] == '\0' ? "" : std::string(": ") + classes[index]);
  }
  return std::abs(log.parameter(key, 1)) < 0.5 ? key + " 0: a '+' frame" : "";
}

/// PX4's parameters of the places, where all four are logged: rotors ahead, behind and beside the centre.
bool is_plus_frame(const FlightLog& log) {
  constexpr double on_axis = 0.2;
  for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
    const std::string name = "CA_ROTOR" + std::to_string(rotor) + "_P";
    const double along = std::abs(log.parameter(name + "X", std::nan("")));
    const double beside = std::abs(log.parameter(name + "Y", std::nan("")));
    if (!(std::min(along, beside) < on_axis * std::max(along, beside))) return false;
  }
  return true;
}

}  // namespace

std::vector<std::string> further_motor_names(const Source& source) {
  constexpr std::size_t most_motors = 12;
  const std::optional<Numbered> first = numbered(source.columns[0].name);
  if (!first) return {};
  std::vector<std::size_t> numbers;
  for (const NamedColumn& one : source.columns) {
    const std::optional<Numbered> other = numbered(one.name);
    if (!other || other->before != first->before || other->behind != first->behind) return {};
    numbers.push_back(other->number);
  }
  std::sort(numbers.begin(), numbers.end());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] != numbers[0] + i || numbers[0] > 1) return {};
  }
  std::vector<std::string> names;
  for (std::size_t i = numbers.size(); i < most_motors; ++i) names.push_back(first->at(numbers[0] + i));
  return names;
}

void require_four_motors(const FlightLog& log, const LogTopic& topic, const Source& source, double least, double most,
                         const std::string& mapping_file) {
  constexpr double moves = 0.01;   // of the range: what is disarmed has up to .0025
  constexpr double seldom = 0.01;  // of the rows of the busiest: a wild row is no motor
  const auto highest = [](const LogColumn& column) {
    double value = -HUGE_VAL;
    for (const double one : column.values) {
      if (std::isfinite(one)) value = std::max(value, one);
    }
    return value;
  };
  const auto refuse = [&](const NamedColumn& at, const std::string& found) {
    throw InputError(mapping_file, at.place.line, at.place.column, "a quadrotor in X with four motors",
                     found + " (" + topic.file + ")");
  };
  const std::string frame = other_frame(log);
  if (!frame.empty()) refuse(source.columns.front(), frame);
  std::vector<const LogColumn*> columns, commanded;
  for (const NamedColumn& one : source.columns) columns.push_back(column_named(topic, one.name));
  for (const std::string& name : further_motor_names(source)) {
    const LogColumn* further = column_named(topic, name);
    if (further == nullptr) break;
    columns.push_back(further);
  }
  double range = most - least;
  if (source.numbers == MotorNumbers::speed) {
    range = 0;
    for (const LogColumn* column : columns) range = std::max(range, highest(*column));
  }
  const double idle = (source.numbers == MotorNumbers::speed ? 0 : least) + moves * range;
  std::vector<double> busy;  // rows in which a column commands something
  for (const LogColumn* column : columns) {
    const auto rows = std::count_if(column->values.begin(), column->values.end(),
                                    [idle](double one) { return std::isfinite(one) && one > idle; });
    busy.push_back(static_cast<double>(rows));
  }
  const double busiest = *std::max_element(busy.begin(), busy.end());
  const NamedColumn* unused = nullptr;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (busy[i] > seldom * busiest) {
      commanded.push_back(columns[i]);
    } else if (i < source.columns.size() && unused == nullptr) {
      unused = &source.columns[i];
    }
  }
  const bool nothing = commanded.empty();  // a log on the ground, if it has numbers at all
  for (const NamedColumn& one : source.columns) {
    if (nothing && std::isinf(highest(*column_named(topic, one.name)))) refuse(one, "no number in column " + one.name);
  }
  std::string names;
  for (const LogColumn* column : commanded) names += (names.empty() ? "" : ", ") + column->name;
  const std::string found = "commands in " + std::to_string(commanded.size()) + " columns (" + names + "): ";
  if (!nothing && unused != nullptr)
    refuse(*unused, "none in " + unused->name + ", " + found + kind_of(commanded.size()));
  if (commanded.size() > rotor_count) refuse(source.columns.back(), found + kind_of(commanded.size()));
  if (is_plus_frame(log)) {
    refuse(source.columns.front(), "rotors ahead, behind and to both sides by CA_ROTOR0_PX and so on: a '+' frame");
  }
}

}  // namespace pinnquad::logs
