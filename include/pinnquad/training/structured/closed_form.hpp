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
inline std::vector<RowSet> whole_flight_groups(const RowSet& rows) {
  std::vector<RowSet> groups;
  for (const bool by_trajectory : {true, false}) {
    groups.clear();
    std::vector<std::string> names;
    for (const FlightRows& piece : rows.pieces()) {
      const Flight& flight = *piece.flight;
      const bool named = by_trajectory && !flight.trajectory.empty();
      const std::string name = named ? "trajectory " + flight.trajectory : "flight " + flight.name;
      const auto found = std::find(names.begin(), names.end(), name);
      const auto at = static_cast<std::size_t>(found - names.begin());
      if (found == names.end()) {
        names.push_back(name);
        groups.emplace_back();
      }
      groups[at].add(flight, piece.rows);
    }
    if (groups.size() > 1) return groups;
  }
  return groups;
}

/// Groups for cross-validation: whole_flight_groups(); where there is one flight, its quarters.
inline std::vector<RowSet> left_out_groups(const RowSet& rows) {
  std::vector<RowSet> groups = whole_flight_groups(rows);
  if (groups.size() > 1) return groups;
  constexpr std::size_t parts = 4;
  groups.assign(rows.empty() ? 0 : parts, {});
  for (const FlightRows& piece : rows.pieces()) {
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t size = piece.rows.size();
      groups[part].add(*piece.flight,
                       {piece.rows.begin + part * size / parts, piece.rows.begin + (part + 1) * size / parts});
    }
  }
  return groups;
}

/// A row's regression targets, of its standardised outputs y and its commands.
using RegressionTarget = std::function<std::vector<double>(const double* y, const Commands<double>& commands)>;

/// Sums over `rows` of standardised features and of `targets` numbers, `target(y, commands)`, a row.
inline RegressionSums regression_sums(const FitContext& context, const RowSet& rows, int targets,
                                      const RegressionTarget& target) {
  RegressionSums sums(context.inputs(), targets);
  context.each_standardised(rows, [&](const Flight& flight, std::size_t row, const double* x, const double* y) {
    sums.add(x, target(y, flight[row].commands).data());
  });
  return sums;
}

/// Sums of standardised features and outputs.
inline RegressionSums regression_sums(const FitContext& context, const RowSet& rows) {
  RegressionSums sums(context.inputs(), context.outputs());
  context.each_standardised(rows,
                            [&](const Flight&, std::size_t, const double* x, const double* y) { sums.add(x, y); });
  return sums;
}

/// The same of each group that has rows with all features.
inline std::vector<RegressionSums> regression_sums(const FitContext& context, const std::vector<RowSet>& groups) {
  std::vector<RegressionSums> sums;
  for (const RowSet& group : groups) {
    RegressionSums of_group = regression_sums(context, group);
    if (of_group.rows() > 0) sums.push_back(std::move(of_group));
  }
  return sums;
}

/// The same of a context of types, for one set of rows or for groups.
template <class ContextType, class Rows>
auto regression_sums(const ContextType& context, const Rows& rows) {
  return regression_sums(fit_context(context), rows);
}

/// The sizes and scales of a base, without its types: the equations are compiled once for all feature sets.
struct MonotoneShape {
  int inputs = 0;
  std::vector<int> places;  ///< of each tap's angular acceleration among the features, the present first
  std::vector<double> input_deviation, output_deviation;
  AxisSlopes airframe_slopes{};  ///< hover_slopes()
  /// Features that a gyro's or an accelerometer's noise is in, by their units. None of a window: its taps would be
  /// their own instruments.
  std::vector<int> noisy;
  std::vector<int> thrusts;  ///< places of each tap's specific force along the thrust axis, the present first
  double held_thrust = 0;    ///< what a window's thrust slope, the sum over all taps, is held at, s^2/m; 0: learnt
};

/// The places and scales of a context's features, as the equations of the fit read them.
inline MonotoneShape monotone_shape(const FitContext& context) {
  MonotoneShape shape;
  shape.inputs = context.inputs();
  shape.places = context.accelerations;
  shape.input_deviation = context.input_deviation;
  shape.output_deviation = context.output_deviation;
  shape.airframe_slopes = hover_slopes(context.airframe);
  shape.thrusts = context.thrusts;
  for (int i = 0; i < shape.inputs && !context.is_windowed(); ++i) {
    const std::string_view unit = context.units[static_cast<std::size_t>(i)];
    if (unit == "m/s^2" || unit == "rad/s" || unit == "rad/s^2" || unit == "rad^2/s^2") shape.noisy.push_back(i);
  }
  return shape;
}
/// The same for a context whose types are known.
template <class ContextType>
MonotoneShape monotone_shape(const ContextType& context) {
  static_assert(is_signed_sums<typename ContextType::Outputs>,
                "pinnquad: a monotone base answers signed sums: Context<Features, Vehicle, AxisCommandOutputs>");
  return monotone_shape(fit_context(context));
}

