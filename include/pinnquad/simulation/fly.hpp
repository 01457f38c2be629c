// SPDX-License-Identifier: MIT
// A flight: pilot, flight controller, analytic inverse and simulated vehicle, recorded at fixed intervals.
#pragma once

#include <cmath>
#include <cstddef>

#include "pinnquad/simulation/fitted_style.hpp"
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
