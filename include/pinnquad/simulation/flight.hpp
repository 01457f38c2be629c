// SPDX-License-Identifier: MIT
// A flight: pilot, flight controller, analytic inverse and simulated vehicle, recorded at fixed intervals.
#pragma once

#include <cmath>
#include <cstddef>

#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/control/flight_controller.hpp"
#include "pinnquad/control/torque_priority.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/simulation/pilot.hpp"
#include "pinnquad/simulation/random_pilot.hpp"
#include "pinnquad/simulation/recorder.hpp"

namespace pinnquad {

/// How long to fly, and the three clocks. The default is the paper's data set: 15,000 samples at 0.05 s, 750 s.
struct FlightPlan {
  std::size_t samples{15000};
  double physics_step_s{0.001};
  int steps_per_control{2};            ///< controller at 500 Hz; the commands are held over these steps
  int controls_per_sample{25};         ///< a row every 0.05 s
  Vector3<double> start_m{0, 0, -35};  ///< NED; the flight starts there in hover
  FlightGains<double> gains{};

  double control_period_s() const noexcept { return physics_step_s * steps_per_control; }
  double sample_period_s() const noexcept { return control_period_s() * controls_per_sample; }
};

enum class FlightEnd {
  completed,
  bad_status,  ///< controller, inverse or physics declined: FlightReport::status says why
  ground,      ///< the vehicle's centre came down to the ground
};

/// A flight in figures. Ranges are over the recorded rows.
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
    style.yaw_stick_rad_s *= calm;
    style.roll_pitch_stick_rad_s *= calm;
    style.velocity_lag_s /= calm;
  }
  return style;
}

/// Flies and records. `progress(rows_done, rows)` is called after each row. A Status that isn't ok, or the ground, ends
/// the flight; the rows up to there are kept and the report says where.
template <class... Effects, class Pilot, class Progress>
RecordedFlight fly(const Quadrotor<double, Effects...>& quadrotor, Pilot pilot, const FlightPlan& plan,
                   Progress progress) {
  static_assert(is_pilot<Pilot>, "pinnquad: this type is no pilot (simulation/pilot.hpp)");
  RecordedFlight recorded;
  FlightReport& report = recorded.report;
  recorded.flight.reserve(plan.samples);
  VehicleState<double>& vehicle = report.last;
  vehicle.body.position_m = plan.start_m;

  HoverTrim<double> hover;
  report.status = quadrotor.status();
  if (report.status == Status::ok) report.status = hover_trim(quadrotor, plan.start_m, hover);
  if (report.status != Status::ok) {
    report.end = FlightEnd::bad_status;
    return recorded;
  }
  vehicle.rotors = hover.commands;
  Commands<double> commands = hover.commands;
  const double density_ratio = quadrotor.density_ratio(quadrotor.surroundings(vehicle.body, 0.0));
  const FlightController<double> controller(plan.gains, flight_limits(quadrotor.airframe(), density_ratio, plan.gains),
                                            quadrotor.site().gravity_m_s2);

  const auto control_tick = [&]() -> Status {
    Accelerations<double> demand;
    Status status = controller(vehicle.body, pilot(vehicle.body, vehicle.time_s), demand);
    if (status == Status::ok) status = inverse_commands(quadrotor, vehicle.body, demand, vehicle.time_s, commands);
    if (status == Status::ok) commands = keep_torque(commands);
    for (int i = 0; i < plan.steps_per_control && status == Status::ok; ++i) {
      status = quadrotor.step(vehicle, commands, plan.physics_step_s);
    }
    return status;
  };

  std::size_t saturated_rows = 0;
  for (std::size_t row = 0; row < plan.samples; ++row) {
    for (int tick = 0; tick < plan.controls_per_sample && report.status == Status::ok; ++tick) {
      report.status = control_tick();
    }
    if (report.status != Status::ok) {
      report.end = FlightEnd::bad_status;
      break;
    }
    vehicle.time_s = static_cast<double>(row + 1) * plan.sample_period_s();  // sums of steps drift, products do not
    const Sample sample = record(quadrotor, vehicle, commands);
    if (sample.altitude_m <= 0) {
      report.end = FlightEnd::ground;
      break;
    }
    const double speed_m_s = sample.velocity_m_s.norm();
    const double tilt_rad = std::acos(body_down_axis(vehicle.body.attitude)[2]);
    if (speed_m_s > report.max_speed_m_s) report.max_speed_m_s = speed_m_s;
    if (tilt_rad > report.max_tilt_rad) report.max_tilt_rad = tilt_rad;
    if (row == 0 || sample.altitude_m < report.min_altitude_m) report.min_altitude_m = sample.altitude_m;
    if (row == 0 || sample.altitude_m > report.max_altitude_m) report.max_altitude_m = sample.altitude_m;
    if (saturated(sample.commands)) ++saturated_rows;
    recorded.flight.push_back(sample);
    progress(row + 1, plan.samples);
  }
  report.rows = recorded.flight.size();
  if (report.rows > 0) report.saturated_share = static_cast<double>(saturated_rows) / static_cast<double>(report.rows);
  return recorded;
}

template <class... Effects, class Pilot>
RecordedFlight fly(const Quadrotor<double, Effects...>& quadrotor, const Pilot& pilot, const FlightPlan& plan = {}) {
  return fly(quadrotor, pilot, plan, [](std::size_t, std::size_t) {});
}

}  // namespace pinnquad
