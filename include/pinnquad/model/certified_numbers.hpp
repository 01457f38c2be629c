// SPDX-License-Identifier: MIT
// The arguments of a certificate (exported/certificate.hpp): which structure of a model is proven, numbers of the
// vehicle, and the stored numbers of a model, in a header, a block or a trainer.
#pragma once

#include <cstddef>
#include <limits>
#include <string_view>

#include "pinnquad/features/shown_acceleration.hpp"
#include "pinnquad/model/axis_aligned.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"
#include "pinnquad/outputs/rotor_map.hpp"

namespace pinnquad {

/// A fit leaves a slope of at least this share of the airframe's own (fit_monotone_base()).
inline constexpr double least_fitted_slope_share = 0.01;
/// A proven slope is above this share of the airframe's own at full command: a network that is shown the angular
/// acceleration may take nine tenths of what the fit leaves, rounding and rotors' curves half of the rest.
inline constexpr double least_slope_share = 0.05 * least_fitted_slope_share;

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Most threes that a certificate counts: taps of a window.
inline constexpr int most_certified_taps = 16;

/// True where the `taps` threes from `places` on are all that moves with the angular acceleration, the present's first
/// and each feature about its own axis: nothing else shows one, and nobody knows less of a feature than that it stands.
/// `shown(feature)`: its ShownAcceleration; `of_present(feature)`: it is of no other tap.
template <class Shown, class OfPresent>
constexpr bool threes_cover_acceleration(const int* places, int taps, int features, const Shown& shown,
                                         const OfPresent& of_present) noexcept {
  if (taps < 1 || taps > most_certified_taps) return false;
  for (int feature = 0; feature < features; ++feature) {
    ShownAcceleration counted = ShownAcceleration::none;
    for (int tap = 0; tap < taps; ++tap) {
      const int axis = feature - places[tap];
      if (axis < 0 || axis > 2) continue;
      counted = static_cast<ShownAcceleration>(axis);
      if (of_present(feature) != (tap == 0)) return false;
    }
    if (shown(feature) != counted) return false;
  }
  return true;
}

/// True if the places `First...` of these features hold all three angular accelerations.
template <class Features, int... First>
constexpr bool covers_angular_acceleration() noexcept {
  constexpr int places[] = {First...};
  return threes_cover_acceleration(
      static_cast<const int*>(places), int(sizeof...(First)), Features::size,
      [](int feature) { return shown_acceleration_of<Features>(feature); },
      [](int feature) { return is_of_present(Features::names[static_cast<std::size_t>(feature)]); });
}

/// The structure of a predictor that a certificate proves, if it `is_known`. `Base`: its affine part, void where there
/// is no such structure, or where it does not cover the angular acceleration that the features show.
template <class Predictor, class Features>
struct ProvenStructure {
  using Base = void;
  static constexpr bool is_known = false;
};
template <class Scalar, int FeatureCount, int... First, class Features>
struct ProvenStructure<AxisAligned<Scalar, FeatureCount, First...>, Features> {
  using Base = std::conditional_t<covers_angular_acceleration<Features, First...>(),
                                  AxisAligned<Scalar, FeatureCount, First...>, void>;
  static constexpr bool is_known = true;
  static constexpr bool has_residual = false;
};
template <class Scalar, int FeatureCount, int... First, class Residual, class Features>
struct ProvenStructure<
    Sum<AxisAligned<Scalar, FeatureCount, First...>, Saturated<Masked<Residual, FeatureCount, First...>>>, Features>
    : ProvenStructure<AxisAligned<Scalar, FeatureCount, First...>, Features> {
  static constexpr bool has_residual = true;
};
/// True where the mix times its inverse is the identity without rounding (entries are quarters), and each rotor has the
/// same sign in an axis command and in its inverse.
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

constexpr double magnitude(double value) noexcept { return value < 0 ? -value : value; }
constexpr double larger(double a, double b) noexcept { return a > b ? a : b; }

/// Places of the features that more thrust makes smaller, those of the present instant first, then of a window's other
/// taps.
template <int Size>
struct ThrustPlaces {
  int place[static_cast<std::size_t>(Size)]{};
  int count = 0;
  int present = 0;
};
/// True for "s_z", "vdot_bz" and, of other taps, "s_z[-1]".
constexpr bool is_thrust(std::string_view name) noexcept {
  return name_at_tap(name) == "s_z" || name_at_tap(name) == "vdot_bz";
}
template <class Features>
constexpr ThrustPlaces<Features::size> thrust_places() noexcept {
  ThrustPlaces<Features::size> places;
  for (const bool now : {true, false}) {
    for (int i = 0; i < Features::size; ++i) {
      const std::string_view name = Features::names[static_cast<std::size_t>(i)];
      if (!is_thrust(name) || is_of_present(name) != now) continue;
      places.place[places.count++] = i;
      places.present += now ? 1 : 0;
    }
  }
  return places;
}

template <class Base, class Scalar>
using ThrustSlopeOf = decltype(Base::least_thrust_slope(std::declval<const Airframe<Scalar>&>()));
/// Thrust slope of an output schema's base: 0 without a base, -infinity for a base that declares none.
template <class Base, class Scalar>
constexpr double base_thrust_slope([[maybe_unused]] const Airframe<Scalar>& airframe) noexcept {
  if constexpr (is_detected<ThrustSlopeOf, Base, Scalar>) {
    return Base::least_thrust_slope(airframe);
  } else {
    return std::is_same_v<Base, NoBase> ? 0.0 : -std::numeric_limits<double>::infinity();
  }
}

/// At or above the exact result of fewer than 64 sums and products of doubles of one sign that were worked out as
/// `value`: each operation errs by at most 2^-53 of its result.
constexpr double rounded_up(double value) noexcept {
  return value + magnitude(value) * 64 * std::numeric_limits<double>::epsilon();
}
constexpr double rounded_down(double value) noexcept { return -rounded_up(-value); }

/// Numbers of a vehicle, and of the base of its outputs, that a certificate reads.
template <class Scalar>
struct CertifiedVehicle {
  SignedMix<Scalar> mix{};
  double least_slope[3]{};  ///< floors of the slopes, s^2/rad
  bool on_base = false;
  double base_thrust_slope = 0;  ///< least that the base adds to the thrust slope, s^2/m
};

template <class Outputs, class Scalar>
constexpr CertifiedVehicle<Scalar> certified_vehicle(const Airframe<Scalar>& airframe) noexcept {
  CertifiedVehicle<Scalar> vehicle;
  vehicle.mix = signed_mix(airframe);
  const auto map = acceleration_map(airframe, Scalar(0));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
      const Scalar most_thrust_slope = Scalar(1) + map.curve[rotor];  // of its curve, at command 1
      const Scalar share = vehicle.mix.signs[1 + axis][rotor] * map.by[rotor][1 + axis] / most_thrust_slope;
      vehicle.least_slope[axis] += least_slope_share * static_cast<double>(share);
    }
  }
  using Base = typename BaseOf<Outputs>::type;
  vehicle.on_base = !std::is_same_v<Base, NoBase>;
  vehicle.base_thrust_slope = base_thrust_slope<Base>(airframe);
  return vehicle;
}

