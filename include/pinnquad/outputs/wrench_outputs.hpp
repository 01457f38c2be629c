// SPDX-License-Identifier: MIT
// Outputs of all rotors together: a wrench, or the accelerations that it makes. The airframe's allocation turns both
// into commands, in air of the rated density.
#pragma once

#include "pinnquad/outputs/output_schema.hpp"
#include "pinnquad/outputs/rotor_map.hpp"

namespace pinnquad {

/// Thrust (up, along -z) and torque about FRD x, y, z.
struct WrenchOutputs {
  static constexpr int size = 4;
  static constexpr std::array<const char*, size> names = {"thrust", "torque_x", "torque_y", "torque_z"};
  static constexpr std::array<const char*, size> units = {"N", "N m", "N m", "N m"};

  template <class Scalar>
  struct Body {
    detail::RotorMap<Scalar> map;
    AllocationMatrix<Scalar> by_fractions;
  };
  template <class Scalar>
  static constexpr Body<Scalar> prepare(const Airframe<Scalar>& airframe) noexcept {
    return {detail::wrench_map(airframe), allocation(airframe)};
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void commands(const Scalar*, const Scalar* y, const Body<Scalar>& body,
                                              Scalar* u) noexcept {
    body.map.commands(y, u);
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void slopes(const Scalar*, const Scalar* y, const Body<Scalar>& body,
                                            Scalar* by_outputs) noexcept {
    body.map.slopes(y, by_outputs, size);
  }
  template <class Scalar>
  static void from_commands(const Scalar*, const Scalar* u, const Body<Scalar>& body, Scalar* y) noexcept {
    ThrustFractions<Scalar> fractions{};
    body.map.fractions(u, fractions.data());
    const std::array<Scalar, 4> made = product(body.by_fractions, fractions);
    for (std::size_t k = 0; k < 4; ++k) y[k] = made[k];
  }
};

/// Specific force f = F / m and angular acceleration J^-1 tau that the rotors make, body frame FRD. Lateral force
/// cannot be commanded: f_x and f_y (0 for upright rotors) change no command.
struct AccelerationOutputs {
  static constexpr int size = 6;
  static constexpr std::array<const char*, size> names = {"f_x", "f_y", "f_z", "a_x", "a_y", "a_z"};
  static constexpr std::array<const char*, size> units = {"m/s^2", "m/s^2", "m/s^2", "rad/s^2", "rad/s^2", "rad/s^2"};

  template <class Scalar>
  struct Body {
    detail::RotorMap<Scalar> map;                            ///< of the outputs from f_z on
    std::array<std::array<Scalar, rotor_count>, 2> lateral;  ///< f_x, f_y of a thrust fraction 1
    AllocationMatrix<Scalar> by_fractions;                   ///< rows f along -z, a_x, a_y, a_z
  };
  template <class Scalar>
  static constexpr Body<Scalar> prepare(const Airframe<Scalar>& airframe) noexcept {
    Body<Scalar> body{detail::acceleration_map(airframe, Scalar(0)), {}, {}};
    const AllocationMatrix<Scalar> wrench = allocation(airframe);
    AllocationMatrix<Scalar> inverse{};
    static_cast<void>(
        invert_allocation(detail::mass_matrix(airframe), inverse));  // check_airframe() asks for a sound J
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
      const RotorMount<Scalar>& mount = airframe.rotors[rotor];
      const Scalar specific_thrust = mount.thrust_scale * airframe.max_rotor_thrust_N() / airframe.mass_kg;
      for (std::size_t axis = 0; axis < 2; ++axis) body.lateral[axis][rotor] = mount.axis[axis] * specific_thrust;
      for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t k = 0; k < 4; ++k) body.by_fractions[row][rotor] += inverse[row][k] * wrench[k][rotor];
      }
    }
    return body;
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void commands(const Scalar*, const Scalar* y, const Body<Scalar>& body,
                                              Scalar* u) noexcept {
    body.map.commands(y + 2, u);
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void slopes(const Scalar*, const Scalar* y, const Body<Scalar>& body,
                                            Scalar* by_outputs) noexcept {
    for (int i = 0; i < rotor_count; ++i) by_outputs[i * size] = by_outputs[i * size + 1] = Scalar(0);
    body.map.slopes(y + 2, by_outputs + 2, size);
  }
  template <class Scalar>
  static void from_commands(const Scalar*, const Scalar* u, const Body<Scalar>& body, Scalar* y) noexcept {
    ThrustFractions<Scalar> fractions{};
    body.map.fractions(u, fractions.data());
    const std::array<Scalar, 4> made = product(body.by_fractions, fractions);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      y[axis] = Scalar(0);
      for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) y[axis] += body.lateral[axis][rotor] * fractions[rotor];
    }
    y[2] = -made[0];
    for (std::size_t axis = 0; axis < 3; ++axis) y[3 + axis] = made[1 + axis];
  }
};

}  // namespace pinnquad
