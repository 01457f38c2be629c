// SPDX-License-Identifier: MIT
// Outputs that are added to the commands of a base, the base of Eq. (3), and that base's slopes in hover, with which a
// model's are compared, or to which they are pinned.
#pragma once

#include <array>

#include "pinnquad/core/first_of.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/outputs/base.hpp"
#include "pinnquad/outputs/output_schema.hpp"
#include "pinnquad/outputs/rotor_map.hpp"

namespace pinnquad {

/// Eq. (3) inverted ("Model 1" of Table 2), of PaperFeatures and what begins as they do, in air of the rated density:
/// thrust from v_dot_z, torques from omega_dot, nothing else.
struct LinearizedBase {
  static constexpr const char* description = "pinnquad::LinearizedInverse";
  static constexpr std::array<ReadFeature, 4> reads = {
      {{2, "vdot_bz", "m/s^2"}, {3, "wdot_x", "rad/s^2"}, {4, "wdot_y", "rad/s^2"}, {5, "wdot_z", "rad/s^2"}}};

  template <class Scalar>
  static constexpr detail::RotorMap<Scalar> prepare(const Airframe<Scalar>& airframe) noexcept {
    return detail::acceleration_map(airframe, standard_gravity_m_s2<Scalar>);
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void commands(const Scalar* x, const detail::RotorMap<Scalar>& map,
                                              Scalar* u) noexcept {
    map.commands(x + 2, u);  // v_dot_z, omega_dot
  }
  template <int FeatureCount, class Scalar>
  static PINNQUAD_ALWAYS_INLINE void slopes(const Scalar* x, const detail::RotorMap<Scalar>& map,
                                            Scalar* by_x) noexcept {
    static_assert(FeatureCount >= 6, "pinnquad: LinearizedBase needs the accelerations as the first six features");
    map.slopes(x + 2, by_x + 2, FeatureCount);
  }
};

/// u = base(x) + y, in units of commands.
template <class BaseType>
struct ResidualOutputs {
  static_assert(is_base<BaseType>,
                "pinnquad: a base has `reads`, prepare(), commands() and slopes(), static and noexcept "
                "(outputs/base.hpp)");
  using Base = BaseType;  ///< named by its description in headers and blocks
  static constexpr int size = rotor_count;
  static constexpr std::array<const char*, size> names = {"du1", "du2", "du3", "du4"};
  static constexpr std::array<const char*, size> units = {"1", "1", "1", "1"};
  static constexpr bool linear = true;

  template <class Scalar>
  static constexpr auto prepare(const Airframe<Scalar>& airframe) noexcept {
    return Base::prepare(airframe);
  }
  template <class Scalar, class Setting>
  static PINNQUAD_ALWAYS_INLINE void commands(const Scalar* x, const Scalar* y, const Setting& setting,
                                              Scalar* u) noexcept {
    Base::commands(x, setting, u);
    for (int i = 0; i < size; ++i) u[i] += y[i];
  }
  template <class Scalar, class Setting>
  static void from_commands(const Scalar* x, const Scalar* u, const Setting& setting, Scalar* y) noexcept {
    Scalar base[rotor_count];
    Base::commands(x, setting, static_cast<Scalar*>(base));
    for (int i = 0; i < size; ++i) y[i] = u[i] - base[i];
  }
  template <int FeatureCount, class Scalar, class Setting>
  static PINNQUAD_ALWAYS_INLINE void feature_slopes(const Scalar* x, const Scalar*, const Setting& setting,
                                                    Scalar* by_x) noexcept {
    Base::template slopes<FeatureCount>(x, setting, by_x);
  }
};

/// d(signed sum)/d(angular acceleration) about roll, pitch, yaw, s^2/rad.
using AxisSlopes = std::array<double, 3>;

namespace detail {

/// d(command)/d(feature) of Eq. (3) in hover, rotor by rotor: of the first six of PaperFeatures.
inline std::array<std::array<double, 6>, rotor_count> hover_map(const Airframe<double>& airframe) noexcept {
  std::array<std::array<double, 6>, rotor_count> by_x{};
  const double hovering[6] = {};
  LinearizedBase::slopes<6>(static_cast<const double*>(hovering), LinearizedBase::prepare(airframe),
                            first_of<double>(by_x));
  return by_x;
}

}  // namespace detail

/// The airframe's own in hover, by Eq. (3).
inline AxisSlopes hover_slopes(const Airframe<double>& airframe) noexcept {
  const auto map = detail::hover_map(airframe);
  AxisSlopes slopes{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto signs = allocation_signs(airframe, static_cast<int>(axis));
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
      slopes[axis] += signs[rotor] * map[rotor][3 + axis];
    }
  }
  return slopes;
}

/// d(sum of the commands)/d(specific force asked along the thrust axis) in hover, s^2/m.
inline double hover_thrust_slope(const Airframe<double>& airframe) noexcept {
  const auto map = detail::hover_map(airframe);
  double slope = 0;
  for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) slope -= map[rotor][2];
  return slope;
}

}  // namespace pinnquad
