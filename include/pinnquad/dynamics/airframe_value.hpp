// SPDX-License-Identifier: MIT
// The value of an airframe's type. An airframe that can't be that of a flying quadrotor is a compile error.
#pragma once

#include <type_traits>

#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad {

namespace detail {
template <class Vehicle>
using CompiledAirframe = std::bool_constant<(static_cast<void>(Vehicle::template value<double>()), true)>;
}  // namespace detail

/// The airframe's value. A type that is no airframe, reaches past the fourth rotor, cannot hover or cannot be steered
/// is a compile error.
template <class Vehicle, class Scalar>
constexpr Airframe<Scalar> airframe_value() noexcept {
  static_assert(is_airframe<Vehicle>,
                "pinnquad: an airframe needs `static constexpr const char* name` and `template <class Scalar> static "
                "constexpr Airframe<Scalar> value()` (dynamics/airframe.hpp)");
  if constexpr (is_airframe<Vehicle>) {
    constexpr bool compiled = is_detected<detail::CompiledAirframe, Vehicle>;
    static_assert(compiled,
                  "pinnquad: this airframe's value() can't be computed when compiled. An airframe has four rotors, "
                  "rotors[0] to rotors[3]: does it reach for a fifth? (dynamics/airframe.hpp)");
    if constexpr (compiled) {
      constexpr Airframe<double> airframe = Vehicle::template value<double>();
      static_assert(check_airframe(airframe) == Status::ok,
                    "pinnquad: this airframe has a non-positive mass, an impossible inertia or cannot hover "
                    "(dynamics/airframe.hpp)");
      static_assert(Rotors<double>(airframe).status() == Status::ok,
                    "pinnquad: this airframe's rotors can't make thrust and the three torques independently: its "
                    "allocation can't be inverted (dynamics/allocation.hpp)");
      return Vehicle::template value<Scalar>();
    }
  }
  return {};
}

/// The rotors of an X with motors numbered as PX4 does: front right, rear left, front left, rear right; the first two
/// turn counter-clockwise. Upright, `forward_m` ahead of or behind the centre of gravity, `right_m` beside it.
template <class Scalar>
constexpr std::array<RotorMount<Scalar>, rotor_count> x_rotors(Scalar forward_m, Scalar right_m) noexcept {
  return {{{forward_m, right_m, Spin::counter_clockwise},
           {-forward_m, -right_m, Spin::counter_clockwise},
           {forward_m, -right_m, Spin::clockwise},
           {-forward_m, right_m, Spin::clockwise}}};
}

/// The same airframe, every number rounded to `To`: what a struct written by deploy/airframe_writer.hpp has.
template <class To, class From>
constexpr Airframe<To> airframe_in(const Airframe<From>& from) noexcept {
  double numbers[airframe_number_count] = {};
  double* next = static_cast<double*>(numbers);
  each_number(from, [&next](auto number) { *next++ = static_cast<double>(number); });
  next = static_cast<double*>(numbers);
  Airframe<To> a{};
  each_number(a, [&next](auto& number) { number = static_cast<std::decay_t<decltype(number)>>(*next++); });
  return a;
}

}  // namespace pinnquad
