// SPDX-License-Identifier: MIT
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/payload.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

using namespace pinnquad;

struct Nothing {};

template <class... Effects>
Status stepped() {
  VehicleState<double> state;
  return Quadrotor<double, Effects...>(airframe_value<PaperQuadrotor, double>()).step(state, {}, 0.001);
}

/// Drag as the rotors turn, and a wind.
struct Sound {
  template <class Scalar>
  void surroundings(Surroundings<Scalar>&) const noexcept {}
  template <class Scalar>
  Wrench<Scalar> wrench(const RotorCondition<Scalar>& condition, const Airframe<Scalar>&) const noexcept {
    Wrench<Scalar> result;
    result.force_N = Scalar(-0.01) * condition.rotors.force_N;
    result.torque_N_m[2] = Scalar(0.01) * condition.rotor_thrust_N[0];
    return result;
  }
  template <class Scalar>
  Status status(const Airframe<Scalar>&) const noexcept {
    return {};
  }
};
struct MayThrow {
  template <class Scalar>
  Wrench<Scalar> wrench(const AeroCondition<Scalar>&, const Airframe<Scalar>&) const {
    return {};
  }
};

/// The same with one member in another way, and the paper's airframe with one value changed.
#define SPOILT(...)         \
  struct Spoilt : Sound {   \
    template <class Scalar> \
    __VA_ARGS__             \
  };                        \
  const auto status = stepped<Spoilt>()
#define CHANGED(...)                                               \
  struct Changed {                                                 \
    static constexpr const char* name = "changed";                 \
    template <class Scalar>                                        \
    static constexpr Airframe<Scalar> value() {                    \
      Airframe<Scalar> airframe = PaperQuadrotor::value<Scalar>(); \
      __VA_ARGS__;                                                 \
      return airframe;                                             \
    }                                                              \
  };                                                               \
  const Quadrotor<double> quadrotor(airframe_value<Changed, double>())

// SOUND
SPOILT(Spoilt bound(const Airframe<Scalar>&) const noexcept { return {}; });
CHANGED(airframe.mass_kg = Scalar(2));
const auto statuses = {stepped<QuadraticDrag>(), stepped<QuadraticDrag, Payload>(), stepped<Sound>(),
                       Quadrotor<double, GroundEffect<Conyers>>::of<Changed>().status()};

