// SPDX-License-Identifier: MIT
#include "study/closed_loop.hpp"

#include <exception>

#include "pinnquad/control/trajectory.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/simulation/tracking.hpp"

namespace study {

namespace {

using pinnquad::Status;

/// A motion that is asked for, as a row. `ground_z_m`: NED, what the altitude counts from.
pinnquad::Sample wanted_row(const pinnquad::State<double>& state, const pinnquad::Accelerations<double>& desired,
                            double time_s, double ground_z_m) {
  const pinnquad::EulerAngles<double> angles = pinnquad::to_euler(state.attitude);
  pinnquad::Sample sample;
  sample.time_s = time_s;
  sample.linear_acceleration_m_s2 = desired.linear_m_s2;
  sample.angular_acceleration_rad_s2 = desired.angular_rad_s2;
  sample.velocity_m_s = pinnquad::body_velocity(state);
  sample.body_rates_rad_s = state.body_rates_rad_s;
  sample.roll_rad = angles.roll_rad;
  sample.pitch_rad = angles.pitch_rad;
  sample.yaw_rad = angles.yaw_rad;
  sample.altitude_m = ground_z_m - state.position_m[2];
  return sample;
}

/// The model asked row by row, as it is judged: formulas, which have no block, stand beside trained models here.
class ModelFeedForward {
 public:
  ModelFeedForward(const RowPredictions& model, double ground_z_m) : model_(model), ground_z_m_(ground_z_m) {}

  Status operator()(const pinnquad::State<double>& state, const pinnquad::Accelerations<double>& desired,
                    std::uint64_t time_us, pinnquad::Commands<double>& commands) noexcept {
    try {
      pinnquad::Flight row;
      row.push_back(wanted_row(state, desired, pinnquad::seconds_of(time_us), ground_z_m_));
      const pinnquad::Commands<double> made = model_(pinnquad::RowSet(row, {0, 1})).front();
      const Status status = pinnquad::all_finite(made) ? Status::ok : Status::outside_envelope;
      count_.add(status);
      if (status == Status::ok) commands = made;
      return status;
    } catch (const std::exception&) {
      return Status::not_finite;
    }
  }

  const pinnquad::FallbackCount& count() const noexcept { return count_; }

 private:
  const RowPredictions& model_;
  double ground_z_m_;
  pinnquad::FallbackCount count_{};
};

}  // namespace

LoopFigures closed_loop(const RowPredictions& model, const pinnquad::Airframe<double>& flown) {
  using namespace pinnquad;
  const auto vehicle = flight_vehicle<AgileFlight>(flown);
  const FlightController<double> controller(
      {}, flight_limits(vehicle.airframe(), vehicle.rotor_scale(vehicle.surroundings({}, 0))));
  const Vector3<double> center_m(0, 0, -20);
  LoopFigures figures;
  const ModelFeedForward policy(model, vehicle.site().ground_z_m);
  const auto fly = [&](std::size_t i, const auto& trajectory) {
    const TrackingResult<double> result = track(vehicle, trajectory, controller, policy);
    if (result.status != Status::ok || result.declined == Status::not_finite) return;
    figures.rmse_m[i] = result.rmse_m;
    figures.declined_share[i] = result.fallback.fallbacks() / static_cast<double>(result.fallback.asked);
  };
  FigureEight<double> eight;
  eight.center_m = center_m;
  fly(0, eight);
  eight.period_s = 7;
  eight.yaw_amplitude_rad = 0.5;
  fly(1, eight);
  Circle<double> circle;
  circle.center_m = center_m;
  fly(2, circle);
  return figures;
}

}  // namespace study
