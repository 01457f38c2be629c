// SPDX-License-Identifier: MIT
// CASE NOT_AN_EFFECT: pinnquad: this type is not an aerodynamic effect
// CASE EFFECT_RETURNS_A_FORCE: pinnquad: this type is not an aerodynamic effect
// CASE PAYLOAD_FIRST: pinnquad: an effect that comes last, such as Payload, scales the forces of those before it
// CASE NOT_AN_AIRFRAME: pinnquad: an airframe needs
// CASE AIRFRAME_CANNOT_HOVER: pinnquad: this airframe has a non-positive mass, an impossible inertia or cannot hover
// CASE AIRFRAME_WITHOUT_MASS: pinnquad: this airframe has a non-positive mass, an impossible inertia or cannot hover
// CASE IMPOSSIBLE_INERTIA: pinnquad: this airframe has a non-positive mass, an impossible inertia or cannot hover
// CASE ROTORS_IN_A_LINE: pinnquad: this airframe's rotors can't make thrust and the three torques independently
// CASE ALL_SPIN_ALIKE: pinnquad: this airframe's rotors can't make thrust and the three torques independently
// CASE FIFTH_ROTOR: pinnquad: this airframe.s value.. can.t be computed when compiled. An airframe has four rotors
// CASE READS_THE_ROTORS_WRENCH: pinnquad: this effect reads the rotors' wrench or thrusts without declaring it
// CASE READS_THE_ROTORS_THRUSTS: pinnquad: this effect reads the rotors' wrench or thrusts without declaring it
// CASE SURROUNDINGS_MAY_THROW: pinnquad: an effect flies: its surroundings.., wrench.., wrench_on.., bound.. and status.. must be noexcept
// CASE WRENCH_MAY_THROW: pinnquad: an effect flies: its surroundings.., wrench.., wrench_on.., bound.. and status.. must be noexcept
// CASE BOUND_MAY_THROW: pinnquad: an effect flies: its surroundings.., wrench.., wrench_on.., bound.. and status.. must be noexcept
// CASE WRENCH_IS_PASSED_OVER: pinnquad: an effect's surroundings.., wrench.., wrench_on.., bound.. or status.. can.t be called as the contract says
// CASE SURROUNDINGS_ARE_PASSED_OVER: pinnquad: an effect's surroundings.., wrench.., wrench_on.., bound.. or status.. can.t be called
// CASE STATUS_MAY_THROW: pinnquad: an effect flies: its surroundings.., wrench.., wrench_on.., bound.. and status.. must be noexcept
// CASE STATUS_IS_A_BOOL: pinnquad: an effect's surroundings.., wrench.., wrench_on.., bound.. or status.. can.t be called
// CASE STATUS_IS_PASSED_OVER: pinnquad: an effect's surroundings.., wrench.., wrench_on.., bound.. or status.. can.t be called
// CASE STATUS_OF_ANOTHER_SCALAR: pinnquad: an effect's surroundings.., wrench.., wrench_on.., bound.. or status.. can.t be called
// CASE BOUND_IS_PASSED_OVER: pinnquad: an effect's surroundings.., wrench.., wrench_on.., bound.. or status.. can.t be called
// CASE BOUND_WRENCH_MAY_THROW: pinnquad: what an effect's bound.. returns flies in its place: it must be an effect
// CASE BOUND_IS_NO_EFFECT: pinnquad: what an effect's bound.. returns flies in its place: it must be an effect
// CASE GROUND_EFFECT_WITH_A_POLE: pinnquad: an effect, as it is by default, refuses this airframe .its status...
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/payload.hpp"
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

struct MayThrow {
  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const pinnquad::AeroCondition<Scalar>&, const pinnquad::Airframe<Scalar>&) const {
    return {};
  }
};

