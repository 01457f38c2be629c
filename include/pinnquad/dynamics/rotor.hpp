// SPDX-License-Identifier: MIT
// The four rotors as one actuator: commands <-> wrench.
#pragma once

#include <array>
#include <limits>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/status.hpp"
#include "pinnquad/dynamics/actuator.hpp"
#include "pinnquad/dynamics/allocation.hpp"
#include "pinnquad/dynamics/state.hpp"

namespace pinnquad {

/// Eq. (2) ready to use: the four rotors as one actuator. `scale` is by what thrust and torque differ from those at the
/// rated density and a full battery: rho / rho_0 times the surroundings' thrust scale (Quadrotor::rotor_scale).
template <class Scalar>
class Rotors {
 public:
  /// An airframe whose allocation cannot be inverted leaves the inverse at zero; see status().
  constexpr explicit Rotors(const Airframe<Scalar>& airframe) noexcept
      : allocation_(allocation(airframe)), status_(invert_allocation(allocation_, inverse_)) {
    for (std::size_t i = 0; i < rotor_count; ++i) {
      const RotorMount<Scalar>& rotor = airframe.rotors[i];
      curve_[i] = rotor.thrust_curve;
      most_thrust_N_[i] = rotor.thrust_scale * airframe.max_rotor_thrust_N();
      lateral_N_[0][i] = rotor.axis[0] * most_thrust_N_[i];
      lateral_N_[1][i] = rotor.axis[1] * most_thrust_N_[i];
      straight_ = straight_ && detail::equal(curve_[i], Scalar(0));
      upright_ = upright_ && is_upright(rotor);
    }
  }

  constexpr Outcome<Scalar> status() const noexcept { return status_; }

  /// Thrust fractions of settled commands (not clipped), and back.
  template <bool plain = false>
  PINNQUAD_ALWAYS_INLINE constexpr ThrustFractions<Scalar> fractions(const Commands<Scalar>& u) const noexcept {
    if (plain || all_of(straight_)) return u;
    ThrustFractions<Scalar> result{};
    for (std::size_t i = 0; i < rotor_count; ++i) result[i] = select(straight_, u[i], thrust_fraction(curve_[i], u[i]));
    return result;
  }
  template <bool plain = false>
  PINNQUAD_ALWAYS_INLINE Commands<Scalar> commands_of(const ThrustFractions<Scalar>& fractions) const noexcept {
    if (plain || all_of(straight_)) return fractions;
    Commands<Scalar> result{};
    for (std::size_t i = 0; i < rotor_count; ++i) result[i] = command_of_fraction(curve_[i], fractions[i]);
    return result;
  }

  /// Body wrench of thrust fractions (not clipped): force (F_x, F_y, -T), with no lateral force from upright rotors
  /// (docs/paper.md, deviation 2).
  template <bool plain = false>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench_of(const ThrustFractions<Scalar>& s, Scalar scale) const noexcept {
    const std::array<Scalar, 4> w = product(allocation_, s);
    Wrench<Scalar> result;
    result.force_N = Vector3<Scalar>(Scalar(0), Scalar(0), -w[0] * scale);
    result.torque_N_m = Vector3<Scalar>(w[1] * scale, w[2] * scale, w[3] * scale);
    if (!plain && !all_of(upright_)) {
      for (std::size_t i = 0; i < rotor_count; ++i) {
        for (int axis = 0; axis < 2; ++axis) {
          const Scalar& before = result.force_N[axis];
          const Scalar lateral = lateral_N_[static_cast<std::size_t>(axis)][i] * s[i] * scale;
          result.force_N[axis] = select(upright_, before, Scalar(before + lateral));
        }
      }
    }
    return result;
  }
  /// Wrench of commands.
  Wrench<Scalar> wrench(const Commands<Scalar>& u, Scalar scale) const noexcept {
    return wrench_of(fractions(u), scale);
  }

  /// Thrust of each rotor along its axis, N, for thrust fractions (not clipped).
  constexpr std::array<Scalar, rotor_count> thrusts_of(const ThrustFractions<Scalar>& s, Scalar scale) const noexcept {
    std::array<Scalar, rotor_count> result{};
    for (std::size_t i = 0; i < rotor_count; ++i) result[i] = most_thrust_N_[i] * s[i] * scale;
    return result;
  }

  /// Thrust fractions (not clipped) that make a thrust and a torque; the lateral force of a wrench can't be commanded
  /// and is ignored.
  ThrustFractions<Scalar> fractions_for(const Wrench<Scalar>& wrench, Scalar scale) const noexcept {
    const Scalar inverse_scale = Scalar(1) / scale;
    return product(inverse_, {-wrench.force_N[2] * inverse_scale, wrench.torque_N_m[0] * inverse_scale,
                              wrench.torque_N_m[1] * inverse_scale, wrench.torque_N_m[2] * inverse_scale});
  }
  /// The commands of these.
  Commands<Scalar> commands(const Wrench<Scalar>& wrench, Scalar scale) const noexcept {
    return commands_of(fractions_for(wrench, scale));
  }

  /// Thrust fractions that make one newton along -z and no torque.
  constexpr ThrustFractions<Scalar> fractions_of_pure_thrust_1_N() const noexcept {
    return {inverse_[0][0], inverse_[1][0], inverse_[2][0], inverse_[3][0]};
  }

  /// True where equal thrust fractions make thrust and no torque, to rounding: rotors of equal strength that lie
  /// symmetric about the centre of gravity.
  constexpr bool balanced() const noexcept {
    constexpr Scalar rounding = Scalar(5000) * std::numeric_limits<Scalar>::epsilon();
    const ThrustFractions<Scalar> along = fractions_of_pure_thrust_1_N();
    for (const Scalar fraction : along) {
      const Scalar difference = fraction - along[0];
      if (!((difference < Scalar(0) ? -difference : difference) <= rounding * along[0])) return false;
    }
    return true;
  }

  /// True where a command is its thrust fraction: no rotor has a curve.
  constexpr Mask<Scalar> straight() const noexcept { return straight_; }

 private:
  AllocationMatrix<Scalar> allocation_{};
  AllocationMatrix<Scalar> inverse_{};
  Outcome<Scalar> status_{Status::ok};
  std::array<Scalar, rotor_count> curve_{};
  std::array<Scalar, rotor_count> most_thrust_N_{};
  std::array<std::array<Scalar, rotor_count>, 2> lateral_N_{};  ///< rows F_x, F_y
  Mask<Scalar> straight_{true};
  Mask<Scalar> upright_{true};
};

}  // namespace pinnquad