/// The stored numbers that a certificate reads. No pointer is null: to compare a pointer into an array with null is no
/// constant expression under g++ -fsanitize=undefined.
template <class Scalar>
struct CertifiedNumbers {
  int inputs;            ///< features
  int taps;              ///< with an angular acceleration; most_certified_taps at most
  const int* places;     ///< of each tap's angular acceleration among the features, the present first
  int thrust_count;      ///< features that are the specific force along the thrust axis, of all taps
  int thrust_present;    ///< of them, how many are of the present instant
  const int* thrusts;    ///< where they are, the present first
  const Scalar* affine;  ///< parameters in the order of AxisAligned
  bool has_residual;     ///< its bounds follow the affine part's parameters
  Scales<Scalar> scales;
  CertifiedVehicle<Scalar> vehicle;

  constexpr int others() const noexcept { return inputs - 3 * taps; }
  constexpr const Scalar* weights() const noexcept { return affine + 3 * taps; }
  constexpr const Scalar* intercepts() const noexcept { return weights() + 4 * others(); }
  constexpr const Scalar* bounds() const noexcept { return intercepts() + 4; }  ///< lower, then upper ones
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

/// True for a model type (Network, Features, Outputs) whose certificate can be worked out.
template <class Shape>
inline constexpr bool has_certificate =
    is_signed_sums<typename Shape::Outputs>&& base_reads<typename Shape::Features, typename Shape::Outputs>() &&
    !std::is_void_v<typename detail::ProvenStructure<typename Shape::Network, typename Shape::Features>::Base>;

}  // namespace pinnquad
