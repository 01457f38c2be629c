// SPDX-License-Identifier: MIT
// The value of an airframe's type. An airframe that can't be that of a flying quadrotor is a compile error.
#pragma once

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
template <class To>
constexpr Airframe<To> airframe_in(const Airframe<double>& from) noexcept {
  const auto one = [](double v) { return static_cast<To>(v); };
  const auto three = [one](const std::array<double, 3>& v) {
    return std::array<To, 3>{one(v[0]), one(v[1]), one(v[2])};
  };
  Airframe<To> a{};
  a.mass_kg = one(from.mass_kg);
  a.inertia_kg_m2 = three(from.inertia_kg_m2);
  a.inertia_products_kg_m2 = three(from.inertia_products_kg_m2);
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const RotorMount<double>& r = from.rotors[i];
    RotorMount<To>& to = a.rotors[i];
    to = {one(r.x_m), one(r.y_m), r.spin, one(r.z_m), three(r.axis)};
    to.thrust_scale = one(r.thrust_scale);
    to.thrust_curve = one(r.thrust_curve);
    to.rise_time_constant_s = one(r.rise_time_constant_s);
    to.fall_time_constant_s = one(r.fall_time_constant_s);
  }
  a.thrust_coefficient = one(from.thrust_coefficient);
  a.power_coefficient = one(from.power_coefficient);
  a.propeller_diameter_m = one(from.propeller_diameter_m);
  a.max_rotor_speed_rev_s = one(from.max_rotor_speed_rev_s);
  a.rotor_time_constant_s = one(from.rotor_time_constant_s);
  a.drag_area_m2 = three(from.drag_area_m2);
  a.drag_deadband_m_s = one(from.drag_deadband_m_s);
  return a;
}

}  // namespace pinnquad
