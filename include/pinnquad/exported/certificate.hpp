// SPDX-License-Identifier: MIT
// A certificate: the structure and the stored numbers of a model prove it, whatever the model is asked
// (docs/certificate.md). Each signed sum of the commands rises with the angular acceleration about its axis, and less
// with any other one. The commands stay within a bound of an affine map. It holds for the bare model: a limit that
// clips its commands may move the other sums. A few products of stored numbers, worked out by the compiler, when a
// block is opened, and on the ground.
#pragma once

#include <limits>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/exported/model.hpp"
#include "pinnquad/model/certified_numbers.hpp"

namespace pinnquad {

/// A model whose thrust slope is below this share of the airframe's own in hover should carry nothing: a position loop
/// tuned on the airframe has half its gain or less, and sinks twice as far under a load.
inline constexpr double least_thrust_share = 0.5;

/// Proven bounds of a model. All hold for the real function of the stored numbers; where a
/// bound is rounded it is rounded to the safe side.
struct Certificate {
  /// The slopes about the axes are above 0 and their floor, rounding does not hide them over the envelope, and the mix
  /// of the vehicle's rotors is exact.
  bool monotone = false;
  bool bounded = false;  ///< there is a residual, none, or one between finite bounds that are in order
  /// Least values of d(signed sum)/d(angular acceleration), roll, pitch, yaw, s^2/rad: of the present instant, and of
  /// one that is held over all taps of a window (the same without one).
  double slope[3]{};
  double held_slope[3]{};
  /// Least values of d(sum of the commands)/d(specific force asked along the thrust axis), s^2/m, of the base alone: of
  /// the present instant, and of one that is held. Over a step d the sum rises by this times d, less at most the
  /// residual's range, residual_upper[0] - residual_lower[0]. 0 of features that have no such force. On a formula that
  /// says nothing of it -infinity; on one with curved thrust while its commands are in 0 to 1.
  double thrust_slope = 0;
  double held_thrust_slope = 0;
  /// Most that a command of the base, as it is computed, is off the real one inside the envelope; infinite where nobody
  /// knows: on a formula, of a residual without bounds.
  double rounding = std::numeric_limits<double>::infinity();
  /// The step of an acceleration that is held, rad/s^2, from which on the computed sum rises for sure inside the
  /// envelope. Over a smaller one it may rest; of a window it may fall by rounding.
  double sure_step[3]{};
  /// Between which the residual's share stays: sum of the commands, signed sums about roll, pitch, yaw.
  double residual_lower[4]{};
  double residual_upper[4]{};
  /// Most that a command differs from the base's, rotor by rotor.
  double command_bound[rotor_count]{};

