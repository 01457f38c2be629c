// SPDX-License-Identifier: MIT
// The quadrotor of the independent reference simulator, with its float32 constants, at 1.5 kg and at 1.0 kg.
// Source: values printed by that running simulator (AirSim's physics in the paper's fork).
#pragma once

#include "pinnquad/dynamics/airframe_value.hpp"

namespace pinnquad {

namespace detail {
template <class Scalar>
constexpr Airframe<Scalar> reference_rotors_and_drag() {
  Airframe<Scalar> a{};
  constexpr Scalar arm = Scalar(0.24395184);
  a.rotors = x_rotors(arm, arm);
  a.thrust_coefficient = Scalar(0.109918997);
  a.power_coefficient = Scalar(0.0401640013);
  a.propeller_diameter_m = Scalar(0.228599995);
  a.max_rotor_speed_rev_s = Scalar(106.611117);
  a.rotor_time_constant_s = Scalar(0.00499999989);
  a.drag_area_m2 = {Scalar(0.00538309224), Scalar(0.00583809226), Scalar(0.10993009)};
  a.drag_deadband_m_s = Scalar(0.1);
  return a;
}
}  // namespace detail

/// The vehicle at 1.5 kg.
struct ReferenceQuadrotor15 {
  static constexpr const char* name = "reference_1.5kg";

  template <class Scalar>
  static constexpr Airframe<Scalar> value() {
    Airframe<Scalar> a = detail::reference_rotors_and_drag<Scalar>();
    a.mass_kg = Scalar(1.5);
    a.inertia_kg_m2 = {Scalar(0.0146915832), Scalar(0.0168569168), Scalar(0.0309321666)};
    return a;
  }
};

/// The vehicle at 1.0 kg.
struct ReferenceQuadrotor10 {
  static constexpr const char* name = "reference_1.0kg";

  template <class Scalar>
  static constexpr Airframe<Scalar> value() {
    Airframe<Scalar> a = detail::reference_rotors_and_drag<Scalar>();
    a.mass_kg = Scalar(1.0);
    a.inertia_kg_m2 = {Scalar(0.01412075), Scalar(0.01544025), Scalar(0.02907800)};
    return a;
  }
};

}  // namespace pinnquad
