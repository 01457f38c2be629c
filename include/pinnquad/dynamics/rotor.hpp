// SPDX-License-Identifier: MIT
// Eq. (2): command <-> rotor speed <-> thrust and torque, the allocation matrix with its inverse, and the rotor lag.
// The only place that knows the allocation's signs; loss, ellipse and controller ask for them here.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/status.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/dynamics/state.hpp"

namespace pinnquad {

/// The three rows of Eq. (2) that make torque.
struct Roll {
  static constexpr int axis = 0;
  static constexpr const char* name = "roll";
};
struct Pitch {
  static constexpr int axis = 1;
  static constexpr const char* name = "pitch";
};
struct Yaw {
  static constexpr int axis = 2;
  static constexpr const char* name = "yaw";
};

/// Row-major 4 x 4: (T, tau_x, tau_y, tau_z) = allocation * (u_1..u_4); a literal type.
template <class Scalar>
using AllocationMatrix = std::array<std::array<Scalar, rotor_count>, 4>;

/// Eq. (2) in commands at the rated density: rows thrust [N], roll, pitch and yaw torque [N m] at command 1.
/// A thrust T up at (x, y) makes the torque (-y T, x T); the reaction torque has the sign of `Spin`.
template <class Scalar>
constexpr AllocationMatrix<Scalar> allocation(const Airframe<Scalar>& airframe) noexcept {
  AllocationMatrix<Scalar> matrix{};
  const Scalar thrust = airframe.max_rotor_thrust_N();
  const Scalar torque = airframe.max_rotor_torque_N_m();
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const RotorMount<Scalar>& rotor = airframe.rotors[i];
    matrix[0][i] = thrust;
    matrix[1][i] = -rotor.y_m * thrust;
    matrix[2][i] = rotor.x_m * thrust;
    matrix[3][i] = Scalar(static_cast<int>(rotor.spin)) * torque;
  }
  return matrix;
}

/// Sign with which each command enters the torque about an axis (0 roll, 1 pitch, 2 yaw): the rows of Eq. (2).
template <class Scalar>
constexpr std::array<Scalar, rotor_count> allocation_signs(const Airframe<Scalar>& airframe, int axis) noexcept {
  const AllocationMatrix<Scalar> matrix = allocation(airframe);
  std::array<Scalar, rotor_count> signs{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const Scalar entry = matrix[static_cast<std::size_t>(axis) + 1][i];
    signs[i] = entry > Scalar(0) ? Scalar(1) : (entry < Scalar(0) ? Scalar(-1) : Scalar(0));
  }
  return signs;
}

/// Signed sum of motor commands about an axis, e.g. roll: -u1 + u2 + u3 - u4.
template <class Scalar>
constexpr Scalar signed_sum(const std::array<Scalar, rotor_count>& signs, const Commands<Scalar>& commands) noexcept {
  return signs[0] * commands[0] + signs[1] * commands[1] + signs[2] * commands[2] + signs[3] * commands[3];
}

/// m v.
template <class Scalar>
constexpr std::array<Scalar, 4> product(const AllocationMatrix<Scalar>& m, const std::array<Scalar, 4>& v) noexcept {
  std::array<Scalar, 4> result{};
  for (std::size_t row = 0; row < 4; ++row) {
    result[row] = m[row][0] * v[0] + m[row][1] * v[1] + m[row][2] * v[2] + m[row][3] * v[3];
  }
  return result;
}

/// Inverse of a 4 x 4 matrix by Gauss-Jordan with partial pivoting, rows scaled to a largest entry of 1. `no_solution` if it
/// is singular to the scalar's precision (a pivot below 1000 epsilon); the output stays untouched then.
template <class Scalar>
constexpr Status invert_allocation(AllocationMatrix<Scalar> matrix, AllocationMatrix<Scalar>& inverse) noexcept {
  AllocationMatrix<Scalar> result{};
  const auto magnitude = [](Scalar v) { return v < Scalar(0) ? -v : v; };
  for (std::size_t row = 0; row < 4; ++row) {
    Scalar largest(0);
    for (const Scalar entry : matrix[row]) largest = magnitude(entry) > largest ? magnitude(entry) : largest;
    if (!(largest > Scalar(0))) return Status::no_solution;
    for (Scalar& entry : matrix[row]) entry /= largest;
    result[row][row] = Scalar(1) / largest;
  }
  for (std::size_t column = 0; column < 4; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < 4; ++row) {
      if (magnitude(matrix[row][column]) > magnitude(matrix[pivot][column])) pivot = row;
    }
    if (!(magnitude(matrix[pivot][column]) > Scalar(1000) * std::numeric_limits<Scalar>::epsilon())) {
      return Status::no_solution;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const Scalar a = matrix[column][k];
      matrix[column][k] = matrix[pivot][k];
      matrix[pivot][k] = a;
      const Scalar b = result[column][k];
      result[column][k] = result[pivot][k];
      result[pivot][k] = b;
    }
    const Scalar scale = Scalar(1) / matrix[column][column];
    for (std::size_t k = 0; k < 4; ++k) {
      matrix[column][k] *= scale;
      result[column][k] *= scale;
    }
    for (std::size_t row = 0; row < 4; ++row) {
      if (row == column) continue;
      const Scalar factor = matrix[row][column];
      for (std::size_t k = 0; k < 4; ++k) {
        matrix[row][k] -= factor * matrix[column][k];
        result[row][k] -= factor * result[column][k];
      }
    }
  }
  inverse = result;
  return Status::ok;
}

