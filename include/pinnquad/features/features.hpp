// SPDX-License-Identifier: MIT
// A feature set: the numbers X that a network is shown, made of raw inputs. It alone states their count, names and
// order. Contract, all static:
//   template <class Scalar> Inputs                     the raw inputs, a named struct
//   constexpr int size;  constexpr std::array<const char*, size> names, units;
//   constexpr int angular_acceleration                 place of p_dot in X, q_dot and r_dot behind it; -1: X has none
//   template <class Scalar> Status check(const Inputs<Scalar>&) noexcept
//   template <class Scalar> void extract(const Inputs<Scalar>&, Scalar* x) noexcept    fills x[0..size)
// An input that is not finite makes a feature that is not finite: a Guard without FiniteInputs relies on it.
#pragma once

#include <array>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/status.hpp"
#include "pinnquad/dynamics/state.hpp"

namespace pinnquad {

namespace detail {
/// A feature, an output or a column.
struct NameAndUnit {
  std::string_view name, unit;
};

/// Lists of texts, one after the other.
template <std::size_t... Size>
constexpr std::array<const char*, (Size + ...)> joined_texts(const std::array<const char*, Size>&... lists) noexcept {
  std::array<const char*, (Size + ...)> result{};
  std::size_t at = 0;
  const auto append = [&](const auto& list) {
    for (std::size_t i = 0; i < list.size(); ++i) result[at++] = list[i];
  };
  (append(lists), ...);
  return result;
}

template <std::size_t Size>
constexpr bool all_differ(const std::array<const char*, Size>& texts) noexcept {
  for (std::size_t i = 0; i < Size; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (std::string_view(texts[i]) == texts[j]) return false;
    }
  }
  return true;
}
}  // namespace detail

/// The question to an inverse-dynamics network: the wanted motion, in the state of the vehicle. Body frame FRD.
template <class Scalar>
struct MotionInputs {
  Vector3<Scalar> linear_acceleration_m_s2 = Vector3<Scalar>::Zero();  ///< v_dot_B, see Accelerations
  Vector3<Scalar> angular_acceleration_rad_s2 = Vector3<Scalar>::Zero();
  Vector3<Scalar> velocity_m_s = Vector3<Scalar>::Zero();
  Vector3<Scalar> body_rates_rad_s = Vector3<Scalar>::Zero();
  Quaternion<Scalar> attitude{};  ///< body -> world
};

/// Inputs of `motion` in `state`.
template <class Scalar>
MotionInputs<Scalar> motion_inputs(const State<Scalar>& state, const Accelerations<Scalar>& motion) noexcept {
  return {motion.linear_m_s2, motion.angular_rad_s2, body_velocity(state), state.body_rates_rad_s, state.attitude};
}

/// X of Sec. 4.1: (v_dot_B, omega_dot, v_B, omega, phi, theta, sin psi, cos psi), 16 entries (docs/paper.md, deviation
/// 1).
struct PaperFeatures {
  template <class Scalar>
  using Inputs = MotionInputs<Scalar>;

  static constexpr int size = 16;
  static constexpr int angular_acceleration = 3;
  static constexpr std::array<const char*, size> names = {"vdot_bx", "vdot_by", "vdot_bz", "wdot_x", "wdot_y", "wdot_z",
                                                          "v_bx",    "v_by",    "v_bz",    "w_x",    "w_y",    "w_z",
                                                          "roll",    "pitch",   "sin_yaw", "cos_yaw"};
  static constexpr std::array<const char*, size> units = {"m/s^2", "m/s^2", "m/s^2", "rad/s^2", "rad/s^2", "rad/s^2",
                                                          "m/s",   "m/s",   "m/s",   "rad/s",   "rad/s",   "rad/s",
                                                          "rad",   "rad",   "1",     "1"};

  /// `not_finite` for NaN or Inf, `not_unit_quaternion` for an attitude that is none.
  template <class Scalar>
  static Status check(const Inputs<Scalar>& in) noexcept {
    const Quaternion<Scalar>& q = in.attitude;
    const Scalar attitude[4] = {q.w, q.x, q.y, q.z};
    bool finite = all_finite(attitude, 4);  // no early exit: the time does not depend on the data
    finite &= all_finite(in.linear_acceleration_m_s2);
    finite &= all_finite(in.angular_acceleration_rad_s2);
    finite &= all_finite(in.velocity_m_s);
    finite &= all_finite(in.body_rates_rad_s);
    if (!finite) return Status::not_finite;
    return is_unit(q) ? Status::ok : Status::not_unit_quaternion;
  }

