// SPDX-License-Identifier: MIT
// Eq. (2): thrust fractions of the rotors <-> thrust and three torques; the 4 x 4 matrix and its inverse.
// Only this file knows the allocation's signs; loss, ellipse and controller ask for them here.
#pragma once

#include <array>
#include <limits>

#include "pinnquad/core/status.hpp"
#include "pinnquad/dynamics/airframe.hpp"

namespace pinnquad {

/// Row of the torque about x in Eq. (2): its axis and its name.
struct Roll {
  static constexpr int axis = 0;
  static constexpr const char* name = "roll";
};
/// Row of the torque about y.
struct Pitch {
  static constexpr int axis = 1;
  static constexpr const char* name = "pitch";
};
/// Row of the torque about z.
struct Yaw {
  static constexpr int axis = 2;
  static constexpr const char* name = "yaw";
};

/// Row-major 4 x 4: (T, tau_x, tau_y, tau_z) = allocation * (s_1..s_4), s the thrust fractions; a literal type.
template <class Scalar>
using AllocationMatrix = std::array<std::array<Scalar, rotor_count>, 4>;

namespace detail {
/// The torque of a rotor anywhere at thrust fraction 1: r x t a - spin q a, thrust t, reaction torque q, axis a.
template <class Scalar>
constexpr std::array<Scalar, 3> rotor_torque_N_m(const RotorMount<Scalar>& r, Scalar thrust, Scalar torque) noexcept {
  const Scalar x = thrust * r.axis[0], y = thrust * r.axis[1], z = thrust * r.axis[2];
  const Scalar reaction = -Scalar(static_cast<int>(r.spin)) * torque;
  return {r.y_m * z - r.z_m * y + reaction * r.axis[0], r.z_m * x - r.x_m * z + reaction * r.axis[1],
          r.x_m * y - r.y_m * x + reaction * r.axis[2]};
}
}  // namespace detail

/// Eq. (2) in thrust fractions at the rated density: rows thrust along -z [N], roll, pitch and yaw torque [N m] at
/// fraction 1. A thrust T up at (x, y) makes the torque (-y T, x T); the reaction torque has the sign of `Spin`. Of a
/// tilted rotor this is all but its lateral force, see Rotors::wrench().
template <class Scalar>
constexpr AllocationMatrix<Scalar> allocation(const Airframe<Scalar>& airframe) noexcept {
  AllocationMatrix<Scalar> matrix{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const RotorMount<Scalar>& rotor = airframe.rotors[i];
    const Scalar thrust = rotor.thrust_scale * airframe.max_rotor_thrust_N();
    const Scalar torque = rotor.thrust_scale * airframe.max_rotor_torque_N_m();
    const Mask<Scalar> upright = is_upright(rotor);
    const std::array<Scalar, 3> tilted = detail::rotor_torque_N_m(rotor, thrust, torque);
    matrix[0][i] = select(upright, thrust, Scalar(-rotor.axis[2] * thrust));
    matrix[1][i] = select(upright, Scalar(-rotor.y_m * thrust), tilted[0]);
    matrix[2][i] = select(upright, Scalar(rotor.x_m * thrust), tilted[1]);
    matrix[3][i] = select(upright, Scalar(Scalar(static_cast<int>(rotor.spin)) * torque), tilted[2]);
  }
  return matrix;
}

/// The sign of each command in the torque about an axis (0 roll, 1 pitch, 2 yaw): the rows of Eq. (2).
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

/// Those about roll, pitch and yaw.
template <class Scalar>
constexpr std::array<std::array<Scalar, rotor_count>, 3> axis_signs(const Airframe<Scalar>& airframe) noexcept {
  return {allocation_signs(airframe, 0), allocation_signs(airframe, 1), allocation_signs(airframe, 2)};
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

/// Inverse of a 4 x 4 matrix by Gauss-Jordan with partial pivoting, rows scaled to a largest entry of 1. `no_solution`
/// if it is singular to the scalar's precision (a pivot below 1000 epsilon); the output stays untouched then.
template <class Scalar>
constexpr Outcome<Scalar> invert_allocation(const AllocationMatrix<Scalar>& matrix,
                                            AllocationMatrix<Scalar>& inverse) noexcept {
  std::array<std::array<Scalar, 8>, 4> rows{};  // the matrix, and beside it the identity, which becomes the inverse
  const auto magnitude = [](Scalar v) { return select(v < Scalar(0), Scalar(-v), v); };
  Mask<Scalar> regular(true);
  for (std::size_t row = 0; row < 4; ++row) {
    Scalar largest(0);
    for (const Scalar& entry : matrix[row]) largest = select(magnitude(entry) > largest, magnitude(entry), largest);
    regular = regular && largest > Scalar(0);
    if (!any_of(regular)) return Status::no_solution;
    for (std::size_t k = 0; k < 4; ++k) rows[row][k] = matrix[row][k] / largest;
    rows[row][row + 4] = Scalar(1) / largest;
  }
  for (std::size_t column = 0; column < 4; ++column) {
    Scalar largest = magnitude(rows[column][column]);
    for (std::size_t row = column + 1; row < 4; ++row) {
      const Scalar next = magnitude(rows[row][column]);
      largest = select(next > largest, next, largest);
    }
    regular = regular && largest > Scalar(1000) * Scalar(std::numeric_limits<Scalar>::epsilon());
    if (!any_of(regular)) return Status::no_solution;
    Mask<Scalar> sought = magnitude(rows[column][column]) < largest;  // the first of the largest changes places
    for (std::size_t row = column + 1; row < 4; ++row) {
      const Mask<Scalar> pivot = sought && magnitude(rows[row][column]) >= largest;
      for (std::size_t k = 0; k < 8; ++k) {
        const Scalar above = rows[column][k], below = rows[row][k];
        rows[column][k] = select(pivot, below, above);
        rows[row][k] = select(pivot, above, below);
      }
      sought = sought && !pivot;
    }
    const Scalar scale = Scalar(1) / rows[column][column];
    for (Scalar& entry : rows[column]) entry *= scale;
    for (std::size_t row = 0; row < 4; ++row) {
      if (row == column) continue;
      const Scalar factor = rows[row][column];
      for (std::size_t k = 0; k < 8; ++k) rows[row][k] -= factor * rows[column][k];
    }
  }
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t k = 0; k < 4; ++k) inverse[row][k] = select(regular, rows[row][k + 4], inverse[row][k]);
  }
  return select(regular, Status::ok, Status::no_solution);
}

}  // namespace pinnquad
