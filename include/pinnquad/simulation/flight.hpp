// SPDX-License-Identifier: MIT
// A flight: pilot, flight controller, analytic inverse and simulated vehicle, recorded at fixed intervals.
#pragma once

#include <cmath>
#include <cstddef>

#include "pinnquad/simulation/random_pilot.hpp"
#include "pinnquad/simulation/simulator.hpp"

namespace pinnquad {

/// How long to fly, and the settings of the simulator. The default is the paper's data set: 15,000 samples at 0.05 s,
/// 750 s.
struct FlightPlan : SimulationSettings {
  std::size_t samples{15000};
};

/// A flight in figures. Ranges are those of the true motion, not of what a recorder made of it, at the recorded rows.
struct FlightReport {
  FlightEnd end{FlightEnd::completed};
  Status status{Status::ok};
  VehicleState<double> last{};  ///< where and when it ended
  std::size_t rows{0};
  double max_speed_m_s{0};
  double min_altitude_m{0};  ///< above ground
  double max_altitude_m{0};
  double max_tilt_rad{0};
  double saturated_share{0};  ///< rows in which a rotor is at 0 or at 1
};

struct RecordedFlight {
  Flight flight;
  FlightReport report;
};

/// The default style, fitted to what the vehicle can do at a place; found through its own inverse, drag included.
/// No climb that takes more than 60 % of the thrust above hover, no descent with less than 35 % of the hover's or
/// faster than 1.5 times the climb; turns, sticks and changes of velocity are calmed in proportion where hover leaves
/// less than 35 % of the command.
template <class... Effects>
PilotStyle pilot_style(const Quadrotor<double, Effects...>& quadrotor, const Vector3<double>& place_m,
                       double max_speed_m_s = PilotStyle{}.max_speed_m_s) {
  constexpr double climb_share = 0.6, descent_share = 0.35, fall_per_climb = 1.5, calm_reserve = 0.35;
  constexpr int speeds = 80;
  PilotStyle style;
  style.max_speed_m_s = style.max_climb_m_s = style.max_descent_m_s = max_speed_m_s;
  HoverTrim<double> hover;
  if (hover_trim(quadrotor, place_m, hover) != Status::ok) return style;
  const double hover_command = hover.commands[0];
  const auto command_at = [&](double down_m_s) {
    State<double> state;
    state.position_m = place_m;
    state.velocity_m_s[2] = down_m_s;
    Commands<double> commands = hover.commands;
    const Status status = inverse_commands(quadrotor, state, Accelerations<double>{}, 0.0, commands);
    return status == Status::ok ? commands[0] : hover_command;
  };
  const double step_m_s = style.max_speed_m_s / speeds;
  const double most = hover_command + climb_share * (1 - hover_command);
  const double least = descent_share * hover_command;
  while (style.max_climb_m_s > step_m_s && command_at(-style.max_climb_m_s) > most) style.max_climb_m_s -= step_m_s;
  while (style.max_descent_m_s > step_m_s && command_at(style.max_descent_m_s) < least) {
    style.max_descent_m_s -= step_m_s;
  }
  const double most_descent_m_s = fall_per_climb * style.max_climb_m_s;  // what falls must be caught again
  if (style.max_descent_m_s > most_descent_m_s) style.max_descent_m_s = most_descent_m_s;
  const double calm = (1 - hover_command) / calm_reserve;
  if (calm < 1) {
    style.max_yaw_rate_rad_s *= calm;
    style.thumbs.yaw_spread_rad_s *= calm;
    style.thumbs.roll_pitch_spread_rad_s *= calm;
    style.velocity_lag_s /= calm;
  }
  return style;
}

/// What an observer is told after each row: how far the flight is, the true state, and the row as recorded.
struct FlightRow {
  std::size_t rows_done;
  std::size_t rows;  ///< of the plan
  const VehicleState<double>& vehicle;
  const Sample& sample;
};

/// Angle between the body's down axis and the world's, 0..pi.
inline double tilt_rad(const Quaternion<double>& attitude) noexcept {
  const double upright = body_down_axis(attitude)[2];
  return std::acos(upright < -1 ? -1 : upright);  // upside down, rounding goes beyond
}

/// Flies and records. `observer(const FlightRow&)` is called after each row. A Status that isn't ok, or the ground,
/// ends the flight (simulation/simulator.hpp); the rows up to there are kept and the report says where.
template <class Vehicle, class Pilot, class Observer, class Recorder = ExactRecorder>
RecordedFlight fly(const Vehicle& quadrotor, const Pilot& pilot, const FlightPlan& plan, Observer observer,
                   const Recorder& recorder = Recorder{}) {
  Simulator<Vehicle, Pilot, Recorder> simulator(quadrotor, pilot, plan, recorder);
  simulator.reserve(plan.samples);
  RecordedFlight recorded;
  FlightReport& report = recorded.report;
  std::size_t saturated_rows = 0;
  while (report.rows < plan.samples && simulator.next_row()) {
    const State<double>& body = simulator.vehicle().body;
    const double speed_m_s = body.velocity_m_s.norm();
    const double tilt = tilt_rad(body.attitude);
    const double altitude_m = simulator.altitude_m();
    if (speed_m_s > report.max_speed_m_s) report.max_speed_m_s = speed_m_s;
    if (tilt > report.max_tilt_rad) report.max_tilt_rad = tilt;
    if (report.rows == 0 || altitude_m < report.min_altitude_m) report.min_altitude_m = altitude_m;
    if (report.rows == 0 || altitude_m > report.max_altitude_m) report.max_altitude_m = altitude_m;
    if (saturated(simulator.commands())) ++saturated_rows;
    ++report.rows;
    observer(FlightRow{report.rows, plan.samples, simulator.vehicle(), simulator.recording().back()});
  }
  report.end = simulator.end();
  report.status = simulator.status();
  report.last = simulator.vehicle();
  if (report.rows > 0) report.saturated_share = static_cast<double>(saturated_rows) / static_cast<double>(report.rows);
  recorded.flight = simulator.take_recording();
  return recorded;
}

template <class Vehicle, class Pilot>
RecordedFlight fly(const Vehicle& quadrotor, const Pilot& pilot, const FlightPlan& plan = {}) {
  return fly(quadrotor, pilot, plan, [](const FlightRow&) {});
}

}  // namespace pinnquad
