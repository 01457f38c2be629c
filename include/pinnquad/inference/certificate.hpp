// SPDX-License-Identifier: MIT
// What is proven of a model by its structure and its stored numbers, whatever it is asked (docs/certificate.md): each
// signed sum of its commands rises with the angular acceleration about its axis, and with no other one or less than with
// its own, and the commands stay within a bound of an affine map. A few products of stored numbers, for the compiler, for a block that is opened
// and for the ground.
#pragma once

#include <limits>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/inference/axis_aligned.hpp"
#include "pinnquad/inference/model.hpp"
#include "pinnquad/inference/path_bound.hpp"
#include "pinnquad/inference/signed_sum_outputs.hpp"

namespace pinnquad {

/// Of a model with a structure that can be proven. All bounds hold for the real function of the stored numbers; where a
/// bound is rounded it is rounded to the safe side.
struct Certificate {
  /// All slopes below are above 0 and above what the other sums may do, and the mix of the vehicle's rotors is exact.
  bool monotone = false;
  bool bounded = false;  ///< there is a residual, none, or one between finite bounds that are in order
  /// Least values of d(signed sum)/d(angular acceleration), roll, pitch, yaw, s^2/rad: of the present instant, and of
  /// one that is held over all taps of a window (the same without one).
  double slope[3]{};
  double held_slope[3]{};
  /// Most that the other three sums change with that angular acceleration, magnitudes added up: 0 where no network is
  /// shown it.
  double other_sums[3]{};
  double held_other_sums[3]{};
  /// Between which the residual's share stays: sum of the commands, signed sums about roll, pitch, yaw.
  double residual_lower[4]{};
  double residual_upper[4]{};
  /// Most that a command differs from the base's, rotor by rotor.
  double command_bound[rotor_count]{};

  constexpr bool proven() const noexcept { return monotone && bounded; }
};

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// True for the places of the angular acceleration at all taps of these features.
template <class Features, int... First>
constexpr bool covers_angular_acceleration() noexcept {
  if constexpr (Features::angular_acceleration < 0) {
    return false;
  } else {
    constexpr int places[] = {First...};
    if (int(sizeof...(First)) != angular_acceleration_taps<Features>()) return false;
    for (int tap = 0; tap < int(sizeof...(First)); ++tap) {
      if (places[tap] != angular_acceleration_at<Features>(tap)) return false;
    }
    return true;
  }
}

/// What of an answer's structure is proven. `Base`: void for an answer without such structure.
template <class Answer, class Features>
struct ProvenStructure {
  using Base = void;
};
template <class Scalar, int FeatureCount, int... First, class Features>
struct ProvenStructure<AxisAligned<Scalar, FeatureCount, First...>, Features> {
  using Base = std::conditional_t<covers_angular_acceleration<Features, First...>(),
                                  AxisAligned<Scalar, FeatureCount, First...>, void>;
  static constexpr bool has_residual = false;
  static constexpr bool has_paths = false;
};
template <class Scalar, int FeatureCount, int... First, class Residual, class Features>
struct ProvenStructure<
    Sum<AxisAligned<Scalar, FeatureCount, First...>, Bounded<Withheld<Residual, FeatureCount, First...>>>, Features> {
  using Base = std::conditional_t<covers_angular_acceleration<Features, First...>(),
                                  AxisAligned<Scalar, FeatureCount, First...>, void>;
  static constexpr bool has_residual = true;
  static constexpr bool has_paths = false;
};
template <class Scalar, int FeatureCount, int... First, class Residual, class Features>
struct ProvenStructure<Sum<AxisAligned<Scalar, FeatureCount, First...>, Bounded<PathBounded<Residual>>>, Features> {
  using Base = std::conditional_t<covers_angular_acceleration<Features, First...>(),
                                  AxisAligned<Scalar, FeatureCount, First...>, void>;
  static constexpr bool has_residual = true;
  static constexpr bool has_paths = true;
  using Seeing = PathBounded<Residual>;
};

/// The mix and its inverse give the identity, without rounding: the entries are quarters; and each rotor enters a sum as
/// the sum enters the rotor's command.
template <class Scalar>
constexpr bool exact_mix(const SignedMix<Scalar>& mix) noexcept {
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      int quarters = 0;
      for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
        const Scalar quadruple = 4 * mix.by[rotor][column];
        if (!(quadruple >= Scalar(-4) && quadruple <= Scalar(4))) return false;  // NaN, too
        const int whole = static_cast<int>(quadruple), sign = static_cast<int>(mix.signs[row][rotor]);
        if (!equal(static_cast<Scalar>(whole), quadruple)) return false;
        if (row == column && ((whole > 0) != (sign > 0) || (whole < 0) != (sign < 0))) return false;
        quarters += sign * whole;
      }
      if (quarters != (row == column ? 4 : 0)) return false;
    }
  }
  return true;
}

