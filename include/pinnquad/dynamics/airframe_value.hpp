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

/// The same airframe, every number rounded to `To`: what a struct written by deploy/airframe_writer.hpp has.
template <class To>
constexpr Airframe<To> airframe_in(const Airframe<double>& from) noexcept {
  const auto triple = [](const std::array<double, 3>& v) {
    return std::array<To, 3>{static_cast<To>(v[0]), static_cast<To>(v[1]), static_cast<To>(v[2])};
  };
  Airframe<To> a{};
  a.mass_kg = static_cast<To>(from.mass_kg);
  a.inertia_kg_m2 = triple(from.inertia_kg_m2);
  a.inertia_products_kg_m2 = triple(from.inertia_products_kg_m2);
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const RotorMount<double>& r = from.rotors[i];
    a.rotors[i] = {static_cast<To>(r.x_m),
                   static_cast<To>(r.y_m),
                   r.spin,
                   static_cast<To>(r.z_m),
                   triple(r.axis),
                   static_cast<To>(r.thrust_scale),
                   static_cast<To>(r.thrust_curve),
                   static_cast<To>(r.rise_time_constant_s),
                   static_cast<To>(r.fall_time_constant_s)};
  }
  a.thrust_coefficient = static_cast<To>(from.thrust_coefficient);
  a.power_coefficient = static_cast<To>(from.power_coefficient);
  a.propeller_diameter_m = static_cast<To>(from.propeller_diameter_m);
  a.max_rotor_speed_rev_s = static_cast<To>(from.max_rotor_speed_rev_s);
  a.rotor_time_constant_s = static_cast<To>(from.rotor_time_constant_s);
  a.drag_area_m2 = triple(from.drag_area_m2);
  a.drag_deadband_m_s = static_cast<To>(from.drag_deadband_m_s);
  return a;
}

}  // namespace pinnquad
