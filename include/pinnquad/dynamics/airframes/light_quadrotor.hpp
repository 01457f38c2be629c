// SPDX-License-Identifier: MIT
// The vehicle of what is harder to fly than the paper's flights (simulation/harder_quadrotor.hpp).
#pragma once

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"

namespace pinnquad {

/// 1 kg: the reference simulator's inertia at that mass, the paper's rotors and drag without its deadband, and a rotor
/// lag of 20 ms (docs/simulator.md), four times the paper's.
struct LightQuadrotor {
  static constexpr const char* name = "light_quadrotor";

  template <class Scalar>
  static constexpr Airframe<Scalar> value() {
    const Airframe<Scalar> light = ReferenceQuadrotor10::value<Scalar>();
    Airframe<Scalar> a = PaperQuadrotor::value<Scalar>();
    a.mass_kg = light.mass_kg;
    a.inertia_kg_m2 = light.inertia_kg_m2;
    a.rotor_time_constant_s = Scalar(0.020);
    a.drag_deadband_m_s = Scalar(0);
    return a;
  }
};

}  // namespace pinnquad
