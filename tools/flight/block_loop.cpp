// SPDX-License-Identifier: MIT
#include "flight/block_loop.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "flight/battery_choice.hpp"
#include "flight/block_feed_forward.hpp"
#include "flight/loop_trajectories.hpp"
#include "flight/waypoints.hpp"
#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/simulation/flights.hpp"

namespace programs {

namespace {

using namespace pinnquad;

AnyTrajectory trajectory_of(const LoopPlan& plan, double ground_z_m, const ModelRange& range, LoopFlights& flights) {
  constexpr const char* none = "the model's envelope holds no trajectory of this kind, however slow: --guard none";
  const auto take = [&](const auto& trajectory, double half_length_m, double half_height_m) {
    const double middle_m = ground_z_m - trajectory.center_m[2];
    flights.half_length_m = half_length_m;
    flights.period_s = trajectory.period_s;
    flights.lowest_m = middle_m - half_height_m;
    flights.highest_m = middle_m + half_height_m;
    return AnyTrajectory{[trajectory](double time_s) { return trajectory.sample(time_s); }};
  };
  if (is_waypoint_file(plan.trajectory)) {
    const WaypointPath path =
        waypoints_for(plan.trajectory, detail::center_for(ground_z_m, range), ground_z_m, plan.airframe);
    Vector3<double> least_m = path.sample(0).position_m, most_m = least_m;
    for (double time_s = 0; time_s <= path.duration_s(); time_s += 0.02) {
      least_m = least_m.cwiseMin(path.sample(time_s).position_m);
      most_m = most_m.cwiseMax(path.sample(time_s).position_m);
    }
    constexpr double least_half_m = 1;  // of one that stays at a place: so far off, a vehicle is lost
    flights.half_length_m = std::max(least_half_m, (most_m - least_m).maxCoeff() / 2);
    flights.period_s = flights.duration_s = path.duration_s();
    flights.lowest_m = ground_z_m - most_m[2];
    flights.highest_m = ground_z_m - least_m[2];
    return AnyTrajectory{[path](double time_s) { return path.sample(time_s); }};
  }
  if (plan.trajectory == "circle") {
    const auto circle = circle_for(plan.airframe, ground_z_m, range);
    if (!circle) throw std::invalid_argument(none);
    return take(*circle, circle->radius_m, 0);
  }
  const auto held = eight_for(plan.airframe, ground_z_m, range);
  if (!held) throw std::invalid_argument(none);
  const FigureEight<double> eight = plan.trajectory == "yaw_eight" ? with_yaw(*held) : *held;
  return take(eight, eight.half_length_m, eight.half_height_m);
}

}  // namespace

ModelRange range_of(const BlockModel& model) {
  const RunTimeFeatures& features = model.features();
  const std::vector<double> lower = model.envelope_lower(), upper = model.envelope_upper();
  ModelRange range;
  for (int i = 0; i < features.size(); ++i) {
    const auto at = std::size_t(i);
    range.features.push_back(
        {std::string(features[i].name), std::string(features[i].unit), lower[at], upper[at], features.is_column(i)});
  }
  range.of = [&features](const ModelRange::Motion& motion) {
    RunTimeFeatures::Inputs<double> lasting;
    static_cast<ModelRange::Motion&>(lasting) = motion;
    const std::vector<RunTimeFeatures::Inputs<double>> taps(std::size_t(features.window().taps), lasting);
    std::vector<double> x(std::size_t(features.size()));
    features.extract(taps.data(), x.data());
    return x;
  };
  return range;
}

LoopFlights fly_loop(const BlockModel& model, const LoopPlan& plan) {
  const bool near_ground = model.features().asks_for_altitude();
  const GroundEffectModel ground_effect =
      near_ground ? NearGroundFlight::ground_effect_of(plan.airframe) : GroundEffectModel::none;
  const SwitchedQuadrotor vehicle = flight_vehicle<AgileFlight>(plan.airframe, ground_effect);
  const SwitchedQuadrotor on_battery = flight_vehicle<AgileFlight>(plan.airframe, ground_effect, plan.battery);
  std::vector<double> columns = plan.columns;
  double* const voltage_V = plan.battery ? voltage_among(model, columns) : nullptr;
  const double ground_z_m = vehicle.site().ground_z_m;
  LoopFlights flights;
  flights.near_ground = near_ground;
  const ModelRange range = plan.keeps_envelope ? range_of(model) : range_of(model).of_altitude();
  const AnyTrajectory trajectory = trajectory_of(plan, ground_z_m, range, flights);
  const AnyTrajectory without_jerk{[&](double time_s) { return pinnquad::without_jerk(trajectory.sample(time_s)); }};
  Commands<double> trim{};
  Status status = on_battery.status();
  if (status == Status::ok) status = hover_trim(vehicle, trajectory.sample(0).position_m, trim);
  if (status != Status::ok) {
    throw std::invalid_argument(std::string("this airframe can't be flown ") +
                                (flights.near_ground ? "near the ground" : "here") + ": " + to_string(status));
  }
  const FlightController<double> controller(
      {}, flight_limits(vehicle.airframe(), vehicle.rotor_scale(vehicle.surroundings({}, 0))));
  TrackingPlan<double> how;
  how.duration_s = flights.duration_s;
  const auto fly = [&](const AnyTrajectory& path, const AnyFeedForward& feed_forward, const SwitchedQuadrotor& flown,
                       FlownTrace& trace) {
    BatteryWorld<SwitchedQuadrotor> world{{flown}, voltage_V};
    return track(vehicle, world, path, controller, feed_forward, how, trace.observer(how.duration_s));
  };
  const AnalyticInverse<SwitchedQuadrotor> analytic(vehicle);
  using FallsBack = Fallback<AnalyticInverse<SwitchedQuadrotor>>;
  const auto behind = [&](const auto& guard) { return model_inverse(model, guard, ground_z_m, columns); };
  flights.model = fly(trajectory,
                      plan.keeps_envelope ? behind(Extend<TrainingGuard, FallsBack>(analytic))
                                          : behind(Guard<FiniteInputs, FallsBack>(analytic)),
                      on_battery, flights.traces.model);
  if (voltage_V != nullptr) flights.last_voltage_V = *voltage_V;
  FlownTrace unseen;
  flights.analytic_inverse = fly(trajectory, AnyFeedForward(analytic), vehicle, unseen);
  flights.without_jerk = fly(without_jerk, AnyFeedForward(analytic), vehicle, flights.traces.without);
  return flights;
}

}  // namespace programs
