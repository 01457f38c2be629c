// SPDX-License-Identifier: MIT
// A quantity as a log has it, in SI units, NED and FRD, on its topic's own clock.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "logs/attitude_convention.hpp"
#include "logs/common_clock.hpp"
#include "logs/flight_log.hpp"
#include "logs/mapping.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/io/csv_table.hpp"

namespace programs {

struct Signal {
  const Source* source = nullptr;  ///< null: the log has none
  const LogTopic* topic = nullptr;
  std::shared_ptr<const CleanClock> clock;  ///< signals of one topic and clock column share it
  std::vector<std::vector<double>> values;  ///< by component, by the topic's row; NaN where it has none
  std::string told;                         ///< where it is from: "actuator_motors"

  bool present() const noexcept { return source != nullptr; }
  double period_s() const noexcept { return clock->report.nominal_period_s; }
};

/// "vehicle_attitude", or "the table" of a log that is one.
inline std::string topic_words(const std::string& topic, int instance) {
  return (topic.empty() ? "the table" : topic) + (instance > 0 ? " " + std::to_string(instance) : "");
}

/// The place of a topic's cell as a message has it.
inline pinnquad::InputError wrong_cell(const LogTopic& topic, std::size_t row, const std::string& column,
                                       const std::string& expected, const std::string& found) {
  std::size_t line = 0, field = 0;
  std::string file = topic.file;
  if (topic.places_are_lines && row < topic.place.size()) {
    line = static_cast<std::size_t>(topic.place[row]);
    const std::vector<std::string> header = pinnquad::detail::csv_header(file);
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (header[i] == column) field = i + 1;
    }
  } else if (row < topic.place.size()) {
    file += ", byte " + std::to_string(topic.place[row]);
  }
  return pinnquad::InputError(file, line, field, expected, found);
}

/// How the attitude of a source is written.
inline AttitudeConvention convention_of(const Source& source) {
  return {!source.euler && source.scalar_last, source.world_to_body, source.world == WorldFrame::enu,
          source.body == BodyFrame::flu};
}

namespace detail {

/// Row by row from the mapping's frames to NED and FRD.
inline void turn_attitude(const Source& source, std::vector<std::vector<double>>& values) {
  const AttitudeConvention convention = convention_of(source);
  const std::size_t rows = values[0].size();
  std::vector<std::vector<double>> turned(4, std::vector<double>(rows, std::nan("")));
  for (std::size_t row = 0; row < rows; ++row) {
    std::array<double, 4> numbers{};
    if (source.euler) {
      const auto q =
          pinnquad::from_euler(pinnquad::EulerAngles<double>{values[0][row], values[1][row], values[2][row]});
      numbers = {q.w, q.x, q.y, q.z};
    } else {
      for (std::size_t i = 0; i < 4; ++i) numbers[i] = values[i][row];
    }
    const pinnquad::Quaternion<double> q = read_attitude(numbers, convention);
    turned[0][row] = q.w;
    turned[1][row] = q.x;
    turned[2][row] = q.y;
    turned[3][row] = q.z;
  }
  values = std::move(turned);
}

inline void turn_vector(bool flu, bool enu, std::vector<std::vector<double>>& values) {
  if (enu) std::swap(values[0], values[1]);
  if (flu) {
    for (double& v : values[1]) v = -v;
  }
  if (flu || enu) {
    for (double& v : values[2]) v = -v;
  }
}

}  // namespace detail

/// The columns of a quantity in NED and FRD.
inline void to_our_frames(const Source& source, std::vector<std::vector<double>>& values) {
  const bool flu = source.body == BodyFrame::flu, enu = source.world == WorldFrame::enu;
  switch (source.quantity) {
    case Quantity::attitude: detail::turn_attitude(source, values); break;
    case Quantity::body_rates:
    case Quantity::angular_acceleration:
    case Quantity::specific_force: detail::turn_vector(flu, false, values); break;
    case Quantity::acceleration:
    case Quantity::velocity:
      detail::turn_vector(source.axes == Axes::body && flu, source.axes == Axes::world && enu, values);
      break;
    case Quantity::position: detail::turn_vector(false, enu, values); break;
    case Quantity::torque_and_thrust:
      if (flu) {
        for (double& v : values[1]) v = -v;
        for (double& v : values[2]) v = -v;
      }
      break;
    case Quantity::altitude:
    case Quantity::motors:
    case Quantity::landed:
    case Quantity::extra: break;
  }
}

}  // namespace programs
