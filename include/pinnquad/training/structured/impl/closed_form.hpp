// SPDX-License-Identifier: MIT
// Bodies of closed_form.hpp.
#pragma once

#include "pinnquad/training/structured/closed_form.hpp"

namespace pinnquad {

PINNQUAD_BODY std::vector<RowSet> whole_flight_groups(const RowSet& rows) {
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

PINNQUAD_BODY std::vector<RowSet> left_out_groups(const RowSet& rows) {
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

PINNQUAD_BODY RegressionSums
regression_sums(const FitContext& context, const RowSet& rows, int targets,
                const std::function<std::vector<double>(const double* y, const Commands<double>& commands)>& target) {
  RegressionSums sums(context.inputs(), targets);
  context.each_standardised(rows, [&](const Flight& flight, std::size_t row, const double* x, const double* y) {
    sums.add(x, target(y, flight[row].commands).data());
  });
  return sums;
}

PINNQUAD_BODY RegressionSums regression_sums(const FitContext& context, const RowSet& rows) {
  RegressionSums sums(context.inputs(), context.outputs());
  context.each_standardised(rows,
                            [&](const Flight&, std::size_t, const double* x, const double* y) { sums.add(x, y); });
  return sums;
}

PINNQUAD_BODY std::vector<RegressionSums> regression_sums(const FitContext& context,
                                                          const std::vector<RowSet>& groups) {
  std::vector<RegressionSums> sums;
  for (const RowSet& group : groups) {
    RegressionSums of_group = regression_sums(context, group);
    if (of_group.rows() > 0) sums.push_back(std::move(of_group));
  }
  return sums;
}

namespace detail {

PINNQUAD_BODY std::vector<bool> features_of_output(const FitContext& context, int output) {
  std::vector<bool> taken(static_cast<std::size_t>(context.inputs()), true);
  for (const int place : context.features.accelerations) {
    for (int i = 0; i < 3; ++i) taken[static_cast<std::size_t>(place + i)] = i == output - 1;
  }
  return taken;
}

PINNQUAD_BODY std::vector<std::pair<int, double>> slope_terms(const FitContext& context, int output) {
  std::vector<std::pair<int, double>> terms;
  for (const int tap : output == 0 ? context.features.thrusts() : context.features.accelerations) {
    const int place = output == 0 ? tap : tap + output - 1;
    terms.emplace_back(place, context.output_deviation[static_cast<std::size_t>(output)] /
                                  context.input_deviation[static_cast<std::size_t>(place)]);
  }
  return terms;
}

PINNQUAD_BODY std::vector<WeightBound> slope_bounds(const FitContext& context, int output,
                                                    const std::optional<AxisSlopes>& pinned, double held_thrust) {
  constexpr double least_share = least_fitted_slope_share;
  WeightBound held{slope_terms(context, output), -held_thrust, true};  // the specific force of thrust is below 0
  if (output == 0) return held_thrust > 0 ? std::vector{held} : std::vector<WeightBound>{};
  const auto of_axis = static_cast<std::size_t>(output - 1);
  const double least = least_share * hover_slopes(context.airframe)[of_axis];
  if (!(least > 0) || (pinned && !((*pinned)[of_axis] > least))) {
    throw std::invalid_argument("monotone base: expected slopes above 0 and above the least share of the airframe's");
  }
  held.pinned = pinned.has_value();
  held.least = pinned ? (*pinned)[of_axis] : least;
  return held.terms.size() > 1 ? std::vector{held, WeightBound{{held.terms.front()}, least}} : std::vector{held};
}

}  // namespace detail

PINNQUAD_BODY AffineMap fit_monotone_base(const FitContext& context, const std::vector<RegressionSums>& groups,
                                          const std::optional<AxisSlopes>& pinned, double held_thrust) {
  if (groups.empty()) throw std::invalid_argument("monotone base: expected rows with all features, found none");
  AffineMap all;
  all.inputs = context.inputs();
  all.outputs = AxisCommandOutputs::size;
  for (int output = 0; output < all.outputs; ++output) {
    const std::vector<bool> taken = detail::features_of_output(context, output);
    const std::vector<detail::WeightBound> bounds = detail::slope_bounds(context, output, pinned, held_thrust);
    std::vector<RegressionSums> parts;
    for (const RegressionSums& group : groups) parts.push_back(group.of_output(output));
    const double penalty = parts.size() < 2 ? 0.0 : choose_penalty(parts, usual_penalties(), taken);
    const AffineMap one = fit_bounded_ridge(detail::total(parts), penalty, taken, bounds);
    all.weights.insert(all.weights.end(), one.weights.begin(), one.weights.end());
    all.intercept.push_back(one.intercept.front());
  }
  return all;
}

PINNQUAD_BODY std::vector<float> base_parameters(const std::vector<int>& accelerations, const AffineMap& map) {
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

}  // namespace pinnquad
