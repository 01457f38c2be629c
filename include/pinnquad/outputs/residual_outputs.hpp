// SPDX-License-Identifier: MIT
// Outputs that are added to what another inverse says: the network learns what that one leaves.
// Contract of a Base, static and noexcept, Scalar deduced: `reads`, which features of X it reads (features/read_features.hpp);
// `prepare(airframe)`, constexpr; commands(x, prepared, u) of features in physical units;
// `slopes<FeatureCount>(x, prepared, by_x)` = du/dx, rotor_count x FeatureCount, row-major, into zeros;
// optional `least_thrust_slope(airframe)`, which a certificate asks (outputs/rigid_body_base.hpp).
#pragma once

#include "pinnquad/features/features.hpp"
#include "pinnquad/features/read_features.hpp"
#include "pinnquad/outputs/output_schema.hpp"
#include "pinnquad/outputs/rotor_map.hpp"

namespace pinnquad {

/// Eq. (3) inverted ("Model 1" of Table 2), of PaperFeatures and what begins as they do, in air of the rated density: thrust
/// from v_dot_z, torques from omega_dot, nothing else.
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

/// commands = base(x) + outputs.
template <class BaseInverse>
struct ResidualOutputs {
  static_assert(detail::SaysWhatItReads<BaseInverse>::value,
                "pinnquad: a base says which features it reads, by name: `reads` (outputs/residual_outputs.hpp)");
  using Base = BaseInverse;  ///< what the outputs add to; a header and a block name it by its description
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

}  // namespace pinnquad