  /// Fills x[0..size). The inputs must have passed check().
  template <class Scalar>
  static void extract(const Inputs<Scalar>& in, Scalar* x) noexcept {
    for (int i = 0; i < 3; ++i) {
      x[i] = in.linear_acceleration_m_s2[i];
      x[3 + i] = in.angular_acceleration_rad_s2[i];
      x[6 + i] = in.velocity_m_s[i];
      x[9 + i] = in.body_rates_rad_s[i];
    }
    const EulerAngles<Scalar> level = tilt(in.attitude);
    const Heading<Scalar> yaw = heading(in.attitude);
    x[12] = level.roll_rad;
    x[13] = level.pitch_rad;
    x[14] = yaw.sine;
    x[15] = yaw.cosine;
  }
};

/// The same near the ground.
template <class Scalar>
struct MotionInputsWithAltitude : MotionInputs<Scalar> {
  /// Above ground, positive up. NaN until it is set, which is refused as not finite: no default would be a safe one.
  Scalar altitude_m = std::numeric_limits<Scalar>::quiet_NaN();
};

namespace detail {
template <class T, class Inputs = typename T::template Inputs<double>>
using FeatureSetMembers =
    std::void_t<std::enable_if_t<T::names.size() == std::size_t(T::size) && T::units.size() == std::size_t(T::size)>,
                decltype(T::angular_acceleration), decltype(Status(T::check(std::declval<const Inputs&>()))),
                decltype(T::extract(std::declval<const Inputs&>(), static_cast<double*>(nullptr)))>;
/// Detected of a feature set with a past (features/windowed.hpp).
template <class T>
using WindowInside = typename T::Window;
template <class T, class Inputs = typename T::template Inputs<double>>
inline constexpr bool is_noexcept_feature_set = noexcept(T::check(std::declval<const Inputs&>())) && noexcept(
    T::extract(std::declval<const Inputs&>(), static_cast<double*>(nullptr)));
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class T>
inline constexpr bool is_feature_set = is_detected<detail::FeatureSetMembers, T>;

/// True for a feature set that asks for a window.
template <class Features>
inline constexpr bool is_windowed = is_detected<detail::WindowInside, Features>;

namespace detail {
/// A feature set of the motion alone, with the altitude as its last entry: a vehicle near the ground (Discussion 5).
template <class FeatureSet>
struct WithAltitude {
  static_assert(is_feature_set<FeatureSet>,
                "pinnquad: the argument of WithAltitude is not a feature set (features/features.hpp)");
  static_assert(std::is_same_v<typename FeatureSet::template Inputs<double>, MotionInputs<double>>,
                "pinnquad: WithAltitude is around a feature set of MotionInputs; columns and windows go around it");

  template <class Scalar>
  using Inputs = MotionInputsWithAltitude<Scalar>;

  static constexpr int size = FeatureSet::size + 1;
  static constexpr int angular_acceleration = FeatureSet::angular_acceleration;
  static constexpr auto names = joined_texts(FeatureSet::names, std::array{"altitude"});
  static constexpr auto units = joined_texts(FeatureSet::units, std::array{"m"});

  /// As FeatureSet; `not_finite` for the altitude too.
  template <class Scalar>
  static Status check(const MotionInputsWithAltitude<Scalar>& in) noexcept {
    return all_finite(&in.altitude_m, 1) ? FeatureSet::check(static_cast<const MotionInputs<Scalar>&>(in))
                                         : Status::not_finite;
  }

  /// Fills x[0..size). The inputs must have passed check().
  template <class Scalar>
  static void extract(const MotionInputsWithAltitude<Scalar>& in, Scalar* x) noexcept {
    FeatureSet::extract(static_cast<const MotionInputs<Scalar>&>(in), x);
    x[FeatureSet::size] = in.altitude_m;
  }
};
}  // namespace detail

/// X of Sec. 4.1 and the altitude, 17 entries: the paper's networks near the ground.
struct PaperFeaturesWithAltitude : detail::WithAltitude<PaperFeatures> {};

}  // namespace pinnquad
