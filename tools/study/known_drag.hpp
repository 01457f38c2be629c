// SPDX-License-Identifier: MIT
// A feed-forward policy with drag that is known: the attitude leans against it before there is an error.
#pragma once

#include <cstdint>

#include "pinnquad/control/adaptive_inverse.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace study {

using namespace pinnquad;

/// The other policy's commands. The acceleration across the thrust that the effects of `Vehicle` make, with its rotors
/// as in hover, is taken from what is asked for.
template <class FeedForward, class Vehicle>
class KnownDrag;

/// Of a quadrotor with its effects.
template <class FeedForward, class Scalar, class... Effects>
class KnownDrag<FeedForward, Quadrotor<Scalar, Effects...>> {
 public:
  KnownDrag(const FeedForward& inverse, const Quadrotor<Scalar, Effects...>& vehicle) noexcept
      : inverse_(inverse), vehicle_(vehicle) {}

  Status operator()(const State<Scalar>& state, const Accelerations<Scalar>& wanted, std::uint64_t time_us,
                    Commands<Scalar>& commands) noexcept {
    return inverse_(state, wanted, time_us, commands);
  }
  /// The other's own answer to a motion that was flown (NetworkInverse::observed()).
  Status observed(const State<Scalar>& state, const Accelerations<Scalar>& flown, std::uint64_t time_us,
                  Commands<Scalar>& commands) noexcept {
    return observed_by(inverse_, state, flown, time_us, commands);
  }
  Vector3<Scalar> across_m_s2(const State<Scalar>& state) const noexcept {
    const Surroundings<Scalar> air = vehicle_.surroundings(state, Scalar(0));
    const Scalar hover = vehicle_.airframe().mass_kg * vehicle_.site().gravity_m_s2 / vehicle_.rotor_scale(air);
    ThrustFractions<Scalar> fractions = vehicle_.rotors().fractions_of_pure_thrust_1_N();
    for (Scalar& fraction : fractions) fraction *= hover;
    Vector3<Scalar> across = vehicle_.aerodynamic_wrench(state, air, fractions).force_N / vehicle_.airframe().mass_kg;
    across[2] = Scalar(0);
    return body_to_world<Scalar>(state.attitude, across);
  }
  FallbackCount count() const noexcept { return fallback_count(inverse_); }

 private:
  FeedForward inverse_;
  Quadrotor<Scalar, Effects...> vehicle_;
};

}  // namespace study
