// SPDX-License-Identifier: MIT
// A quantity as a log has it, in SI units, NED and FRD, on its topic's own clock.
// A log's motors as commands of a Sample: front right, rear left, front left, rear right, 0..1, whose
// meaning is that of the airframe's thrust curves.
// A log whose columns have their meaning: each quantity from the first source that the log has.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "logs/airframe_file.hpp"
#include "logs/attitude_convention.hpp"
#include "logs/clock.hpp"
#include "logs/mapping.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/logs/read_log.hpp"

namespace pinnquad::logs {

struct Signal {
  const Source* source = nullptr;  ///< null: the log has none
  const LogTopic* topic = nullptr;
  std::shared_ptr<const CleanClock> clock;  ///< signals of one topic and clock column share it
  std::vector<std::vector<double>> values;  ///< by component, by the topic's row; NaN where it has none
  std::string told;                         ///< where it is from: "actuator_motors"
  std::string note;                         ///< how its numbers were taken; empty: as the mapping says
  std::optional<double> thrust_curve{};     ///< of motors that are no speeds: as the mapping or the log says
  bool sparse = false;                      ///< the table has rows without it between its own: its clock has these

  bool present() const noexcept { return source != nullptr; }
  double period_s() const noexcept { return clock->report.nominal_period_s; }
};

/// "vehicle_attitude", or "the table" of a log that is one.
std::string topic_words(const std::string& topic, int instance);

/// The place of a topic's cell as a message has it.
InputError wrong_cell(const LogTopic& topic, std::size_t row, const std::string& column, const std::string& expected,
                      const std::string& found);

/// How the attitude of a source is written.
AttitudeConvention convention_of(const Source& source);

struct BoundExtra {
  const ExtraSource* extra = nullptr;
  Signal signal;
};

struct BoundLog {
  std::array<Signal, quantities.size()> signals;  ///< by Quantity; `motors` also where they were rebuilt
  std::vector<BoundExtra> extras;                 ///< those that the log has

  Signal& of(Quantity quantity) { return signals[static_cast<std::size_t>(quantity)]; }
  const Signal& of(Quantity quantity) const { return signals[static_cast<std::size_t>(quantity)]; }
};

/// The topics and columns that a mapping looks at, and the labels of a table: topics are none where it is of a table.
LogSelection mapped_selection(const Mapping& mapping);

/// By the source's own column (the topic's clock where that is more than a second off it), or the topic's clock, or the
/// one that [time] names for a table.
std::vector<double> times_of(const LogTopic& topic, const Source& source, const Mapping& mapping);

/// Throws InputError, one line: a source that is not optional and not there, cells that are no numbers, quaternions
/// that are no unit, another number of motors, torques that are no shares. Columns of the log that one source alone
/// reads are empty afterwards.
BoundLog bind_log(FlightLog& log, const Mapping& mapping, const std::optional<NamedAirframe>& airframe);

}  // namespace pinnquad::logs
