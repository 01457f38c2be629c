// SPDX-License-Identifier: MIT
// The inverse of a rigid body with a residual wrench: force and torque that its rotors do not account for, from the
// air's velocity past the vehicle, its body rates and the state of its rotors.
// Contract of a residual wrench, learnt (study/wrench_network.hpp) or nominal (NominalWrench):
//   Accelerations<S> operator()(const WrenchInputs<S>&) const noexcept
// force / mass and angular acceleration, body frame, of everything but rotors and gravity.
#pragma once

#include <cstdint>

#include "pinnquad/control/adaptive_inverse.hpp"
#include "pinnquad/control/rotor_follower.hpp"
#include "pinnquad/control/tick_clock.hpp"
#include "pinnquad/dynamics/rigid_body.hpp"
#include "pinnquad/dynamics/rotor.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace study {

using namespace pinnquad;

/// The inputs of a residual wrench, body frame FRD.
template <class Scalar>
struct WrenchInputs {
  Vector3<Scalar> air_velocity_m_s = Vector3<Scalar>::Zero();  ///< of the vehicle through the air: R^T (v - wind)
  Vector3<Scalar> body_rates_rad_s = Vector3<Scalar>::Zero();
  Commands<Scalar> rotors{};  ///< commands behind the rotors' lag, never those of the present tick
};

/// The wrench of the effects of a vehicle, by hand and from tables, in calm air.
template <class Vehicle>
class NominalWrench;
/// Of a quadrotor with its effects.
template <class Scalar, class... Effects>
class NominalWrench<Quadrotor<Scalar, Effects...>> {
 public:
  explicit NominalWrench(const Quadrotor<Scalar, Effects...>& vehicle) noexcept : vehicle_(vehicle) {}

  Accelerations<Scalar> operator()(const WrenchInputs<Scalar>& in) const noexcept {
    State<Scalar> state;
    state.velocity_m_s = in.air_velocity_m_s;
    state.body_rates_rad_s = in.body_rates_rad_s;
    const Wrench<Scalar> wrench = vehicle_.aerodynamic_wrench(state, vehicle_.surroundings(state, Scalar(0)),
                                                              vehicle_.rotors().fractions(in.rotors));
    const pinnquad::Airframe<Scalar>& airframe = vehicle_.airframe();
    return {wrench.force_N / airframe.mass_kg, inertia_solved(airframe, wrench.torque_N_m)};
  }

 private:
  Quadrotor<Scalar, Effects...> vehicle_;
};

/// The disturbance that a WrenchInverse is told beside its residual wrench.
template <class Scalar>
struct WindAndThrust {
  Vector3<Scalar> wind_m_s = Vector3<Scalar>::Zero();    ///< NED
  Scalar thrust_scale{1};                                ///< of all rotors
  Vector3<Scalar> force_m_s2 = Vector3<Scalar>::Zero();  ///< force / mass that nothing explains, NED
};

/// A feed-forward policy: thrust and torque are solved with the residual wrench at the rotors' present state, and what
/// of it acts across the thrust leans the attitude (across_m_s2()).
template <class Scalar, class Residual>
class WrenchInverse {
 public:
  /// `rotor_scale` of the place (Quadrotor::rotor_scale).
  WrenchInverse(const pinnquad::Airframe<Scalar>& airframe, const Residual& residual, Scalar rotor_scale = Scalar(1),
                Scalar gravity_m_s2 = standard_gravity_m_s2<Scalar>) noexcept
      : airframe_(airframe),
        mount_(airframe),
        residual_(residual),
        rotor_scale_(rotor_scale),
        gravity_m_s2_(gravity_m_s2),
        follower_(airframe.rise_time_constant_s(0)) {
    const Wrench<Scalar> hover{Vector3<Scalar>(Scalar(0), Scalar(0), -airframe.mass_kg * gravity_m_s2),
                               Vector3<Scalar>::Zero()};
    rotors_ = clipped(mount_.commands(hover, rotor_scale));
  }

  const Residual& residual() const noexcept { return residual_; }
  const pinnquad::Airframe<Scalar>& airframe() const noexcept { return airframe_; }
  void tell(const WindAndThrust<Scalar>& told) noexcept { told_ = told; }
  const WindAndThrust<Scalar>& told() const noexcept { return told_; }

  /// The rotors follow the commands in force.
  void learn(std::uint64_t now_us, bool /*known*/, const State<Scalar>&, const Commands<Scalar>& commands) noexcept {
    const Scalar step_s = clock_.step_s(now_us);
    if (!all_finite(commands)) return;
    if (!(step_s > Scalar(0))) follower_.restart(commands);
    static_cast<void>(follower_.follow(now_us, step_s, commands));
    rotors_ = follower_.then();
  }

  Status operator()(const State<Scalar>& state, const Accelerations<Scalar>& wanted, std::uint64_t /*time_us*/,
                    Commands<Scalar>& commands) noexcept {
    if (!(all_finite(state) && all_finite(wanted.linear_m_s2) && all_finite(wanted.angular_rad_s2))) {
      return Status::not_finite;
    }
    const Accelerations<Scalar> air = residual_(inputs(state));
    Wrench<Scalar> needed = required_wrench(airframe_, state, wanted, gravity_m_s2_);
    const Vector3<Scalar> unexplained = world_to_body<Scalar>(state.attitude, told_.force_m_s2);
    needed.force_N -= airframe_.mass_kg * (air.linear_m_s2 + unexplained);
    needed.torque_N_m -= inertia_times(airframe_, air.angular_rad_s2);
    const Commands<Scalar> solved = mount_.commands(needed, rotor_scale_ * told_.thrust_scale);
    if (!all_finite(solved)) return Status::output_not_finite;
    commands = solved;
    return Status::ok;
  }

  Vector3<Scalar> across_m_s2(const State<Scalar>& state) const noexcept {
    Vector3<Scalar> across =
        residual_(inputs(state)).linear_m_s2 + world_to_body<Scalar>(state.attitude, told_.force_m_s2);
    across[2] = Scalar(0);
    return body_to_world<Scalar>(state.attitude, across);
  }

  /// Force / mass of rotors in this state, body, at a thrust scale of 1.
  Vector3<Scalar> rotor_force_m_s2(const Commands<Scalar>& rotors) const noexcept {
    return mount_.wrench(rotors, rotor_scale_).force_N / airframe_.mass_kg;
  }
  WrenchInputs<Scalar> inputs(const State<Scalar>& state) const noexcept {
    const Vector3<Scalar> through_air = state.velocity_m_s - told_.wind_m_s;
    return {world_to_body<Scalar>(state.attitude, through_air), state.body_rates_rad_s, rotors_};
  }

 private:
  pinnquad::Airframe<Scalar> airframe_;
  Rotors<Scalar> mount_;
  Residual residual_;
  Scalar rotor_scale_, gravity_m_s2_;
  pinnquad::detail::RotorFollower<Scalar> follower_;
  pinnquad::detail::TickClock<Scalar> clock_;
  Commands<Scalar> rotors_{};
  WindAndThrust<Scalar> told_{};
};

}  // namespace study
