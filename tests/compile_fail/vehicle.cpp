// SPDX-License-Identifier: MIT
// CASE NOT_AN_EFFECT: pinnquad: this type is not an aerodynamic effect
// CASE EFFECT_RETURNS_A_FORCE: pinnquad: this type is not an aerodynamic effect
// CASE NOT_AN_AIRFRAME: pinnquad: an airframe needs
// CASE AIRFRAME_CANNOT_HOVER: pinnquad: this airframe has a non-positive mass, an impossible inertia or cannot hover
// CASE AIRFRAME_WITHOUT_MASS: pinnquad: this airframe has a non-positive mass, an impossible inertia or cannot hover
// CASE IMPOSSIBLE_INERTIA: pinnquad: this airframe has a non-positive mass, an impossible inertia or cannot hover
// CASE ROTORS_IN_A_LINE: pinnquad: this airframe's rotors can't make thrust and the three torques independently
// CASE ALL_SPIN_ALIKE: pinnquad: this airframe's rotors can't make thrust and the three torques independently
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace {

struct Nothing {};

/// A force where a wrench belongs.
struct ForceOnly {
  template <class Scalar>
  pinnquad::Vector3<Scalar> wrench(const pinnquad::AeroCondition<Scalar>&,
                                   const pinnquad::Airframe<Scalar>&) const noexcept {
    return pinnquad::Vector3<Scalar>::Zero();
  }
};

/// The paper's airframe with one value changed by the case.
struct Changed {
  static constexpr const char* name = "changed";
  template <class Scalar>
  static constexpr pinnquad::Airframe<Scalar> value() {
    pinnquad::Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
#if defined(AIRFRAME_CANNOT_HOVER)
    airframe.max_rotor_speed_rev_s = Scalar(95);  // thrust-to-weight 0.9
#elif defined(AIRFRAME_WITHOUT_MASS)
    airframe.mass_kg = Scalar(0);
#elif defined(IMPOSSIBLE_INERTIA)
    airframe.inertia_kg_m2[2] = Scalar(0.1);  // more than Jx + Jy: no body has it
#elif defined(ROTORS_IN_A_LINE)
    for (auto& rotor : airframe.rotors) rotor.y_m = Scalar(0);
#elif defined(ALL_SPIN_ALIKE)
    for (auto& rotor : airframe.rotors) rotor.spin = pinnquad::Spin::clockwise;
#else
    airframe.mass_kg = Scalar(2);
#endif
    return airframe;
  }
};

#if defined(NOT_AN_EFFECT)
using Effect = Nothing;
#elif defined(EFFECT_RETURNS_A_FORCE)
using Effect = ForceOnly;
#else
using Effect = pinnquad::QuadraticDrag;
#endif

#if defined(NOT_AN_AIRFRAME)
using Vehicle = Nothing;
#else
using Vehicle = Changed;
#endif

}  // namespace

int main() {
  const pinnquad::Quadrotor<double, Effect> quadrotor(pinnquad::airframe_value<Vehicle, double>());
  return static_cast<int>(quadrotor.status()) +
         static_cast<int>(sizeof(Nothing) + sizeof(ForceOnly) + sizeof(Changed)) - 3;
}