// CASE NOT_AN_EFFECT: pinnquad: this type is not an aerodynamic effect
const auto status = stepped<Nothing>();
// CASE EFFECT_RETURNS_A_FORCE: pinnquad: this type is not an aerodynamic effect
struct ForceOnly {
  template <class Scalar>
  Vector3<Scalar> wrench(const AeroCondition<Scalar>&, const Airframe<Scalar>&) const noexcept {
    return Vector3<Scalar>::Zero();
  }
};
const auto status = stepped<ForceOnly>();
// CASE PAYLOAD_FIRST: pinnquad: an effect that comes last, such as Payload, scales the forces of those before it
const auto status = stepped<Payload, QuadraticDrag>();
// CASE NOT_AN_AIRFRAME: pinnquad: an airframe needs
const auto airframe = airframe_value<Nothing, double>();
// CASE AIRFRAME_CANNOT_HOVER: pinnquad: this airframe has a non-positive mass, an impossible inertia or cannot hover
CHANGED(airframe.max_rotor_speed_rev_s = Scalar(95));  // thrust-to-weight 0.9
// CASE ALL_SPIN_ALIKE: pinnquad: this airframe's rotors can't make thrust and the three torques independently
CHANGED(for (auto& rotor : airframe.rotors) rotor.spin = Spin::clockwise);
// CASE FIFTH_ROTOR: pinnquad: this airframe.s value.. can.t be computed when compiled. An airframe has four rotors
CHANGED(airframe.rotors[4] = {Scalar(0), Scalar(0), Spin::clockwise});
// CASE READS_THE_ROTORS_WRENCH: pinnquad: this effect reads the rotors' wrench or thrusts without declaring it
SPOILT(Wrench<Scalar> wrench(const AeroCondition<Scalar>& condition, const Airframe<Scalar>&) const noexcept {
  return {condition.rotors.force_N, {}};
});
// CASE READS_THE_ROTORS_THRUSTS: pinnquad: this effect reads the rotors' wrench or thrusts without declaring it
SPOILT(Wrench<Scalar> wrench(const AeroCondition<Scalar>& condition, const Airframe<Scalar>&) const noexcept {
  return {{0, 0, condition.rotor_thrust_N[0]}, {}};
});
// CASE SURROUNDINGS_MAY_THROW: pinnquad: an effect flies: its surroundings.., wrench.., wrench_on.., bound.. and status.. must be noexcept
SPOILT(void surroundings(Surroundings<Scalar>&) const {});
// CASE WRENCH_MAY_THROW: pinnquad: an effect flies: its surroundings.., wrench.., wrench_on.., bound.. and status.. must be noexcept
const auto status = stepped<MayThrow>();
// CASE BOUND_MAY_THROW: pinnquad: an effect flies: its surroundings.., wrench.., wrench_on.., bound.. and status.. must be noexcept
SPOILT(Sound bound(const Airframe<Scalar>&) const { return {}; });
// CASE WRENCH_IS_PASSED_OVER: pinnquad: an effect's surroundings.., wrench.., wrench_on.., bound.. or status.. can.t be called as the contract says
SPOILT(Wrench<Scalar> wrench(const RotorCondition<Scalar>&) const noexcept { return {}; });
// CASE SURROUNDINGS_ARE_PASSED_OVER: pinnquad: an effect's surroundings.., wrench.., wrench_on.., bound.. or status.. can.t be called
SPOILT(void surroundings(Surroundings<Scalar>&, Scalar) const noexcept {});
// CASE STATUS_MAY_THROW: pinnquad: an effect flies: its surroundings.., wrench.., wrench_on.., bound.. and status.. must be noexcept
SPOILT(Status status(const Airframe<Scalar>&) const { return {}; });
// CASE STATUS_IS_A_BOOL: pinnquad: an effect's surroundings.., wrench.., wrench_on.., bound.. or status.. can.t be called
SPOILT(bool status(const Airframe<Scalar>&) const noexcept { return {}; });
// CASE STATUS_IS_PASSED_OVER: pinnquad: an effect's surroundings.., wrench.., wrench_on.., bound.. or status.. can.t be called
SPOILT(Status status(const Airframe<Scalar>&) noexcept { return {}; });
// CASE STATUS_OF_ANOTHER_SCALAR: pinnquad: an effect's surroundings.., wrench.., wrench_on.., bound.. or status.. can.t be called
SPOILT(std::enable_if_t<std::is_same_v<Scalar, float>, Status> status(const Airframe<Scalar>&)
           const noexcept { return {}; });
// CASE BOUND_IS_PASSED_OVER: pinnquad: an effect's surroundings.., wrench.., wrench_on.., bound.. or status.. can.t be called
SPOILT(Sound bound(const Airframe<Scalar>&, Scalar) const noexcept { return {}; });
// CASE BOUND_WRENCH_MAY_THROW: pinnquad: what an effect's bound.. returns flies in its place: it must be an effect
SPOILT(MayThrow bound(const Airframe<Scalar>&) const noexcept { return {}; });
// CASE BOUND_IS_NO_EFFECT: pinnquad: what an effect's bound.. returns flies in its place: it must be an effect
SPOILT(Nothing bound(const Airframe<Scalar>&) const noexcept { return {}; });
// CASE GROUND_EFFECT_WITH_A_POLE: pinnquad: an effect, as it is by default, refuses this airframe .its status...
CHANGED(for (auto& rotor
             : airframe.rotors) {  // a 450 mm frame on 10 inch propellers
  rotor.x_m *= Scalar(450.0 / 690.0);
  rotor.y_m *= Scalar(450.0 / 690.0);
} airframe.propeller_diameter_m = Scalar(0.254));
const auto status = Quadrotor<double, GroundEffect<Conyers>>::of<Changed>().status();