  constexpr bool proven() const noexcept { return monotone && bounded; }
};

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Ranges of the residual, and what they do to each command.
template <class Scalar>
constexpr void bound_residual(const CertifiedNumbers<Scalar>& from, Certificate& certificate) noexcept {
  certificate.bounded = true;
  if (!from.has_residual) return;
  for (int k = 0; k < 4; ++k) {
    const double scale = static_cast<double>(from.scales.output_deviation[k]);
    const double lower = static_cast<double>(from.bounds()[k]), upper = static_cast<double>(from.bounds()[4 + k]);
    certificate.residual_lower[k] = rounded_down(lower * scale);
    certificate.residual_upper[k] = rounded_up(upper * scale);
    const bool finite = is_finite_constant(lower) && is_finite_constant(upper) && is_finite_constant(scale);
    certificate.bounded = certificate.bounded && finite && scale > 0 && lower <= upper;
    const double most = larger(-certificate.residual_lower[k], certificate.residual_upper[k]);
    for (int rotor = 0; rotor < rotor_count; ++rotor) {
      certificate.command_bound[rotor] += magnitude(static_cast<double>(from.vehicle.mix.by[rotor][k])) * most;
    }
  }
  for (double& bound : certificate.command_bound) bound = rounded_up(bound);
}

/// How much the sum of the commands rises with the thrust that is asked.
template <class Scalar>
constexpr void take_thrust(const CertifiedNumbers<Scalar>& from, Certificate& certificate) noexcept {
  if (from.thrust_count == 0) return;
  const double formula = from.vehicle.base_thrust_slope;
  if (!is_finite_constant(formula)) {
    certificate.thrust_slope = certificate.held_thrust_slope = formula;
    return;
  }
  double present = formula, held = formula, magnitudes = magnitude(formula);
  for (int i = 0; i < from.thrust_count; ++i) {
    const int place = from.thrusts[i];
    int other = place;
    for (int tap = 0; tap < from.taps; ++tap) other -= from.places[tap] < place ? 3 : 0;
    const double deviation = static_cast<double>(from.scales.input_deviation[place]);
    const double slope =
        -static_cast<double>(from.weights()[other]) / deviation * static_cast<double>(from.scales.output_deviation[0]);
    if (i < from.thrust_present) present += slope;
    held += slope;
    magnitudes += magnitude(slope);
  }
  const double doubt = 2 * (rounded_up(magnitudes) - magnitudes);
  certificate.thrust_slope = present - doubt;
  certificate.held_thrust_slope = held - doubt;
}

/// The base's rounding inside the envelope, and the step from which on a slope is above it (docs/certificate.md).
template <class Scalar>
constexpr void bound_rounding(const CertifiedNumbers<Scalar>& from, Certificate& certificate) noexcept {
  if (from.vehicle.on_base || !certificate.bounded) {
    for (double& step : certificate.sure_step) step = std::numeric_limits<double>::infinity();
    return;
  }
  const Scales<Scalar>& scales = from.scales;
  const auto farthest = [&](int feature) {
    const double mean = static_cast<double>(scales.input_mean[feature]);
    const double below = magnitude(static_cast<double>(scales.lower[feature]) - mean);
    const double above = magnitude(static_cast<double>(scales.upper[feature]) - mean);
    return larger(below, above) / static_cast<double>(scales.input_deviation[feature]);
  };
  double sums[4]{};
  for (int k = 0; k < 4; ++k) sums[k] = magnitude(static_cast<double>(from.intercepts()[k]));
  for (int feature = 0, tap = 0, other = 0; feature < from.inputs; ++feature) {
    const double far = farthest(feature);
    if (tap < from.taps && feature == from.places[tap]) {
      for (int axis = 0; axis < 3; ++axis) {
        sums[1 + axis] += magnitude(static_cast<double>(from.affine[3 * tap + axis])) * farthest(feature + axis);
      }
      feature += 2;
      ++tap;
      continue;
    }
    for (int k = 0; k < 4; ++k) {
      sums[k] += magnitude(static_cast<double>(from.weights()[k * from.others() + other])) * far;
    }
    ++other;
  }
  const double roundings = (from.inputs + 12) * (static_cast<double>(std::numeric_limits<Scalar>::epsilon()) / 2);
  double all = 0;
  certificate.rounding = 0;
  for (int rotor = 0; rotor < rotor_count; ++rotor) {
    double error = 0;
    for (int k = 0; k < 4; ++k) {
      const double residual = larger(-certificate.residual_lower[k], certificate.residual_upper[k]);
      const double sum = sums[k] * static_cast<double>(scales.output_deviation[k]) +
                         magnitude(static_cast<double>(scales.output_mean[k])) + residual;
      error += magnitude(static_cast<double>(from.vehicle.mix.by[rotor][k])) * sum * roundings / (1 - roundings);
    }
    all += error;
    certificate.rounding = larger(certificate.rounding, rounded_up(error));
  }
  for (int axis = 0; axis < 3; ++axis) {
    const int place = from.places[0] + axis;
    const double width = static_cast<double>(scales.upper[place]) - static_cast<double>(scales.lower[place]);
    const double slope = certificate.held_slope[axis];
    certificate.sure_step[axis] = slope > 0 ? rounded_up(2 * all / slope) : std::numeric_limits<double>::infinity();
    certificate.monotone = certificate.monotone && certificate.sure_step[axis] <= width;
  }
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// Certificate of the structure u = A [base + residual]: base as AxisAligned, residual as Saturated<Masked>.
template <class Scalar>
constexpr Certificate certificate_of(const detail::CertifiedNumbers<Scalar>& from) noexcept {
  Certificate certificate;
  certificate.monotone = detail::exact_mix(from.vehicle.mix);
  for (int axis = 0; axis < 3; ++axis) {
    const double scale = static_cast<double>(from.scales.output_deviation[1 + axis]);
    bool finite = is_finite_constant(scale) && scale > 0;
    double present = 0, sum = 0, magnitudes = 0;
    for (int tap = 0; tap < from.taps; ++tap) {
      const double deviation = static_cast<double>(from.scales.input_deviation[from.places[tap] + axis]);
      const double slope = static_cast<double>(from.affine[3 * tap + axis]) / deviation * scale;
      finite = finite && is_finite_constant(slope) && deviation > 0;
      if (tap == 0) present = slope;
      sum += slope;
      magnitudes += slope < 0 ? -slope : slope;
    }
    const double doubt = detail::rounded_up(magnitudes) - magnitudes;  // of the sum: of its terms and of adding them
    certificate.slope[axis] = detail::rounded_down(present);
    certificate.held_slope[axis] = from.taps == 1 ? certificate.slope[axis] : sum - 2 * doubt;
    const double floor = from.vehicle.least_slope[axis];
    certificate.monotone = certificate.monotone && finite && certificate.slope[axis] > 0 &&
                           certificate.held_slope[axis] > 0 && certificate.slope[axis] > floor &&
                           certificate.held_slope[axis] > floor;
  }
  detail::bound_residual(from, certificate);
  detail::take_thrust(from, certificate);
  detail::bound_rounding(from, certificate);
  return certificate;
}

/// Certificate of a model type with has_certificate. Proves nothing of another one.
template <class Shape>
constexpr Certificate certificate_of(const detail::CertifiedVehicle<typename Shape::Scalar>& vehicle,
                                     const typename Shape::Scalar* parameters,
                                     const detail::Scales<typename Shape::Scalar>& scales) noexcept {
  if constexpr (has_certificate<Shape>) {
    using Features = typename Shape::Features;
    using Structure = detail::ProvenStructure<typename Shape::Network, Features>;
    using Base = typename Structure::Base;
    int places[Base::taps]{};
    Base::Threes::each([&](int place, int tap) { places[tap] = place; });
    constexpr auto thrusts = detail::thrust_places<Features>();
    return certificate_of(detail::CertifiedNumbers<typename Shape::Scalar>{
        Features::size, Base::taps, places, thrusts.count, thrusts.present, thrusts.place, parameters,
        Structure::has_residual, scales, vehicle});
  } else {
    return {};
  }
}

/// Certificate of a model that was trained (training/trained_model.hpp).
template <class Model>
Certificate certificate_of_trained(const Model& model) noexcept {
  return certificate_of<Model>(
      detail::certified_vehicle<typename Model::Outputs>(model.template airframe<typename Model::Scalar>()),
      model.network.parameters.data(),
      {model.input.mean.data(), model.input.standard_deviation.data(), model.output.mean.data(),
       model.output.standard_deviation.data(), model.envelope_lower.data(), model.envelope_upper.data()});
}

/// Certificate of an exported header.
template <class Model>
constexpr Certificate certificate_of() noexcept {
  constexpr auto vehicle = detail::certified_vehicle<typename Model::Outputs>(
      airframe_value<typename Model::Vehicle, typename Model::Scalar>());
  return certificate_of<Model>(vehicle, Model::parameters.data(), detail::scales_in_header<Model>());
}

/// Refuses, at compile time and by rule, a model whose monotony is not proven. The headers of such models ask for it.
template <class Model>
constexpr bool require_certificate() noexcept {
  using Structure = detail::ProvenStructure<typename Model::Network, typename Model::Features>;
  static_assert(!Structure::is_known || !std::is_void_v<typename Structure::Base>,
                "pinnquad: a feature of the model shows an angular acceleration beside the three of a tap that the "
                "affine part counts, or is neither the library's nor a column: nobody knows the response to an "
                "acceleration that is held (docs/certificate.md)");
  static_assert(has_certificate<Model>,
                "pinnquad: this model has no structure that could be proven (exported/certificate.hpp)");
  if constexpr (has_certificate<Model>) {
    constexpr Certificate certificate = certificate_of<Model>();
    static_assert(
        certificate.monotone,
        "pinnquad: a slope of the model is not above 0 by its floor, or by what its network or rounding may do, "
        "or its vehicle's rotors have no exact mix: its commands need not follow the angular acceleration "
        "(docs/certificate.md)");
    static_assert(certificate.bounded, "pinnquad: the bounds of the model's residual are none (docs/certificate.md)");
  }
  return has_certificate<Model>;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
