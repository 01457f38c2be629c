// SPDX-License-Identifier: MIT
// From an airframe's type to its value, refused at compile time where it can't be that of a quadrotor that flies.
#pragma once

#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad {

/// The airframe's value; refuses, at compile time and by rule, what is no airframe, cannot hover or cannot be steered.
template <class Vehicle, class Scalar>
constexpr Airframe<Scalar> airframe_value() noexcept {
  static_assert(is_airframe<Vehicle>,
                "pinnquad: an airframe needs `static constexpr const char* name` and `template <class Scalar> static "
                "constexpr Airframe<Scalar> value()` (dynamics/airframe.hpp)");
  if constexpr (is_airframe<Vehicle>) {
    constexpr Airframe<double> airframe = Vehicle::template value<double>();
    static_assert(check_airframe(airframe) == Status::ok,
                  "pinnquad: this airframe has a non-positive mass, an impossible inertia or cannot hover "
                  "(dynamics/airframe.hpp)");
    static_assert(Rotors<double>(airframe).status() == Status::ok,
                  "pinnquad: this airframe's rotors can't make thrust and the three torques independently: its "
                  "allocation can't be inverted (dynamics/rotor.hpp)");
    return Vehicle::template value<Scalar>();
  } else {
    return {};
  }
}

}  // namespace pinnquad
