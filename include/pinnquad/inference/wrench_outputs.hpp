// SPDX-License-Identifier: MIT
// Outputs that are no rotors: what the rotors together are to do, as a wrench or as the accelerations that it makes. The
// airframe's allocation turns both into commands. Air of the rated density, as everywhere where it is not said.
#pragma once

#include "pinnquad/dynamics/inertia.hpp"
#include "pinnquad/inference/output_schema.hpp"

namespace pinnquad {

/// Thrust (up, along -z) and torque about FRD x, y, z.
struct WrenchOutputs {
  static constexpr int size = 4;
  static constexpr std::array<const char*, size> names = {"thrust", "torque_x", "torque_y", "torque_z"};
  static constexpr std::array<const char*, size> units = {"N", "N m", "N m", "N m"};

  template <class Scalar>
  static constexpr Rotors<Scalar> prepare(const Airframe<Scalar>& airframe) noexcept {
    return Rotors<Scalar>(airframe);
  }
  template <class Scalar>
  static void commands(const Scalar*, const Scalar* y, const Rotors<Scalar>& rotors, Scalar* u) noexcept {
    const Commands<Scalar> made = wanted(y, rotors);
    for (std::size_t i = 0; i < rotor_count; ++i) u[i] = made[i];
  }
  template <class Scalar>
  static void slopes(const Scalar*, const Scalar* y, const Rotors<Scalar>& rotors, Scalar* by_outputs) noexcept {
    const AllocationMatrix<Scalar> by_wrench = rotors.command_slopes(wanted(y, rotors), Scalar(1));
    for (std::size_t i = 0; i < rotor_count; ++i) {
      for (std::size_t k = 0; k < 4; ++k) by_outputs[i * 4 + k] = by_wrench[i][k];
    }
  }
  template <class Scalar>
  static void from_commands(const Scalar*, const Scalar* u, const Rotors<Scalar>& rotors, Scalar* y) noexcept {
    const Wrench<Scalar> made = rotors.wrench({u[0], u[1], u[2], u[3]}, Scalar(1));
    y[0] = -made.force_N[2];
    for (int axis = 0; axis < 3; ++axis) y[1 + axis] = made.torque_N_m[axis];
  }

 private:
  template <class Scalar>
  static Commands<Scalar> wanted(const Scalar* y, const Rotors<Scalar>& rotors) noexcept {
    return rotors.commands({{Scalar(0), Scalar(0), -y[0]}, {y[1], y[2], y[3]}}, Scalar(1));
  }
};

/// Specific force f = F / m (what an accelerometer shows of the rotors) and angular acceleration J^-1 tau that the rotors make,
/// body frame. Lateral force can't be commanded: f_x and f_y, 0 of upright rotors, change no command.
struct AccelerationOutputs {
  static constexpr int size = 6;
  static constexpr std::array<const char*, size> names = {"f_x", "f_y", "f_z", "a_x", "a_y", "a_z"};
  static constexpr std::array<const char*, size> units = {"m/s^2", "m/s^2", "m/s^2", "rad/s^2", "rad/s^2", "rad/s^2"};

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
  static void commands(const Scalar*, const Scalar* y, const Body<Scalar>& body, Scalar* u) noexcept {
    const Commands<Scalar> made = body.rotors.commands(wrench(y, body), Scalar(1));
    for (std::size_t i = 0; i < rotor_count; ++i) u[i] = made[i];
  }
  template <class Scalar>
  static void slopes(const Scalar*, const Scalar* y, const Body<Scalar>& body, Scalar* by_outputs) noexcept {
    const AllocationMatrix<Scalar> by_wrench =
        body.rotors.command_slopes(body.rotors.commands(wrench(y, body), Scalar(1)), Scalar(1));
    for (int k = 0; k < size; ++k) {
      Scalar unit[size] = {};
      unit[k] = Scalar(1);
      const Wrench<Scalar> column = wrench(static_cast<const Scalar*>(unit), body);  // it is linear in y
      for (std::size_t i = 0; i < rotor_count; ++i) {
        by_outputs[static_cast<int>(i) * size + k] =
            -by_wrench[i][0] * column.force_N[2] + by_wrench[i][1] * column.torque_N_m[0] +
            by_wrench[i][2] * column.torque_N_m[1] + by_wrench[i][3] * column.torque_N_m[2];
      }
    }
  }
  template <class Scalar>
  static void from_commands(const Scalar*, const Scalar* u, const Body<Scalar>& body, Scalar* y) noexcept {
    const Wrench<Scalar> made = body.rotors.wrench({u[0], u[1], u[2], u[3]}, Scalar(1));
    const Vector3<Scalar> angular = inertia_solved(body.airframe, made.torque_N_m);
    for (int axis = 0; axis < 3; ++axis) {
      y[axis] = made.force_N[axis] / body.airframe.mass_kg;
      y[3 + axis] = angular[axis];
    }
  }

 private:
  template <class Scalar>
  static Wrench<Scalar> wrench(const Scalar* y, const Body<Scalar>& body) noexcept {
    return {{Scalar(0), Scalar(0), body.airframe.mass_kg * y[2]},
            inertia_times(body.airframe, Vector3<Scalar>(y[3], y[4], y[5]))};
  }
};

}  // namespace pinnquad
