// SPDX-License-Identifier: MIT
// Eq. (2): command <-> rotor speed <-> thrust and torque, the allocation matrix with its inverse.
// The only place that knows the allocation's signs; loss, ellipse and controller ask for them here.
#pragma once

#include <array>
#include <limits>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/first_of.hpp"
#include "pinnquad/core/scalar_math.hpp"
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

/// Thrust of each rotor over its thrust at command 1, in the air and at the battery of the moment. A command is one where
/// all curves are straight (RotorMount::thrust_curve 0).
template <class Scalar>
using ThrustFractions = std::array<Scalar, rotor_count>;

/// Row-major 4 x 4: (T, tau_x, tau_y, tau_z) = allocation * (s_1..s_4), s the thrust fractions; a literal type.
template <class Scalar>
using AllocationMatrix = std::array<std::array<Scalar, rotor_count>, 4>;

namespace detail {
/// The torque at thrust fraction 1 of a rotor anywhere: r x t a - spin q a, with thrust t, reaction torque q and axis a.
template <class Scalar>
constexpr std::array<Scalar, 3> rotor_torque_N_m(const RotorMount<Scalar>& r, Scalar thrust, Scalar torque) noexcept {
  const Scalar x = thrust * r.axis[0], y = thrust * r.axis[1], z = thrust * r.axis[2];
  const Scalar reaction = -Scalar(static_cast<int>(r.spin)) * torque;
  return {r.y_m * z - r.z_m * y + reaction * r.axis[0], r.z_m * x - r.x_m * z + reaction * r.axis[1],
          r.x_m * y - r.y_m * x + reaction * r.axis[2]};
}
}  // namespace detail

/// Eq. (2) in thrust fractions at the rated density: rows thrust along -z [N], roll, pitch and yaw torque [N m] at fraction 1.
/// A thrust T up at (x, y) makes the torque (-y T, x T); the reaction torque has the sign of `Spin`. Of a tilted rotor this
/// is all but its lateral force, see Rotors::wrench().
template <class Scalar>
constexpr AllocationMatrix<Scalar> allocation(const Airframe<Scalar>& airframe) noexcept {
  AllocationMatrix<Scalar> matrix{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const RotorMount<Scalar>& rotor = airframe.rotors[i];
    const Scalar thrust = rotor.thrust_scale * airframe.max_rotor_thrust_N();
    const Scalar torque = rotor.thrust_scale * airframe.max_rotor_torque_N_m();
    if (is_upright(rotor)) {
      matrix[0][i] = thrust;
      matrix[1][i] = -rotor.y_m * thrust;
      matrix[2][i] = rotor.x_m * thrust;
      matrix[3][i] = Scalar(static_cast<int>(rotor.spin)) * torque;
    } else {
      matrix[0][i] = -rotor.axis[2] * thrust;
      const std::array<Scalar, 3> turning = detail::rotor_torque_N_m(rotor, thrust, torque);
      for (std::size_t axis = 0; axis < 3; ++axis) matrix[axis + 1][i] = turning[axis];
    }
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

namespace detail {
template <class Scalar>
PINNQUAD_ALWAYS_INLINE const RotorMount<Scalar>& rotor_of(const Airframe<Scalar>& airframe,
                                                          std::size_t rotor) noexcept {
  return first_of<RotorMount<Scalar>>(airframe.rotors)[rotor];
}
}  // namespace detail

/// Command of a rotor speed where thrust is proportional to the command, u = (n / n_max)^2 (docs/paper.md, deviation 6): the
/// thrust fraction of a speed, of any rotor.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE constexpr Scalar command_from_speed(const Airframe<Scalar>& airframe,
                                                           Scalar speed_rev_s) noexcept {
  const Scalar ratio = speed_rev_s / airframe.max_rotor_speed_rev_s;
  return ratio * ratio;
}

/// Rotor speed of a command in 0..1 where thrust is proportional to it, rev/s.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar speed_from_command(const Airframe<Scalar>& airframe, Scalar command) noexcept {
  return airframe.max_rotor_speed_rev_s * detail::square_root(command);
}

/// The same of one rotor by its own curve: the command of a speed, which has the speed's sign ...
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar command_from_speed(const Airframe<Scalar>& airframe, std::size_t rotor,
                                                 Scalar speed_rev_s) noexcept {
  const Scalar fraction = command_from_speed(airframe, speed_rev_s);
  return command_of_fraction(detail::rotor_of(airframe, rotor).thrust_curve,
                             speed_rev_s < Scalar(0) ? -fraction : fraction);
}

/// ... its slope: du/dn = 2 r / (n_max sqrt((1 - k)^2 + 4 k r^2)) with r = |n| / n_max; 1 / n_max everywhere for k = 1 ...
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar command_slope_of_speed(const Airframe<Scalar>& airframe, std::size_t rotor,
                                                     Scalar speed_rev_s) noexcept {
  const Scalar curve = detail::rotor_of(airframe, rotor).thrust_curve;
  const Scalar n_max = airframe.max_rotor_speed_rev_s;
  const Scalar magnitude = speed_rev_s < Scalar(0) ? -speed_rev_s : speed_rev_s;
  const Scalar straight = Scalar(2) * magnitude / (n_max * n_max);
  if (detail::equal(curve, Scalar(0))) return straight;
  const Scalar ratio = magnitude / n_max, linear = Scalar(1) - curve;
  const Scalar bend = detail::square_root(linear * linear + Scalar(4) * curve * (ratio * ratio));
  return detail::equal(bend, Scalar(0)) ? Scalar(1) / n_max : straight / bend;  // 0 / 0 at k = 1, n = 0; NaN stays NaN
}

