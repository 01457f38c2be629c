// SPDX-License-Identifier: MIT
// The arguments of a certificate (exported/certificate.hpp): a structure that is proven, the vehicle, stored
// numbers wherever they are.
#pragma once

#include <limits>
#include <string_view>

#include "pinnquad/features/read_features.hpp"
#include "pinnquad/model/axis_aligned.hpp"
#include "pinnquad/model/path_bound.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"
#include "pinnquad/outputs/rotor_map.hpp"

namespace pinnquad {

/// A slope is proven above this share of the airframe's own at full command: a hundredth is the least that training
/// leaves (SlopeRule), of which a network that is shown the angular acceleration may take nine tenths; and a half for
/// rounding and rotors' curves.
inline constexpr double least_slope_share = 0.0005;

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
    Sum<AxisAligned<Scalar, FeatureCount, First...>, Saturated<Masked<Residual, FeatureCount, First...>>>, Features> {
  using Base = std::conditional_t<covers_angular_acceleration<Features, First...>(),
                                  AxisAligned<Scalar, FeatureCount, First...>, void>;
  static constexpr bool has_residual = true;
  static constexpr bool has_paths = false;
};
template <class Scalar, int FeatureCount, int... First, class Residual, class Features>
struct ProvenStructure<Sum<AxisAligned<Scalar, FeatureCount, First...>, Saturated<PathBounded<Residual>>>, Features> {
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

constexpr double magnitude(double value) noexcept { return value < 0 ? -value : value; }
constexpr double larger(double a, double b) noexcept { return a > b ? a : b; }

/// Places of the specific force along the thrust axis among the features, or of the acceleration along it: of the
/// present instant first, then of a window's other taps.
template <int Size>
struct ThrustPlaces {
  int place[Size]{};
  int count = 0;
  int present = 0;
};
/// "s_z", "vdot_bz", and of other taps "s_z[-1]": more thrust is less of it.
constexpr bool is_thrust(std::string_view name) noexcept {
  const std::string_view of_tap = name.substr(0, name.find('['));
  return of_tap == "s_z" || of_tap == "vdot_bz";
}
template <class Features>
constexpr ThrustPlaces<Features::size> thrust_places() noexcept {
  ThrustPlaces<Features::size> places;
  for (const bool now : {true, false}) {
    for (int i = 0; i < Features::size; ++i) {
      const std::string_view name = Features::names[static_cast<std::size_t>(i)];
      if (!is_thrust(name) || (name.back() != ']') != now) continue;
      places.place[places.count++] = i;
      places.present += now ? 1 : 0;
    }
  }
  return places;
}

template <class Formula, class Scalar, class = void>
struct HasThrustSlope : std::false_type {};
template <class Formula, class Scalar>
struct HasThrustSlope<Formula, Scalar,
                      std::void_t<decltype(Formula::least_thrust_slope(std::declval<const Airframe<Scalar>&>()))>>
    : std::true_type {};
/// Of no formula 0; of one that does not say it nobody knows.
template <class Formula, class Scalar>
constexpr double formula_thrust_slope(const Airframe<Scalar>& airframe) noexcept {
  if constexpr (HasThrustSlope<Formula, Scalar>::value) {
    return Formula::least_thrust_slope(airframe);
  } else {
    static_cast<void>(airframe);
    return std::is_same_v<Formula, NoBase> ? 0.0 : -std::numeric_limits<double>::infinity();
  }
}

/// Above the real sum or product of a few doubles that was worked out as `value`, all of one sign: each operation errs
/// by at most 2^-53 of its result, and fewer than 64 are made.
constexpr double rounded_up(double value) noexcept {
  return value + magnitude(value) * 64 * std::numeric_limits<double>::epsilon();
}
constexpr double rounded_down(double value) noexcept { return -rounded_up(-value); }

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// True for a model type (Network, Features, Outputs) whose certificate can be worked out.
template <class Shape>
inline constexpr bool has_certificate =
    is_signed_sums<typename Shape::Outputs>&& base_reads<typename Shape::Features, typename Shape::Outputs>() &&
    !std::is_void_v<typename detail::ProvenStructure<typename Shape::Network, typename Shape::Features>::Base>;

/// A vehicle, and the formula that its outputs add to, as a certificate reads them.
template <class Scalar>
struct CertifiedVehicle {
  detail::SignedMix<Scalar> mix{};
  double least_slope[3]{};  ///< floors of the slopes, s^2/rad
  bool on_formula = false;
  double formula_thrust_slope = 0;  ///< what the formula adds to the thrust slope at least, s^2/m
};

template <class Outputs, class Scalar>
constexpr CertifiedVehicle<Scalar> certified_vehicle(const Airframe<Scalar>& airframe) noexcept {
  CertifiedVehicle<Scalar> vehicle;
  vehicle.mix = detail::signed_mix(airframe);
  const auto map = detail::acceleration_map(airframe, Scalar(0));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
      const Scalar most_thrust_slope = Scalar(1) + map.curve[rotor];  // of its curve, at command 1
      const Scalar share = vehicle.mix.signs[1 + axis][rotor] * map.by[rotor][1 + axis] / most_thrust_slope;
      vehicle.least_slope[axis] += least_slope_share * static_cast<double>(share);
    }
  }
  using Formula = typename detail::BaseOf<Outputs>::type;
  vehicle.on_formula = !std::is_same_v<Formula, detail::NoBase>;
  vehicle.formula_thrust_slope = detail::formula_thrust_slope<Formula>(airframe);
  return vehicle;
}

/// Scalers and envelope of a model, wherever they are.
template <class Scalar>
struct CertifiedScales {
  const Scalar* input_mean;
  const Scalar* input_spread;
  const Scalar* output_mean;
  const Scalar* output_spread;
  const Scalar* envelope_lower;
  const Scalar* envelope_upper;
};

/// The stored numbers that a certificate reads, wherever they are. No pointer is null: a pointer into an array
/// that is compared with null is no constant to g++ -fsanitize=undefined.
template <class Scalar>
struct CertifiedNumbers {
  int inputs;                 ///< features
  int taps;                   ///< with an angular acceleration; 16 at most
  const int* places;          ///< of each tap's angular acceleration among the features, the present first
  int thrust_count;           ///< features that are the specific force along the thrust axis, of all taps
  int thrust_present;         ///< of them, how many are of the present instant
  const int* thrusts;         ///< where they are, the present first
  const Scalar* base;         ///< as AxisAligned has its parameters
  bool has_residual;          ///< its bounds follow those
  const PathBound<4>* paths;  ///< of a residual that is shown the angular acceleration, tap by tap, axis by axis
  bool has_paths;
  CertifiedScales<Scalar> scales;
  CertifiedVehicle<Scalar> vehicle;

  constexpr int others() const noexcept { return inputs - 3 * taps; }
  constexpr const Scalar* weights() const noexcept { return base + 3 * taps; }
  constexpr const Scalar* intercepts() const noexcept { return weights() + 4 * others(); }
  constexpr const Scalar* bounds() const noexcept { return intercepts() + 4; }  ///< lower, then upper ones
};

}  // namespace PINNQUAD_INSTRUCTION_SET

}  // namespace pinnquad
