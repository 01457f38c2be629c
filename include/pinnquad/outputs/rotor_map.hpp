// SPDX-License-Identifier: MIT
// Eq. (2) inverted: four numbers that the rotors make together -> commands. Plain arrays that the compiler works out,
// and no function that could be emitted out of line: an object compiled for another instruction set holds no copy.
#pragma once

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Thrust fractions s = A v + b; the command of each rotor follows from its curve. Air of the rated density, a full
/// battery.
template <class Scalar>
struct RotorMap {
  Scalar by[rotor_count][4]{};    ///< A
  Scalar at_zero[rotor_count]{};  ///< b
  Scalar curve[rotor_count]{};

  PINNQUAD_ALWAYS_INLINE void commands(const Scalar* v, Scalar* u) const noexcept {
    for (int i = 0; i < rotor_count; ++i) {
      const Scalar fraction = by[i][0] * v[0] + by[i][1] * v[1] + by[i][2] * v[2] + by[i][3] * v[3] + at_zero[i];
      u[i] = command_of_fraction(curve[i], fraction);
    }
  }
  /// du/dv, 4 x 4 of a matrix with `stride` columns. Infinite for a rotor with the curve k = 1 at u = 0.
  PINNQUAD_ALWAYS_INLINE void slopes(const Scalar* v, Scalar* by_v, int stride) const noexcept {
    Scalar u[rotor_count];
    commands(v, u);
    for (int i = 0; i < rotor_count; ++i) {
      const Scalar divisor = thrust_fraction_slope(curve[i], u[i]);
      for (int k = 0; k < 4; ++k) by_v[i * stride + k] = by[i][k] / divisor;
    }
  }
  /// Thrust fractions of commands.
  PINNQUAD_ALWAYS_INLINE void fractions(const Scalar* u, Scalar* s) const noexcept {
    for (int i = 0; i < rotor_count; ++i) s[i] = thrust_fraction(curve[i], u[i]);
  }
};

/// Map of v = (thrust along -z, torque about x, y, z).
template <class Scalar>
constexpr RotorMap<Scalar> wrench_map(const Airframe<Scalar>& airframe) noexcept {
  RotorMap<Scalar> map{};
  AllocationMatrix<Scalar> inverse{};
  static_cast<void>(invert_allocation(allocation(airframe), inverse));  // airframe_value() refuses what has none
  for (std::size_t i = 0; i < rotor_count; ++i) {
    for (std::size_t k = 0; k < 4; ++k) map.by[i][k] = inverse[i][k];
    map.curve[i] = airframe.rotors[i].thrust_curve;
  }
  return map;
}

/// (m, J) as a matrix: (thrust along -z, torque) of (specific force along -z, angular acceleration).
template <class Scalar>
constexpr AllocationMatrix<Scalar> mass_matrix(const Airframe<Scalar>& airframe) noexcept {
  const auto& [x, y, z] = airframe.inertia_kg_m2;
  const auto& [xy, xz, yz] = airframe.inertia_products_kg_m2;
  const Scalar none(0);
  return {{{airframe.mass_kg, none, none, none}, {none, x, xy, xz}, {none, xy, y, yz}, {none, xz, yz, z}}};
}

/// Map of v = (acceleration along z, less `gravity_m_s2`: T = m (g - v_0); angular acceleration).
template <class Scalar>
constexpr RotorMap<Scalar> acceleration_map(const Airframe<Scalar>& airframe, Scalar gravity_m_s2) noexcept {
  RotorMap<Scalar> map = wrench_map(airframe);
  const AllocationMatrix<Scalar> mass = mass_matrix(airframe);
  for (std::size_t i = 0; i < rotor_count; ++i) {
    Scalar row[4] = {};
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t j = 0; j < 4; ++j) row[k] += map.by[i][j] * mass[j][k];
    }
    map.at_zero[i] = row[0] * gravity_m_s2;
    for (std::size_t k = 0; k < 4; ++k) map.by[i][k] = k == 0 ? -row[k] : row[k];
  }
  return map;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
