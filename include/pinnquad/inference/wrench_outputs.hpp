// SPDX-License-Identifier: MIT
// Outputs that are no rotors: what the rotors together are to do, as a wrench or as the accelerations that it makes. The
// airframe's allocation turns both into commands. Air of the rated density, as everywhere where it is not said.
#pragma once

#include "pinnquad/inference/output_schema.hpp"

namespace pinnquad {

/// Thrust (up, along -z) and torque about FRD x, y, z.
struct WrenchOutputs {
  static constexpr int size = 4;
  static constexpr std::array<const char*, size> names = {"thrust", "torque_x", "torque_y", "torque_z"};
  static constexpr std::array<const char*, size> units = {"N", "N m", "N m", "N m"};
  static constexpr bool linear = true;

  template <class Scalar>
  static constexpr Rotors<Scalar> prepare(const Airframe<Scalar>& airframe) noexcept {
    return Rotors<Scalar>(airframe);
  }
  template <class Scalar>
  static void commands(const Scalar*, const Scalar* y, const Rotors<Scalar>& rotors, Scalar* u) noexcept {
    const Wrench<Scalar> wanted{{Scalar(0), Scalar(0), -y[0]}, {y[1], y[2], y[3]}};
    const Commands<Scalar> made = rotors.commands(wanted, Scalar(1));
    for (std::size_t i = 0; i < rotor_count; ++i) u[i] = made[i];
  }
  template <class Scalar>
  static void from_commands(const Scalar*, const Scalar* u, const Rotors<Scalar>& rotors, Scalar* y) noexcept {
    const Wrench<Scalar> made = rotors.wrench({u[0], u[1], u[2], u[3]}, Scalar(1));
    y[0] = -made.force_N[2];
    for (int axis = 0; axis < 3; ++axis) y[1 + axis] = made.torque_N_m[axis];
  }
};

/// Specific force f = F / m (what an accelerometer shows of the rotors) and angular acceleration J^-1 tau that the rotors make,
/// body frame. They make no lateral force: f_x and f_y are 0 in training and change no command.
struct AccelerationOutputs {
  static constexpr int size = 6;
  static constexpr std::array<const char*, size> names = {"f_x", "f_y", "f_z", "a_x", "a_y", "a_z"};
  static constexpr std::array<const char*, size> units = {"m/s^2", "m/s^2", "m/s^2", "rad/s^2", "rad/s^2", "rad/s^2"};
  static constexpr bool linear = true;

  template <class Scalar>
  struct Body {
    Rotors<Scalar> rotors;
    Airframe<Scalar> airframe;
  };
  template <class Scalar>
  static constexpr Body<Scalar> prepare(const Airframe<Scalar>& airframe) noexcept {
    return {Rotors<Scalar>(airframe), airframe};
  }
  template <class Scalar>
  static void commands(const Scalar* x, const Scalar* y, const Body<Scalar>& body, Scalar* u) noexcept {
    const auto& inertia = body.airframe.inertia_kg_m2;
    const Scalar wrench[4] = {-body.airframe.mass_kg * y[2], inertia[0] * y[3], inertia[1] * y[4], inertia[2] * y[5]};
    WrenchOutputs::commands(x, static_cast<const Scalar*>(wrench), body.rotors, u);
  }
  template <class Scalar>
  static void from_commands(const Scalar* x, const Scalar* u, const Body<Scalar>& body, Scalar* y) noexcept {
    const auto& inertia = body.airframe.inertia_kg_m2;
    Scalar wrench[4] = {};
    WrenchOutputs::from_commands(x, u, body.rotors, static_cast<Scalar*>(wrench));
    const Scalar made[6] = {Scalar(0),
                            Scalar(0),
                            -wrench[0] / body.airframe.mass_kg,
                            wrench[1] / inertia[0],
                            wrench[2] / inertia[1],
                            wrench[3] / inertia[2]};
    for (int i = 0; i < 6; ++i) y[i] = made[i];
  }
};

}  // namespace pinnquad