/// True where each rotor takes the same share of each sum.
template <class Scalar>
constexpr bool even_mix(const SignedMix<Scalar>& mix) noexcept {
  for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
    for (std::size_t k = 0; k < 4; ++k) {
      const Scalar entry = mix.by[rotor][k];
      if (!equal(entry, Scalar(0.25)) && !equal(entry, Scalar(-0.25))) return false;
    }
  }
  return true;
}

/// Above the real sum or product of a few doubles that was worked out as `value`, all of one sign: each operation errs
/// by at most 2^-53 of its result, and fewer than 64 are made.
constexpr double rounded_up(double value) noexcept {
  return value + (value < 0 ? -value : value) * 64 * std::numeric_limits<double>::epsilon();
}
constexpr double rounded_down(double value) noexcept { return -rounded_up(-value); }

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// True for a model type (Network, Features, Outputs) whose certificate can be worked out.
template <class Shape>
inline constexpr bool has_certificate =
    is_signed_sums<typename Shape::Outputs> &&
    !std::is_void_v<typename detail::ProvenStructure<typename Shape::Network, typename Shape::Features>::Base>;

/// What a certificate is worked out from: stored numbers, wherever they are.
template <class Scalar>
struct CertifiedNumbers {
  int taps;              ///< with an angular acceleration; 16 at most
  const int* places;     ///< of each tap's angular acceleration among the features, the present first
  const Scalar* slopes;  ///< of standardised features and signed sums, tap by tap, axis by axis
  const Scalar* bounds;  ///< lower, then upper ones of the standardised residual; null without one
  const Scalar* input_spread;
  const Scalar* output_spread;
  detail::SignedMix<Scalar> mix;  ///< SignedSumOutputs::prepare(airframe)
  const PathBound<4>* paths =
      nullptr;  ///< of a residual that is shown the angular acceleration, tap by tap, axis by axis
};

}  // namespace PINNQUAD_INSTRUCTION_SET

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// What a residual that is shown the angular acceleration takes off the slopes about an axis, at worst, and does to the
/// other sums.
template <class Scalar>
constexpr void take_paths(const CertifiedNumbers<Scalar>& from, int axis, Certificate& certificate) noexcept {
  double held_fall = 0;
  for (int tap = 0; tap < from.taps; ++tap) {
    const PathBound<4>& path = from.paths[3 * tap + axis];
    const double spread = static_cast<double>(from.input_spread[from.places[tap] + axis]);
    double fall = 0, others = 0;
    for (int k = 0; k < 4; ++k) {
      const double scale = static_cast<double>(from.output_spread[k]) / spread;
      const double below = -path.lower[k] * scale, above = path.upper[k] * scale;
      certificate.monotone = certificate.monotone && is_finite_constant(below) && is_finite_constant(above);
      if (k == 1 + axis) {
        fall = rounded_up(below);
      } else {
        others += rounded_up(below > above ? below : above);
      }
    }
    if (tap == 0) certificate.slope[axis] = rounded_down(certificate.slope[axis] - fall);
    if (tap == 0) certificate.other_sums[axis] = rounded_up(others);
    held_fall += fall;
    certificate.held_other_sums[axis] += others;
  }
  certificate.held_slope[axis] = rounded_down(certificate.held_slope[axis] - rounded_up(held_fall));
  certificate.held_other_sums[axis] = rounded_up(certificate.held_other_sums[axis]);
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// Of the structure u = A [base + residual], wherever it is known from: base and residual as AxisAligned and
/// Bounded<Withheld>.
template <class Scalar>
constexpr Certificate certificate_of(const CertifiedNumbers<Scalar>& from) noexcept {
  Certificate certificate;
  certificate.monotone = detail::exact_mix(from.mix) && from.taps <= 16;
  if (from.paths != nullptr) certificate.monotone = certificate.monotone && detail::even_mix(from.mix);
  certificate.bounded = true;
  for (int axis = 0; axis < 3; ++axis) {
    const double scale = static_cast<double>(from.output_spread[1 + axis]);
    bool finite = is_finite_constant(scale) && scale > 0;
    double present = 0, sum = 0, magnitudes = 0;
    for (int tap = 0; tap < from.taps; ++tap) {
      const double spread = static_cast<double>(from.input_spread[from.places[tap] + axis]);
      const double slope = static_cast<double>(from.slopes[3 * tap + axis]) / spread * scale;
      finite = finite && is_finite_constant(slope) && spread > 0;
      if (tap == 0) present = slope;
      sum += slope;
      magnitudes += slope < 0 ? -slope : slope;
    }
    const double doubt = detail::rounded_up(magnitudes) - magnitudes;  // of the sum: of its terms and of adding them
    certificate.slope[axis] = detail::rounded_down(present);
    certificate.held_slope[axis] = from.taps == 1 ? certificate.slope[axis] : sum - 2 * doubt;
    if (from.paths != nullptr) detail::take_paths(from, axis, certificate);
    certificate.monotone = certificate.monotone && finite && certificate.slope[axis] > certificate.other_sums[axis] &&
                           certificate.held_slope[axis] > certificate.held_other_sums[axis];
  }
  if (from.bounds == nullptr) return certificate;
  for (int k = 0; k < 4; ++k) {
    const double scale = static_cast<double>(from.output_spread[k]);
    const double lower = static_cast<double>(from.bounds[k]), upper = static_cast<double>(from.bounds[4 + k]);
    certificate.residual_lower[k] = detail::rounded_down(lower * scale);
    certificate.residual_upper[k] = detail::rounded_up(upper * scale);
    const bool finite = is_finite_constant(lower) && is_finite_constant(upper) && is_finite_constant(scale);
    certificate.bounded = certificate.bounded && finite && scale > 0 && lower <= upper;
    const double below = -certificate.residual_lower[k], above = certificate.residual_upper[k];
    const double most = below > above ? below : above;
    for (int rotor = 0; rotor < rotor_count; ++rotor) {
      const double entry = static_cast<double>(from.mix.by[rotor][k]);
      certificate.command_bound[rotor] += (entry < 0 ? -entry : entry) * most;
    }
  }
  for (double& bound : certificate.command_bound) bound = detail::rounded_up(bound);
  return certificate;
}

/// Of a model type with has_certificate. Proves nothing of another one.
template <class Shape>
constexpr Certificate certificate_of(const detail::SignedMix<typename Shape::Scalar>& mix,
                                     const typename Shape::Scalar* parameters,
                                     const typename Shape::Scalar* input_spread,
                                     const typename Shape::Scalar* output_spread) noexcept {
  if constexpr (has_certificate<Shape>) {
    using Structure = detail::ProvenStructure<typename Shape::Network, typename Shape::Features>;
    using Base = typename Structure::Base;
    int places[Base::taps]{};
    Base::Threes::each([&](int place, int tap) { places[tap] = place; });
    const auto* bounds = Structure::has_residual ? parameters + Base::parameter_count : nullptr;
    CertifiedNumbers<typename Shape::Scalar> numbers{
        Base::taps, places, parameters + Base::slopes, bounds, input_spread, output_spread, mix};
    if constexpr (Structure::has_paths) {
      PathBound<4> paths[3 * Base::taps]{};
      for (int i = 0; i < 3 * Base::taps; ++i) {
        paths[i] = Structure::Seeing::bound(bounds + 8, places[i / 3] + i % 3);
      }
      numbers.paths = paths;
      return certificate_of(numbers);
    }
    return certificate_of(numbers);
  } else {
    return {};
  }
}

/// Of an exported header.
template <class Model>
constexpr Certificate certificate_of() noexcept {
  constexpr auto mix = detail::signed_mix(airframe_value<typename Model::Vehicle, typename Model::Scalar>());
  return certificate_of<Model>(mix, Model::parameters.data(), Model::input.spread.data(), Model::output.spread.data());
}

/// Refuses, at compile time and by rule, a model whose monotony is not proven. The headers of such models ask for it.
template <class Model>
constexpr bool require_certificate() noexcept {
  static_assert(has_certificate<Model>,
                "pinnquad: this model has no structure that could be proven (inference/certificate.hpp)");
  if constexpr (has_certificate<Model>) {
    constexpr Certificate certificate = certificate_of<Model>();
    static_assert(certificate.monotone,
                  "pinnquad: a slope of the model is not above 0, or not above what its network may do, or its "
                  "vehicle's rotors have no exact mix: its commands "
                  "need not follow the angular acceleration (docs/certificate.md)");
    static_assert(certificate.bounded, "pinnquad: the bounds of the model's residual are none (docs/certificate.md)");
  }
  return has_certificate<Model>;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
