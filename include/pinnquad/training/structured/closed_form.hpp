// SPDX-License-Identifier: MIT
// Models that are solved rather than trained: rows as sums for least squares (regression/ridge.hpp), an affine map as a
// predictor, and the monotone base of a structured model.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/dynamics/rotor.hpp"
#include "pinnquad/model/axis_aligned.hpp"
#include "pinnquad/model/certified_numbers.hpp"
#include "pinnquad/model/predictor.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/regression/ridge.hpp"
#include "pinnquad/training/structured/fit_context.hpp"
#include "pinnquad/training/trained_model.hpp"

namespace pinnquad {

/// An affine map of a context's features to its outputs, as a predictor (a float Network of one Dense). Throws
/// std::invalid_argument for a map of other sizes.
template <class ContextType>
auto affine_answer(const AffineMap& map) {
  Network<float, InputSize<ContextType::Features::size>, Dense<ContextType::output_count>> predictor;
  if (map.weights.size() + map.intercept.size() != predictor.parameters.size() || map.inputs != predictor.inputs) {
    throw std::invalid_argument("affine_answer: expected a map of " + std::to_string(predictor.inputs) +
                                " features to " + std::to_string(predictor.outputs) + " outputs, found another");
  }
  auto to = predictor.parameters.begin();
  for (const double v : map.weights) *to++ = static_cast<float>(v);
  for (const double v : map.intercept) *to++ = static_cast<float>(v);
  return predictor;
}

/// The sum of two predictors: an affine map and what a network learnt of its residuals.
template <class First, class Second>
Sum<First, Second> sum_of(const First& first, const Second& second) {
  Sum<First, Second> sum;
  const auto border = std::copy(first.parameters.begin(), first.parameters.end(), sum.parameters.begin());
  std::copy(second.parameters.begin(), second.parameters.end(), border);
  return sum;
}

/// Subtracts the map's outputs from those of standardised rows: a TrainingData or a FitRows.
template <class Rows>
void take_away(const AffineMap& map, Rows& rows) {
  std::vector<double> x(static_cast<std::size_t>(map.inputs));
  for (int row = 0; row < rows.size(); ++row) {
    const auto* features = rows.features_of(row);
    std::copy(features, features + map.inputs, x.begin());
    const std::vector<double> said = map(x.data());
    auto* outputs = rows.outputs.data() + std::ptrdiff_t{row} * map.outputs;
    for (int k = 0; k < map.outputs; ++k) {
      outputs[k] -= static_cast<std::decay_t<decltype(*outputs)>>(said[static_cast<std::size_t>(k)]);
    }
  }
}

/// Whole flights that are one piece of evidence: trajectories with their repeats or, where there is one trajectory, its
/// flights.
std::vector<RowSet> whole_flight_groups(const RowSet& rows);

/// Groups for cross-validation: whole_flight_groups(); where there is one flight, its quarters.
std::vector<RowSet> left_out_groups(const RowSet& rows);

/// Sums over `rows` of standardised features and of `targets` numbers a row: `target` makes them of the row's
/// standardised outputs y and its commands.
RegressionSums regression_sums(
    const FitContext& context, const RowSet& rows, int targets,
    const std::function<std::vector<double>(const double* y, const Commands<double>& commands)>& target);

/// Sums of standardised features and outputs.
RegressionSums regression_sums(const FitContext& context, const RowSet& rows);

/// Sums of each group that has rows with all features.
std::vector<RegressionSums> regression_sums(const FitContext& context, const std::vector<RowSet>& groups);

/// Sums for a context of types, of one set of rows or of groups.
template <class ContextType, class Rows>
auto regression_sums(const ContextType& context, const Rows& rows) {
  return regression_sums(fit_context(context), rows);
}

namespace detail {

/// All but the angular accelerations about the other axes.
std::vector<bool> features_of_output(const FitContext& context, int output);

/// The slope of a sum as a sum of factor x weight over all taps; that of the thrust is below 0.
std::vector<std::pair<int, double>> slope_terms(const FitContext& context, int output);

/// Bounds of an axis command's slopes; of the thrust's too where a window's is held. See fit_monotone_base().
std::vector<WeightBound> slope_bounds(const FitContext& context, int output, const std::optional<AxisSlopes>& pinned,
                                      double held_thrust);

}  // namespace detail

/// The base of a structured model: per axis command a ridge regression that sees its own angular acceleration alone,
/// with a slope above 0. Standardised features to standardised axis commands. Each penalty is chosen by leaving out one
/// group in turn. A slope is learnt, and at least a hundredth of the airframe's own, also where the rows say otherwise.
/// `pinned`, s^2/rad, fixes it, such as at hover_slopes() for a model of quiet flights that is to fly agile ones. In a
/// window this holds for the slope of the present and for the sum over all taps; `pinned` is the sum. `held_thrust`,
/// s^2/m: the thrust slope is held at it; 0: learnt. Throws std::invalid_argument for no rows, and for pinned slopes
/// that are not above this hundredth.
AffineMap fit_monotone_base(const FitContext& context, const std::vector<RegressionSums>& groups,
                            const std::optional<AxisSlopes>& pinned = {}, double held_thrust = 0);

/// The same from rows, in the groups of left_out_groups().
template <class ContextType>
AffineMap fit_monotone_base(const ContextType& context, const RowSet& rows,
                            const std::optional<AxisSlopes>& pinned = {}) {
  static_assert(is_signed_sums<typename ContextType::Outputs>,
                "pinnquad: a monotone base answers signed sums: Context<Features, Vehicle, AxisCommandOutputs>");
  const FitContext value = fit_context(context);
  return fit_monotone_base(value, regression_sums(value, left_out_groups(rows)), pinned);
}

/// The parameters of the MonotoneBase of such a map. `accelerations`: FitContext's.
std::vector<float> base_parameters(const std::vector<int>& accelerations, const AffineMap& map);

/// The predictor of such a map.
template <class ContextType>
MonotoneBase<typename ContextType::Features> monotone_base(const AffineMap& map) {
  using Base = MonotoneBase<typename ContextType::Features>;
  Base base;
  std::vector<int> accelerations;
  Base::Threes::each([&](int place, int) { accelerations.push_back(place); });
  const std::vector<float> parameters = base_parameters(accelerations, map);
  std::copy_n(parameters.begin(), base.parameters.size(), base.parameters.begin());
  return base;
}

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/training/structured/impl/closed_form.hpp"
#endif