/// ... and the speed of a command in 0..1, rev/s.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar speed_from_command(const Airframe<Scalar>& airframe, std::size_t rotor,
                                                 Scalar command) noexcept {
  return speed_from_command(airframe, thrust_fraction(detail::rotor_of(airframe, rotor).thrust_curve, command));
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

/// Eq. (2) ready to use: the four rotors as one actuator. `scale` is by what thrust and torque differ from those at the rated
/// density and a full battery: rho / rho_0 times the surroundings' thrust scale (Quadrotor::rotor_scale).
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

  constexpr Status status() const noexcept { return status_; }

  /// Thrust fractions of settled commands (not clipped), and back.
  template <Build build = Build::any>
  PINNQUAD_ALWAYS_INLINE constexpr ThrustFractions<Scalar> fractions(const Commands<Scalar>& u) const noexcept {
    if (build == Build::plain || straight_) return u;
    ThrustFractions<Scalar> result{};
    for (std::size_t i = 0; i < rotor_count; ++i) result[i] = thrust_fraction(curve_[i], u[i]);
    return result;
  }
  template <Build build = Build::any>
  PINNQUAD_ALWAYS_INLINE Commands<Scalar> commands_of(const ThrustFractions<Scalar>& fractions) const noexcept {
    if (build == Build::plain || straight_) return fractions;
    Commands<Scalar> result{};
    for (std::size_t i = 0; i < rotor_count; ++i) result[i] = command_of_fraction(curve_[i], fractions[i]);
    return result;
  }

  /// Body wrench of thrust fractions (not clipped): force (F_x, F_y, -T), with no lateral force from upright rotors
  /// (docs/paper.md, deviation 2).
  template <Build build = Build::any>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench_of(const ThrustFractions<Scalar>& s, Scalar scale) const noexcept {
    const std::array<Scalar, 4> w = product(allocation_, s);
    Wrench<Scalar> result;
    result.force_N = Vector3<Scalar>(Scalar(0), Scalar(0), -w[0] * scale);
    result.torque_N_m = Vector3<Scalar>(w[1] * scale, w[2] * scale, w[3] * scale);
    if (build != Build::plain && !upright_) {
      for (std::size_t i = 0; i < rotor_count; ++i) {
        result.force_N[0] += lateral_N_[0][i] * s[i] * scale;
        result.force_N[1] += lateral_N_[1][i] * s[i] * scale;
      }
    }
    return result;
  }
  /// The same of commands.
  Wrench<Scalar> wrench(const Commands<Scalar>& u, Scalar scale) const noexcept {
    return wrench_of(fractions(u), scale);
  }

  /// Thrust of each rotor along its axis, N, for thrust fractions (not clipped).
  constexpr std::array<Scalar, rotor_count> thrusts_of(const ThrustFractions<Scalar>& s, Scalar scale) const noexcept {
    std::array<Scalar, rotor_count> result{};
    for (std::size_t i = 0; i < rotor_count; ++i) result[i] = most_thrust_N_[i] * s[i] * scale;
    return result;
  }

  /// Thrust fractions (not clipped) that make a thrust and a torque; the lateral force of a wrench can't be commanded and is
  /// ignored.
  ThrustFractions<Scalar> fractions_for(const Wrench<Scalar>& wrench, Scalar scale) const noexcept {
    const Scalar inverse_scale = Scalar(1) / scale;
    return product(inverse_, {-wrench.force_N[2] * inverse_scale, wrench.torque_N_m[0] * inverse_scale,
                              wrench.torque_N_m[1] * inverse_scale, wrench.torque_N_m[2] * inverse_scale});
  }
  /// The commands of these.
  Commands<Scalar> commands(const Wrench<Scalar>& wrench, Scalar scale) const noexcept {
    return commands_of(fractions_for(wrench, scale));
  }

  /// du/dw of commands() about the commands u: w = (thrust along -z, tau_x, tau_y, tau_z), rows in the order of the commands.
  /// Infinite for a rotor with the curve k = 1 at u = 0, as the square root's slope is.
  constexpr AllocationMatrix<Scalar> command_slopes(const Commands<Scalar>& u, Scalar scale) const noexcept {
    AllocationMatrix<Scalar> result{};
    for (std::size_t i = 0; i < rotor_count; ++i) {
      const Scalar divisor = scale * thrust_fraction_slope(curve_[i], u[i]);
      for (std::size_t k = 0; k < 4; ++k) result[i][k] = inverse_[i][k] / divisor;
    }
    return result;
  }

  /// Thrust fractions that make one newton along -z and no torque.
  constexpr ThrustFractions<Scalar> fractions_of_pure_thrust_1_N() const noexcept {
    return {inverse_[0][0], inverse_[1][0], inverse_[2][0], inverse_[3][0]};
  }

  /// True where equal thrust fractions make thrust and no torque, to rounding: rotors of equal strength that lie symmetric about
  /// the centre of gravity.
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
  constexpr bool straight() const noexcept { return straight_; }

 private:
  AllocationMatrix<Scalar> allocation_{};
  AllocationMatrix<Scalar> inverse_{};
  Status status_{Status::ok};
  std::array<Scalar, rotor_count> curve_{};
  std::array<Scalar, rotor_count> most_thrust_N_{};
  std::array<std::array<Scalar, rotor_count>, 2> lateral_N_{};  ///< rows F_x, F_y
  bool straight_{true};
  bool upright_{true};
};

}  // namespace pinnquad
