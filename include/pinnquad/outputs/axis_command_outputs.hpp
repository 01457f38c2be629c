// SPDX-License-Identifier: MIT
// Outputs as axis commands: the rows of Eq. (2) with their signs alone, which are the sum of all commands (collective)
// and the signed sums about roll, pitch and yaw, as LocalMonotonicity compares them. u = A y, A the inverse of the
// signs, +-1/4 for an X. Where each axis command follows its own angular acceleration and no other one, so does each
// rotor's command.
#pragma once

#include <array>
#include <limits>
#include <type_traits>

#include "pinnquad/outputs/base.hpp"
#include "pinnquad/outputs/output_schema.hpp"

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// The signs, row by row, and their inverse. Plain arrays, as in detail::RotorMap.
template <class Scalar>
struct SignedMix {
  Scalar signs[4][rotor_count]{};  ///< rows: 1 of each rotor, then of roll, pitch, yaw
  Scalar by[rotor_count][4]{};     ///< A
};

/// NaN for a vehicle whose signs do not distinguish the axes: no guard lets its commands pass.
template <class Scalar>
constexpr SignedMix<Scalar> signed_mix(const Airframe<Scalar>& airframe) noexcept {
  AllocationMatrix<Scalar> signs{}, inverse{};
  signs[0] = {Scalar(1), Scalar(1), Scalar(1), Scalar(1)};
  for (std::size_t axis = 0; axis < 3; ++axis) signs[1 + axis] = allocation_signs(airframe, static_cast<int>(axis));
  const bool solved = invert_allocation(signs, inverse) == Status::ok;
  SignedMix<Scalar> mix{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      mix.signs[k][i] = signs[k][i];
      mix.by[i][k] = solved ? inverse[i][k] : std::numeric_limits<Scalar>::quiet_NaN();
    }
  }
  return mix;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

/// y = (u_1 + u_2 + u_3 + u_4, signed sums about roll, pitch, yaw), in units of commands.
struct AxisCommandOutputs {
  static constexpr int size = 4;
  static constexpr bool takes_features = false;
  static constexpr std::array<const char*, size> names = {"sum", "roll_sum", "pitch_sum", "yaw_sum"};
  static constexpr std::array<const char*, size> units = {"1", "1", "1", "1"};

  template <class Scalar>
  static constexpr detail::SignedMix<Scalar> prepare(const Airframe<Scalar>& airframe) noexcept {
    return detail::signed_mix(airframe);
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void commands(const Scalar*, const Scalar* y, const detail::SignedMix<Scalar>& mix,
                                              Scalar* u) noexcept {
    for (int i = 0; i < rotor_count; ++i) {
      u[i] = mix.by[i][0] * y[0] + mix.by[i][1] * y[1] + mix.by[i][2] * y[2] + mix.by[i][3] * y[3];
    }
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void slopes(const Scalar*, const Scalar*, const detail::SignedMix<Scalar>& mix,
                                            Scalar* by_outputs) noexcept {
    for (int i = 0; i < rotor_count; ++i) {
      for (int k = 0; k < size; ++k) by_outputs[i * size + k] = mix.by[i][k];
    }
  }
  template <class Scalar>
  static void from_commands(const Scalar*, const Scalar* u, const detail::SignedMix<Scalar>& mix, Scalar* y) noexcept {
    for (int k = 0; k < size; ++k) {
      y[k] = mix.signs[k][0] * u[0] + mix.signs[k][1] * u[1] + mix.signs[k][2] * u[2] + mix.signs[k][3] * u[3];
    }
  }
};

/// u = base(x) + A y. The base (outputs/base.hpp) reads no angular acceleration: the slope by it is the model's own.
template <class BaseType>
struct SignedSumsOn {
  static_assert(is_base<BaseType>,
                "pinnquad: a base has `reads`, prepare(), commands() and slopes(), static and noexcept "
                "(outputs/base.hpp)");
  static_assert(!detail::reads_angular_acceleration<BaseType>(),
                "pinnquad: SignedSumsOn needs a base that is not shown the angular acceleration: its slope is "
                "replaced, not added to (outputs/rigid_body_base.hpp)");
  using Base = BaseType;  ///< named by its description in headers and blocks
  static constexpr int size = 4;
  static constexpr std::array<const char*, size> names = {"dsum", "droll_sum", "dpitch_sum", "dyaw_sum"};
  static constexpr std::array<const char*, size> units = {"1", "1", "1", "1"};

  template <class Prepared, class Scalar>
  struct Body {
    Prepared base;
    detail::SignedMix<Scalar> mix;
  };
  template <class Scalar>
  static constexpr auto prepare(const Airframe<Scalar>& airframe) noexcept {
    return Body<decltype(Base::prepare(airframe)), Scalar>{Base::prepare(airframe), detail::signed_mix(airframe)};
  }
  template <class Scalar, class Setting>
  static PINNQUAD_ALWAYS_INLINE void commands(const Scalar* x, const Scalar* y, const Setting& body,
                                              Scalar* u) noexcept {
    Scalar base[rotor_count];
    Base::commands(x, body.base, static_cast<Scalar*>(base));
    AxisCommandOutputs::commands(x, y, body.mix, u);
    for (int i = 0; i < rotor_count; ++i) u[i] += base[i];
  }
  template <class Scalar, class Setting>
  static PINNQUAD_ALWAYS_INLINE void slopes(const Scalar* x, const Scalar* y, const Setting& body,
                                            Scalar* by_outputs) noexcept {
    AxisCommandOutputs::slopes(x, y, body.mix, by_outputs);
  }
  template <class Scalar, class Setting>
  static void from_commands(const Scalar* x, const Scalar* u, const Setting& body, Scalar* y) noexcept {
    Scalar left[rotor_count];
    Base::commands(x, body.base, static_cast<Scalar*>(left));
    for (int i = 0; i < rotor_count; ++i) left[i] = u[i] - left[i];
    AxisCommandOutputs::from_commands(x, static_cast<const Scalar*>(left), body.mix, y);
  }
  template <int FeatureCount, class Scalar, class Setting>
  static PINNQUAD_ALWAYS_INLINE void feature_slopes(const Scalar* x, const Scalar*, const Setting& body,
                                                    Scalar* by_x) noexcept {
    Base::template slopes<FeatureCount>(x, body.base, by_x);
  }
};

/// True for axis commands, on a base or not.
template <class Outputs>
inline constexpr bool is_signed_sums = std::is_same_v<Outputs, AxisCommandOutputs>;
template <class Base>
inline constexpr bool is_signed_sums<SignedSumsOn<Base>> = true;

}  // namespace pinnquad