/// Drag as the rotors turn, and a wind; each case leaves something out.
struct Whole {
  template <class Scalar>
#if defined(SURROUNDINGS_ARE_PASSED_OVER)
  void surroundings(pinnquad::Surroundings<Scalar>&, Scalar) const
#else
  void surroundings(pinnquad::Surroundings<Scalar>&) const
#endif
#if !defined(SURROUNDINGS_MAY_THROW)
      noexcept
#endif
  {
  }

#if defined(READS_THE_ROTORS_WRENCH) || defined(READS_THE_ROTORS_THRUSTS)
  template <class Scalar>
  using Condition = pinnquad::AeroCondition<Scalar>;
#else
  template <class Scalar>
  using Condition = pinnquad::RotorCondition<Scalar>;
#endif
  template <class Scalar>
#if defined(WRENCH_IS_PASSED_OVER)
  pinnquad::Wrench<Scalar> wrench(const Condition<Scalar>& condition) const
#else
  pinnquad::Wrench<Scalar> wrench(const Condition<Scalar>& condition, const pinnquad::Airframe<Scalar>&) const
#endif
#if !defined(WRENCH_MAY_THROW)
      noexcept
#endif
  {
    pinnquad::Wrench<Scalar> result;
#if !defined(READS_THE_ROTORS_THRUSTS)
    result.force_N = Scalar(-0.01) * condition.rotors.force_N;
#endif
#if !defined(READS_THE_ROTORS_WRENCH)
    result.torque_N_m[2] = Scalar(0.01) * condition.rotor_thrust_N[0];
#endif
    return result;
  }

  template <class Scalar>
#if defined(STATUS_IS_A_BOOL)
  bool status(const pinnquad::Airframe<Scalar>&) const
#elif defined(STATUS_IS_PASSED_OVER)
  pinnquad::Status status(const pinnquad::Airframe<Scalar>&)
#elif defined(STATUS_OF_ANOTHER_SCALAR)
  std::enable_if_t<std::is_same_v<Scalar, float>, pinnquad::Status> status(const pinnquad::Airframe<Scalar>&) const
#else
  pinnquad::Status status(const pinnquad::Airframe<Scalar>&) const
#endif
#if !defined(STATUS_MAY_THROW)
      noexcept
#endif
  {
    return {};
  }

#if defined(BOUND_WRENCH_MAY_THROW)
  using Kept = MayThrow;
#elif defined(BOUND_IS_NO_EFFECT)
  using Kept = Nothing;
#else
  using Kept = Whole;
#endif
  template <class Scalar>
#if defined(BOUND_IS_PASSED_OVER)
  Kept bound(const pinnquad::Airframe<Scalar>&, Scalar) const
#else
  Kept bound(const pinnquad::Airframe<Scalar>&) const
#endif
#if !defined(BOUND_MAY_THROW)
      noexcept
#endif
  {
    return {};
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
#elif defined(FIFTH_ROTOR)
    airframe.rotors[4] = {Scalar(0), Scalar(0), pinnquad::Spin::clockwise};
#elif defined(GROUND_EFFECT_WITH_A_POLE)
    for (auto& rotor : airframe.rotors) {  // a 450 mm frame on 10 inch propellers
      rotor.x_m *= Scalar(450.0 / 690.0);
      rotor.y_m *= Scalar(450.0 / 690.0);
    }
    airframe.propeller_diameter_m = Scalar(0.254);
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

#if defined(PAYLOAD_FIRST)
using Loaded = pinnquad::Quadrotor<double, pinnquad::Payload, Effect>;
#else
using Loaded = pinnquad::Quadrotor<double, Effect, pinnquad::Payload>;
#endif

#if defined(NOT_AN_AIRFRAME)
using Vehicle = Nothing;
#else
using Vehicle = Changed;
#endif

}  // namespace

int main() {
  const pinnquad::Quadrotor<double, Effect> quadrotor(pinnquad::airframe_value<Vehicle, double>());
  const Loaded loaded(quadrotor.airframe());
  pinnquad::VehicleState<double> state;
  pinnquad::Status status = pinnquad::Quadrotor<double, Whole>(quadrotor.airframe()).step(state, {}, 0.001);
#if !defined(NOT_AN_AIRFRAME)
  using NearGround = pinnquad::Quadrotor<double, pinnquad::GroundEffect<pinnquad::Conyers>>;
  if (status == pinnquad::Status::ok) status = NearGround::of<Vehicle>().step(state, {}, 0.001);
#endif
  return static_cast<int>(quadrotor.status()) + static_cast<int>(loaded.status()) + static_cast<int>(status) +
         static_cast<int>(sizeof(Nothing) + sizeof(ForceOnly) + sizeof(Changed) + sizeof(MayThrow)) - 4;
}