/// Command of a rotor speed, u = (n / n_max)^2 (docs/paper.md, deviation 6).
template <class Scalar>
PINNQUAD_ALWAYS_INLINE constexpr Scalar command_from_speed(const Airframe<Scalar>& airframe,
                                                           Scalar speed_rev_s) noexcept {
  const Scalar ratio = speed_rev_s / airframe.max_rotor_speed_rev_s;
  return ratio * ratio;
}

/// Rotor speed of a command in 0..1, rev/s.
template <class Scalar>
Scalar speed_from_command(const Airframe<Scalar>& airframe, Scalar command) noexcept {
  using std::sqrt;
  return airframe.max_rotor_speed_rev_s * sqrt(command);
}

/// A rotor gives no less than nothing and no more than its limit. NaN stays NaN.
template <class Scalar>
constexpr Scalar clip_command(Scalar command) noexcept {
  return command < Scalar(0) ? Scalar(0) : (command > Scalar(1) ? Scalar(1) : command);
}

/// All four.
template <class Scalar>
constexpr Commands<Scalar> clipped(const Commands<Scalar>& commands) noexcept {
  return {clip_command(commands[0]), clip_command(commands[1]), clip_command(commands[2]), clip_command(commands[3])};
}

/// Eq. (2) ready to use: the four rotors as one actuator.
template <class Scalar>
class Rotors {
 public:
  /// An airframe whose allocation cannot be inverted leaves the inverse at zero; see status().
  constexpr explicit Rotors(const Airframe<Scalar>& airframe) noexcept
      : allocation_(allocation(airframe)), status_(invert_allocation(allocation_, inverse_)) {}

  constexpr Status status() const noexcept { return status_; }

  /// Body wrench of commands (not clipped) at a density ratio rho / rho_0: force (0, 0, -T) (docs/paper.md, deviation 2).
  Wrench<Scalar> wrench(const Commands<Scalar>& u, Scalar density_ratio) const noexcept {
    const std::array<Scalar, 4> w = product(allocation_, u);
    Wrench<Scalar> result;
    result.force_N = Vector3<Scalar>(Scalar(0), Scalar(0), -w[0] * density_ratio);
    result.torque_N_m = Vector3<Scalar>(w[1] * density_ratio, w[2] * density_ratio, w[3] * density_ratio);
    return result;
  }

  /// Thrust of each rotor, N, for commands (not clipped) at a density ratio.
  constexpr std::array<Scalar, rotor_count> thrusts(const Commands<Scalar>& u, Scalar density_ratio) const noexcept {
    std::array<Scalar, rotor_count> result{};
    for (std::size_t i = 0; i < rotor_count; ++i) result[i] = allocation_[0][i] * u[i] * density_ratio;
    return result;
  }

  /// Commands (not clipped) that make a thrust and a torque; the lateral force of a wrench can't be made and is ignored.
  Commands<Scalar> commands(const Wrench<Scalar>& wrench, Scalar density_ratio) const noexcept {
    const Scalar scale = Scalar(1) / density_ratio;
    return product(inverse_, {-wrench.force_N[2] * scale, wrench.torque_N_m[0] * scale, wrench.torque_N_m[1] * scale,
                              wrench.torque_N_m[2] * scale});
  }

 private:
  AllocationMatrix<Scalar> allocation_{};
  AllocationMatrix<Scalar> inverse_{};
  Status status_{Status::ok};
};

/// First-order lag of the thrust command, exact for a command held over a step: u_f <- a u_f + (1 - a) u,
/// a = exp(-dt / tau). A time constant of zero means no lag.
template <class Scalar>
Scalar lag_factor(Scalar time_constant_s, Scalar step_s) noexcept {
  using std::exp;
  return time_constant_s > Scalar(0) ? Scalar(exp(-step_s / time_constant_s)) : Scalar(0);
}

template <class Scalar>
constexpr Commands<Scalar> lagged(const Commands<Scalar>& filtered, const Commands<Scalar>& commands,
                                  Scalar factor) noexcept {
  Commands<Scalar> result{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const Scalar target = clip_command(commands[i]);
    result[i] = target + factor * (filtered[i] - target);
  }
  return result;
}

}  // namespace pinnquad
