// SPDX-License-Identifier: MIT
// The base of a monotone model in closed form: for each signed sum of the commands a ridge regression that sees its own
// angular acceleration alone, its slope learnt and held above 0, or pinned.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "pinnquad/model/axis_aligned.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"
#include "pinnquad/outputs/hover_slopes.hpp"
#include "pinnquad/regression/bounded_ridge.hpp"
#include "pinnquad/training/closed_form.hpp"

namespace pinnquad {

/// Where the slopes of a base come from.
struct SlopeRule {
  /// Slopes to keep, such as hover_slopes(): for a model of quiet flights that is to fly agile ones. None: learnt.
  std::optional<AxisSlopes> pinned{};
  /// A slope that is learnt is at least this share of the airframe's own, also where the rows say otherwise.
  double least_share = 0.01;
};

/// What a base is fitted by, but for the rows: the same for all feature sets, so that the equations are compiled once.
struct MonotoneShape {
  int inputs = 0;
  std::vector<int> places;  ///< of each tap's angular acceleration among the features, the present first
  std::vector<double> input_spread, output_spread;
  AxisSlopes airframe_slopes{};  ///< hover_slopes()
};

template <class ContextType>
MonotoneShape monotone_shape(const ContextType& context) {
  using Features = typename ContextType::Features;
  static_assert(is_signed_sums<typename ContextType::Outputs>,
                "pinnquad: a monotone base answers signed sums: Context<Features, Vehicle, AxisCommandOutputs>");
  MonotoneShape shape;
  shape.inputs = Features::size;
  MonotoneBase<Features>::Threes::each([&](int place, int) { shape.places.push_back(place); });
  shape.input_spread.assign(context.input.standard_deviation.begin(), context.input.standard_deviation.end());
  shape.output_spread.assign(context.output.standard_deviation.begin(), context.output.standard_deviation.end());
  shape.airframe_slopes = hover_slopes(context.template airframe<double>());
  return shape;
}

/// Of standardised features to standardised signed sums; each penalty by leaving out one of the groups in turn. Of a window
/// the slope of the present and the sum over all taps keep the rule; pinned is the sum. Throws std::invalid_argument for no
/// rows, and for a rule whose slopes are not above 0.
inline AffineMap fit_monotone_base(const MonotoneShape& shape, const std::vector<RegressionSums>& groups,
                                   const SlopeRule& rule = {}) {
  if (groups.empty()) throw std::invalid_argument("monotone base: expected rows with all features, found none");
  AffineMap all;
  all.inputs = shape.inputs;
  all.outputs = AxisCommandOutputs::size;
  for (int output = 0; output < all.outputs; ++output) {
    std::vector<bool> taken(static_cast<std::size_t>(shape.inputs), true);
    std::vector<WeightBound> bounds;
    const int axis = output - 1;
    for (const int place : shape.places) {
      for (int i = 0; i < 3; ++i) taken[static_cast<std::size_t>(place + i)] = i == axis;
    }
    if (axis >= 0) {
      const auto of_axis = static_cast<std::size_t>(axis);
      const double least = rule.least_share * shape.airframe_slopes[of_axis];
      if (!(least > 0) || (rule.pinned && !((*rule.pinned)[of_axis] > least))) {
        throw std::invalid_argument(
            "monotone base: expected slopes above 0 and above the least share of the airframe's");
      }
      WeightBound present, held;
      for (const int place : shape.places) {
        const auto feature = static_cast<std::size_t>(place + axis);
        const double factor = shape.output_spread[static_cast<std::size_t>(output)] / shape.input_spread[feature];
        if (held.terms.empty()) present.terms.emplace_back(place + axis, factor);
        held.terms.emplace_back(place + axis, factor);
      }
      present.least = held.least = least;
      if (rule.pinned) {
        held.pinned = true;
        held.least = (*rule.pinned)[of_axis];
      }
      bounds.push_back(held);
      if (shape.places.size() > 1) bounds.push_back(present);
    }
    std::vector<RegressionSums> parts;
    for (const RegressionSums& group : groups) parts.push_back(group.of_output(output));
    RegressionSums sums = parts.front();
    for (std::size_t i = 1; i < parts.size(); ++i) sums += parts[i];
    const double penalty = parts.size() < 2 ? 0.0 : choose_penalty(parts, usual_penalties(), taken).penalty;
    const AffineMap one = fit_bounded_ridge(sums, penalty, taken, bounds);
    all.weights.insert(all.weights.end(), one.weights.begin(), one.weights.end());
    all.intercept.push_back(one.intercept.front());
  }
  return all;
}

/// The same of rows, in the groups of left_out_groups().
template <class ContextType>
AffineMap fit_monotone_base(const ContextType& context, const RowSet& rows, const SlopeRule& rule = {}) {
  return fit_monotone_base(monotone_shape(context), regression_sums(context, left_out_groups(rows)), rule);
}

/// A map that keeps the structure, as an answer.
template <class ContextType, class Scalar = float>
MonotoneBase<typename ContextType::Features, Scalar> monotone_base(const AffineMap& map) {
  using Features = typename ContextType::Features;
  using Base = MonotoneBase<Features, Scalar>;
  Base base;
  const auto weight = [&](int output, int feature) {
    return static_cast<Scalar>(
        map.weights.at(static_cast<std::size_t>(output) * Features::size + static_cast<std::size_t>(feature)));
  };
  auto* const to = base.parameters.data();
  Base::Threes::each([&](int place, int tap) {
    for (int axis = 0; axis < 3; ++axis) to[Base::slopes + 3 * tap + axis] = weight(1 + axis, place + axis);
  });
  for (int output = 0; output < Base::outputs; ++output) {
    Base::Threes::each_other(
        [&](int feature, int n) { to[Base::weights + output * Base::Threes::others + n] = weight(output, feature); });
    to[Base::intercepts + output] = static_cast<Scalar>(map.intercept.at(static_cast<std::size_t>(output)));
  }
  return base;
}

}  // namespace pinnquad
