// SPDX-License-Identifier: MIT
// The analytic inverse as a policy: of a loop (state, motion, time -> commands), and of a guard, which falls back to
// it.
#pragma once

#include "pinnquad/features/features.hpp"
#include "pinnquad/inference/guard.hpp"
#include "pinnquad/vehicle/inverse.hpp"

namespace pinnquad {
inline namespace PINNQUAD_INSTRUCTION_SET {

template <class Vehicle>
class AnalyticInverse;

/// inverse_commands() (vehicle/inverse.hpp) through the vehicle's own effects.
/// As a fallback it works from the network's inputs, in the vehicle's scalar. With MotionInputs alone no effect may
/// depend on height, place or time; an altitude among the inputs says the height; the rest needs PlaceAndTime. The
/// compiler refuses a vehicle that needs more.
template <class Scalar, class... Effects>
class AnalyticInverse<Quadrotor<Scalar, Effects...>> {
 public:
  /// The effects' dependence besides motion and airframe.
  static constexpr VariesWith varies_with = widest_variation<Effects...>;

  explicit AnalyticInverse(const Quadrotor<Scalar, Effects...>& quadrotor) noexcept : quadrotor_(quadrotor) {}

  /// As a feed-forward policy (control/feed_forward.hpp).
  Status operator()(const State<Scalar>& state, const Accelerations<Scalar>& desired, std::uint64_t time_us,
                    Commands<Scalar>& commands) const noexcept {
    return inverse_commands(quadrotor_, state, desired, static_cast<Scalar>(seconds_of(time_us)), commands);
  }

  /// As a fallback. Any Status of inverse_commands(); the attitude may be a unit quaternion to its tolerance, as for a
  /// feature set, and is normalised.
  template <class Number>
  Status operator()(const MotionInputs<Number>& inputs, Commands<Number>& commands) const noexcept {
    static_assert(varies_with == VariesWith::motion,
                  "pinnquad: an effect of this vehicle depends on height, place or time, which these inputs don't say: "
                  "call predict(inputs, place, commands) (inference/guard.hpp)");
    return (*this)(inputs, PlaceAndTime<Scalar>{}, commands);
  }
  /// The altitude is that above the ground of the vehicle's site.
  template <class Number>
  Status operator()(const MotionInputsWithAltitude<Number>& inputs, Commands<Number>& commands) const noexcept {
    static_assert(varies_with != VariesWith::place_and_time,
                  "pinnquad: an effect of this vehicle depends on place or time, which these inputs don't say: call "
                  "predict(inputs, place, commands) (inference/guard.hpp)");
    return (*this)(inputs, PlaceAndTime<Scalar>{}, commands);
  }
  template <class Number, class Real>
  Status operator()(const MotionInputs<Number>& inputs, const PlaceAndTime<Real>& place,
                    Commands<Number>& commands) const noexcept {
    return solve(inputs, place.position_m.template cast<Scalar>(), Scalar(place.time_s), commands);
  }
  /// An altitude among the inputs outweighs the place's: it was measured from the ground, and the network got the same.
  template <class Number, class Real>
  Status operator()(const MotionInputsWithAltitude<Number>& inputs, const PlaceAndTime<Real>& place,
                    Commands<Number>& commands) const noexcept {
    Vector3<Scalar> position = place.position_m.template cast<Scalar>();
    position[2] = quadrotor_.site().ground_z_m - Scalar(inputs.altitude_m);
    return solve(inputs, position, Scalar(place.time_s), commands);
  }

 private:
  template <class Number>
  Status solve(const MotionInputs<Number>& inputs, const Vector3<Scalar>& position_m, Scalar time_s,
               Commands<Number>& commands) const noexcept {
    const Quaternion<Scalar> attitude{Scalar(inputs.attitude.w), Scalar(inputs.attitude.x), Scalar(inputs.attitude.y),
                                      Scalar(inputs.attitude.z)};
    const Status checked = PaperFeatures::check<Number>(inputs);
    if (checked != Status::ok) return checked;
    State<Scalar> state;
    state.position_m = position_m;
    state.attitude = normalized(attitude);
    state.velocity_m_s = body_to_world<Scalar>(state.attitude, inputs.velocity_m_s.template cast<Scalar>());
    state.body_rates_rad_s = inputs.body_rates_rad_s.template cast<Scalar>();
    const Accelerations<Scalar> motion{inputs.linear_acceleration_m_s2.template cast<Scalar>(),
                                       inputs.angular_acceleration_rad_s2.template cast<Scalar>()};
    Commands<Scalar> result{};
    const Status status = inverse_commands(quadrotor_, state, motion, time_s, result);
    if (status != Status::ok) return status;
    Commands<Number> narrowed{};
    for (std::size_t i = 0; i < rotor_count; ++i) narrowed[i] = Number(result[i]);
    if (!all_finite(narrowed)) return Status::output_not_finite;
    commands = narrowed;
    return Status::ok;
  }

  Quadrotor<Scalar, Effects...> quadrotor_;
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
