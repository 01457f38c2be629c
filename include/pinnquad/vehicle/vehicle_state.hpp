// SPDX-License-Identifier: MIT
// The numbers of a vehicle in flight.
#pragma once

#include "pinnquad/aero/effect.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad {

/// Everything that Quadrotor::step() advances.
template <class Scalar>
struct VehicleState {
  State<Scalar> body{};
  Commands<Scalar> rotors{};        ///< behind the lag: the commands at which the present thrusts would be settled
  Wide<Scalar> time_s{0.0};         ///< double also for a float vehicle
  Wide<Scalar> charge_used_C{0.0};  ///< of the battery since the start; 0 without one
};

namespace detail {
/// The battery under the load of the rotors as they turn.
template <class Scalar>
BatteryUse<Scalar> battery_use(const VehicleState<Scalar>& vehicle, const Rotors<Scalar>& rotors) noexcept {
  return {Scalar(vehicle.charge_used_C), rotors.fractions(vehicle.rotors)};
}

/// Beyond half a turn in one step an attitude is no longer followed but guessed.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Mask<Scalar> can_follow(const State<Scalar>& body, Scalar step_s) noexcept {
  constexpr Scalar half_turn_rad = Scalar(pi);
  const Scalar x = body.body_rates_rad_s[0] * step_s, y = body.body_rates_rad_s[1] * step_s,
               z = body.body_rates_rad_s[2] * step_s;
  return x * x + y * y + z * z <= half_turn_rad * half_turn_rad;
}
}  // namespace detail

}  // namespace pinnquad
