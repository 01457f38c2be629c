// SPDX-License-Identifier: MIT
#include "flight/block_loop.hpp"

#include <functional>
#include <optional>
#include <stdexcept>

#include "flight/block_feed_forward.hpp"
#include "flight/loop_trajectories.hpp"
#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/ground_effect.hpp"

namespace programs {

namespace {

using namespace pinnquad;

using Distant = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;
using InGroundEffect = Quadrotor<double, StandardAtmosphere, QuadraticDrag, ConyersGroundEffect>;

/// Any trajectory behind one type: one loop per vehicle and guard is compiled.
struct AnyTrajectory {
  std::function<TrajectoryPoint<double>(double)> point;
  TrajectoryPoint<double> sample(double time_s) const noexcept { return point(time_s); }
};

std::optional<NearGround> near_ground(const BlockModel& model) {
  if (!model.features().asks_for_altitude()) return {};
  const std::vector<std::string> names = model.feature_names();
  const std::vector<double> lower = model.envelope_lower(), upper = model.envelope_upper();
  NearGround range;
  for (std::size_t i = 0; i < names.size(); ++i) range.take(names[i], lower[i], upper[i]);
  return range;
}

AnyTrajectory trajectory_of(const LoopPlan& plan, double ground_z_m, const std::optional<NearGround>& range,
                            LoopFlights& flights) {
  const auto take = [&](const auto& trajectory, double half_length_m, double half_height_m) {
    const double middle_m = ground_z_m - trajectory.center_m[2];
    flights.half_length_m = half_length_m;
    flights.period_s = trajectory.period_s;
    flights.lowest_m = middle_m - half_height_m;
    flights.highest_m = middle_m + half_height_m;
    return AnyTrajectory{[trajectory](double time_s) { return trajectory.sample(time_s); }};
  };
  if (plan.trajectory == "circle") {
    const Circle<double> circle = circle_for(plan.airframe, ground_z_m, range);
    return take(circle, circle.radius_m, 0);
  }
  FigureEight<double> eight = eight_for(plan.airframe, ground_z_m, range);
  if (plan.trajectory == "yaw_eight") {
    eight.yaw_amplitude_rad = 0.5;
    eight.period_s *= 14.0 / 15.0;
  }
  return take(eight, eight.half_length_m, eight.half_height_m);
}

template <class Vehicle>
LoopFlights fly_with(const BlockModel& model, const LoopPlan& plan) {
  const Vehicle vehicle(plan.airframe, paper_site<double>());
  const double ground_z_m = vehicle.site().ground_z_m;
  LoopFlights flights;
  flights.near_ground = model.features().asks_for_altitude();
  const AnyTrajectory trajectory = trajectory_of(plan, ground_z_m, near_ground(model), flights);
  HoverTrim<double> trim;
  Status status = vehicle.status();
  if (status == Status::ok) status = hover_trim(vehicle, trajectory.sample(0).position_m, trim);
  if (status != Status::ok) {
    throw std::invalid_argument(std::string("this airframe can't be flown ") +
                                (flights.near_ground ? "near the ground" : "here") + ": " + to_string(status));
  }
  const FlightController<double> controller(
      {}, flight_limits(vehicle.airframe(), vehicle.rotor_scale(vehicle.surroundings({}, 0))));
  const AnalyticInverse<Vehicle> analytic(vehicle);
  const auto fly = [&](const auto& feed_forward) { return track(vehicle, trajectory, controller, feed_forward); };
  using FallsBack = Fallback<AnalyticInverse<Vehicle>>;
  const auto fly_model = [&](const auto& guard) {
    return with_feed_forward(model, guard, ground_z_m, plan.columns, fly);
  };
  flights.model = plan.keeps_envelope ? fly_model(Extend<TrainingGuard, FallsBack>(analytic))
                                      : fly_model(Guard<FiniteInputs, FiniteOutputs, FallsBack>(analytic));
  flights.analytic_inverse = fly(analytic);
  flights.hover_trim = fly(trim);
  return flights;
}

}  // namespace

LoopFlights fly_loop(const BlockModel& model, const LoopPlan& plan) {
  return model.features().asks_for_altitude() ? fly_with<InGroundEffect>(model, plan) : fly_with<Distant>(model, plan);
}

}  // namespace programs
