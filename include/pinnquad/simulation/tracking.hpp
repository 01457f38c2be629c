// SPDX-License-Identifier: MIT
// A closed loop on a trajectory: simulated vehicle, tracking controller, one feed-forward policy; how far off it flies.
// No heap and no state of its own: it can run on the target as a check before flight.
#pragma once

#include <cmath>

#include "pinnquad/control/tracking_controller.hpp"

namespace pinnquad {

/// How long and how finely to fly.
template <class Scalar>
struct TrackingPlan {
  Scalar duration_s = Scalar(30);
  Scalar physics_step_s = Scalar(0.001);
  int steps_per_control{2};  ///< the commands are held over these

  constexpr Scalar control_period_s() const noexcept { return physics_step_s * Scalar(steps_per_control); }
};

/// Figures of a closed-loop flight.
template <class Scalar>
struct TrackingResult {
  Status status{Status::ok};  ///< the reason of an early end
  Scalar flown_s = Scalar(0);
  Scalar rmse_m = Scalar(0);  ///< position error, root of the mean square of its length over all control ticks
  Scalar max_error_m = Scalar(0);
  Scalar max_speed_m_s = Scalar(0);
  Scalar saturated_share = Scalar(0);  ///< of the control ticks, with a rotor at its end
  Status declined{Status::ok};         ///< of the first tick in which the policy had no answer and the rigid body flew
  FallbackCount fallback{};            ///< of a policy that has one, else zero
};

/// The vehicle flies as it is modelled, and is seen as it is. Another world has the same functions:
///   Status step(VehicleState<Scalar>&, const Commands<Scalar>&, Scalar step_s) noexcept   as Quadrotor::step()
///   State<Scalar> sense(const VehicleState<Scalar>&) noexcept                              what the controller sees
template <class Vehicle>
struct ExactWorld {
  const Vehicle& vehicle;

  template <class Scalar>
  Status step(VehicleState<Scalar>& state, const Commands<Scalar>& commands, Scalar step_s) const noexcept {
    return vehicle.step(state, commands, step_s);
  }
  template <class Scalar>
  const State<Scalar>& sense(const VehicleState<Scalar>& state) const noexcept {
    return state.body;
  }
};

/// Flies `trajectory` from its point at time 0, at rest with level attitude if the trajectory starts so.
/// `nominal`: the vehicle that the controller knows. `world`: what flies. `observer(time_s, point, vehicle, commands)`
/// sees each control tick.
/// The flight ends early where controller or physics give a Status without output; where the policy declines it goes
/// on (TrackingController). The figures cover what was flown.
template <class Scalar, class... Effects, class World, class Trajectory, class FeedForward, class Observer>
TrackingResult<Scalar> track(const Quadrotor<Scalar, Effects...>& nominal, World& world, const Trajectory& trajectory,
                             const FlightController<Scalar>& flight_controller, const FeedForward& feed_forward,
                             const TrackingPlan<Scalar>& plan, const Observer& observer) noexcept {
  using std::sqrt;
  TrackingResult<Scalar> result;
  const TrajectoryPoint<Scalar> start = trajectory.sample(Scalar(0));
  FlatMotion<Scalar> flat;
  result.status = flat_motion(start, nominal.site().gravity_m_s2, flat);
  if (result.status == Status::ok) result.status = nominal.status();
  if (result.status != Status::ok) return result;

  VehicleState<Scalar> vehicle;
  vehicle.body = {start.position_m, start.velocity_m_s, flat.attitude, flat.body_rates_rad_s};
  const Scalar rotor_scale = nominal.rotor_scale(nominal.surroundings(vehicle.body, Scalar(0)));
  Commands<Scalar> trim{};
  result.status = hover_trim(nominal, start.position_m, trim);
  if (result.status != Status::ok) return result;
  vehicle.rotors = trim;

  TrackingController<Scalar, FeedForward> controller(nominal.airframe(), flight_controller, feed_forward, rotor_scale);
  Commands<Scalar> commands{};
  const Scalar tick_s = plan.control_period_s();
  Scalar squares(0), largest_square(0), largest_speed_square(0);
  int ticks = 0, ticks_at_end = 0;
  for (; Scalar(ticks) * tick_s < plan.duration_s; ++ticks) {
    const Scalar time_s = Scalar(ticks) * tick_s;
    vehicle.time_s = static_cast<double>(time_s);
    const double time_us = 1e6 * static_cast<double>(ticks) * static_cast<double>(tick_s);
    const TrajectoryPoint<Scalar> point = trajectory.sample(time_s);
    const Scalar square = (point.position_m - vehicle.body.position_m).squaredNorm();
    squares += square;
    if (square > largest_square) largest_square = square;
    const Scalar speed_square = vehicle.body.velocity_m_s.squaredNorm();
    if (speed_square > largest_speed_square) largest_speed_square = speed_square;
    result.status = controller(world.sense(vehicle), point, static_cast<std::uint64_t>(time_us + 0.5), commands);
    if (saturated(commands)) ++ticks_at_end;
    observer(time_s, point, vehicle, commands);
    if (!has_output(result.status)) break;
    if (result.declined == Status::ok && !has_output(controller.feed_forward_status())) {
      result.declined = controller.feed_forward_status();
    }
    result.status = Status::ok;
    for (int i = 0; i < plan.steps_per_control && result.status == Status::ok; ++i) {
      result.status = world.step(vehicle, commands, plan.physics_step_s);
    }
    if (result.status != Status::ok) break;
  }
  const int counted = result.status == Status::ok ? ticks : ticks + 1;
  result.flown_s = Scalar(ticks) * tick_s;
  result.rmse_m = counted > 0 ? sqrt(squares / Scalar(counted)) : Scalar(0);
  result.max_error_m = sqrt(largest_square);
  result.max_speed_m_s = sqrt(largest_speed_square);
  result.saturated_share = counted > 0 ? Scalar(ticks_at_end) / Scalar(counted) : Scalar(0);
  result.fallback = fallback_count(controller.feed_forward());
  return result;
}

/// Tracks with a vehicle that is as its controller knows it.
template <class Scalar, class... Effects, class Trajectory, class FeedForward>
TrackingResult<Scalar> track(const Quadrotor<Scalar, Effects...>& quadrotor, const Trajectory& trajectory,
                             const FlightController<Scalar>& flight_controller, const FeedForward& feed_forward,
                             const TrackingPlan<Scalar>& plan = {}) noexcept {
  ExactWorld<Quadrotor<Scalar, Effects...>> world{quadrotor};
  return track(quadrotor, world, trajectory, flight_controller, feed_forward, plan, [](const auto&...) noexcept {});
}

}  // namespace pinnquad