namespace detail {

/// All but the angular accelerations about the other axes.
inline std::vector<bool> features_of_output(const MonotoneShape& shape, int output) {
  std::vector<bool> taken(static_cast<std::size_t>(shape.inputs), true);
  for (const int place : shape.places) {
    for (int i = 0; i < 3; ++i) taken[static_cast<std::size_t>(place + i)] = i == output - 1;
  }
  return taken;
}

/// Of an axis command; of the sum of the commands where a window's is held. See fit_monotone_base().
inline std::vector<WeightBound> slope_bounds(const MonotoneShape& shape, int output,
                                             const std::optional<AxisSlopes>& pinned) {
  constexpr double least_share = 0.01;
  const int axis = output - 1;
  const auto factor = [&](int place) {
    return shape.output_deviation[static_cast<std::size_t>(output)] /
           shape.input_deviation[static_cast<std::size_t>(place)];
  };
  if (axis < 0) {
    if (!(shape.held_thrust > 0)) return {};
    WeightBound held{{}, -shape.held_thrust, true};  // the specific force of thrust is below 0
    for (const int place : shape.thrusts) held.terms.emplace_back(place, factor(place));
    return {held};
  }
  const auto of_axis = static_cast<std::size_t>(axis);
  const double least = least_share * shape.airframe_slopes[of_axis];
  if (!(least > 0) || (pinned && !((*pinned)[of_axis] > least))) {
    throw std::invalid_argument("monotone base: expected slopes above 0 and above the least share of the airframe's");
  }
  WeightBound present, held;
  for (const int place : shape.places) {
    if (held.terms.empty()) present.terms.emplace_back(place + axis, factor(place + axis));
    held.terms.emplace_back(place + axis, factor(place + axis));
  }
  present.least = held.least = least;
  if (pinned) {
    held.pinned = true;
    held.least = (*pinned)[of_axis];
  }
  return shape.places.size() > 1 ? std::vector{held, present} : std::vector{held};
}

}  // namespace detail

/// The base of a structured model: per axis command a ridge regression that sees its own angular acceleration alone,
/// with a slope above 0. Standardised features to standardised axis commands. Each penalty is chosen by leaving out one
/// group in turn. A slope is learnt, and at least a hundredth of the airframe's own, also where the rows say otherwise.
/// `pinned`, s^2/rad, fixes it, such as at hover_slopes() for a model of quiet flights that is to fly agile ones. In a
/// window this holds for the slope of the present and for the sum over all taps; `pinned` is the sum. Throws
/// std::invalid_argument for no rows, and for pinned slopes that are not above this hundredth.
inline AffineMap fit_monotone_base(const MonotoneShape& shape, const std::vector<RegressionSums>& groups,
                                   const std::optional<AxisSlopes>& pinned = {}) {
  if (groups.empty()) throw std::invalid_argument("monotone base: expected rows with all features, found none");
  AffineMap all;
  all.inputs = shape.inputs;
  all.outputs = AxisCommandOutputs::size;
  for (int output = 0; output < all.outputs; ++output) {
    const std::vector<bool> taken = detail::features_of_output(shape, output);
    const std::vector<detail::WeightBound> bounds = detail::slope_bounds(shape, output, pinned);
    std::vector<RegressionSums> parts;
    for (const RegressionSums& group : groups) parts.push_back(group.of_output(output));
    const double penalty = parts.size() < 2 ? 0.0 : choose_penalty(parts, usual_penalties(), taken);
    const AffineMap one = fit_bounded_ridge(detail::total(parts), penalty, taken, bounds);
    all.weights.insert(all.weights.end(), one.weights.begin(), one.weights.end());
    all.intercept.push_back(one.intercept.front());
  }
  return all;
}

/// The same from rows, in the groups of left_out_groups().
template <class ContextType>
AffineMap fit_monotone_base(const ContextType& context, const RowSet& rows,
                            const std::optional<AxisSlopes>& pinned = {}) {
  return fit_monotone_base(monotone_shape(context), regression_sums(context, left_out_groups(rows)), pinned);
}

/// The parameters of the MonotoneBase of such a map. `accelerations`: FitContext's.
inline std::vector<float> base_parameters(const std::vector<int>& accelerations, const AffineMap& map) {
  const auto weight = [&](int output, int feature) {
    return static_cast<float>(map.weights.at(static_cast<std::size_t>(output * map.inputs + feature)));
  };
  std::vector<float> parameters;
  for (const int place : accelerations) {
    for (int axis = 0; axis < 3; ++axis) parameters.push_back(weight(1 + axis, place + axis));
  }
  const std::vector<int> others = detail::other_features(map.inputs, accelerations);
  for (int output = 0; output < map.outputs; ++output) {
    for (const int feature : others) parameters.push_back(weight(output, feature));
  }
  for (const double intercept : map.intercept) parameters.push_back(static_cast<float>(intercept));
  return parameters;
}

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
