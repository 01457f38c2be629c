// SPDX-License-Identifier: MIT
// Models that are solved rather than trained: a context's rows as sums for least squares (regression/ridge.hpp), and an
// affine map as the answer of a model, which is exported, guarded and tested as a network is.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/dynamics/rotor.hpp"
#include "pinnquad/model/predictor.hpp"
#include "pinnquad/regression/regression_sums.hpp"
#include "pinnquad/training/trained_model.hpp"

namespace pinnquad {

/// An affine map of a context's features to its outputs.
template <class ContextType, class Scalar = float>
using AffineAnswer = Network<Scalar, InputSize<ContextType::Features::size>, Dense<ContextType::output_count>>;

template <class ContextType, class Scalar = float>
AffineAnswer<ContextType, Scalar> affine_answer(const AffineMap& map) {
  AffineAnswer<ContextType, Scalar> answer;
  if (map.weights.size() + map.intercept.size() != answer.parameters.size() || map.inputs != answer.inputs) {
    throw std::invalid_argument("affine_answer: expected a map of " + std::to_string(answer.inputs) + " features to " +
                                std::to_string(answer.outputs) + " outputs, found another");
  }
  auto to = answer.parameters.begin();
  for (const double v : map.weights) *to++ = static_cast<Scalar>(v);
  for (const double v : map.intercept) *to++ = static_cast<Scalar>(v);
  return answer;
}

/// The sum of two answers with their parameters: an affine map and what a network learnt of its residuals.
template <class First, class Second>
Sum<First, Second> sum_of(const First& first, const Second& second) {
  Sum<First, Second> sum;
  const auto border = std::copy(first.parameters.begin(), first.parameters.end(), sum.parameters.begin());
  std::copy(second.parameters.begin(), second.parameters.end(), border);
  return sum;
}

/// What `map` leaves of standardised rows: their outputs less the map's.
template <class Scalar, int InputCount, int OutputCount>
void take_away(const AffineMap& map, TrainingData<Scalar, InputCount, OutputCount>& data) {
  std::array<double, static_cast<std::size_t>(InputCount)> x{};
  for (int row = 0; row < data.size(); ++row) {
    const Scalar* features = data.features_of(row);
    std::copy(features, features + InputCount, x.begin());
    const std::vector<double> said = map(x.data());
    Scalar* outputs = data.outputs.data() + std::ptrdiff_t{row} * OutputCount;
    for (int k = 0; k < OutputCount; ++k) outputs[k] -= static_cast<Scalar>(said[static_cast<std::size_t>(k)]);
  }
}

/// Rows in groups of which one is left out in turn: trajectories with their repeats, else (all are of one trajectory) flights,
/// else quarters of the flight.
inline std::vector<RowSet> left_out_groups(const RowSet& rows) {
  const auto grouped = [&](const auto& name_of) {
    std::vector<RowSet> groups;
    std::vector<std::string> names;
    for (const FlightRows& piece : rows.pieces()) {
      const std::string name = name_of(*piece.flight);
      const auto found = std::find(names.begin(), names.end(), name);
      const auto at = static_cast<std::size_t>(found - names.begin());
      if (found == names.end()) {
        names.push_back(name);
        groups.emplace_back();
      }
      groups[at].add(*piece.flight, piece.rows);
    }
    return groups;
  };
  std::vector<RowSet> groups = grouped([](const Flight& flight) {
    return flight.trajectory.empty() ? "flight " + flight.name : "trajectory " + flight.trajectory;
  });
  if (groups.size() > 1) return groups;
  groups = grouped([](const Flight& flight) { return flight.name; });
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

/// Sums of standardised features and of what `target(y, commands)` makes of them: y standardised outputs.
template <class ContextType, class Target>
RegressionSums regression_sums(const ContextType& context, const RowSet& rows, int targets, const Target& target) {
  using Features = typename ContextType::Features;
  RegressionSums sums(Features::size, targets);
  const auto setting = context.template output_setting<typename ContextType::Outputs, double>();
  each_features<Features, double>(rows, [&](const Flight& flight, std::size_t row, auto x) {
    auto y = detail::sample_outputs<ContextType>(x, flight[row], setting);
    context.input.standardise(x.data(), x.data());
    context.output.standardise(y.data(), y.data());
    const std::vector<double> values = target(y, flight[row].commands);
    sums.add(x.data(), values.data());
  });
  return sums;
}

/// Of standardised features and outputs.
template <class ContextType>
RegressionSums regression_sums(const ContextType& context, const RowSet& rows) {
  return regression_sums(context, rows, ContextType::output_count, [](const auto& y, const Commands<double>&) {
    return std::vector<double>(y.begin(), y.end());
  });
}

/// The same of each group that has features.
template <class ContextType>
std::vector<RegressionSums> regression_sums(const ContextType& context, const std::vector<RowSet>& groups) {
  std::vector<RegressionSums> sums;
  for (const RowSet& group : groups) {
    RegressionSums of_group = regression_sums(context, group);
    if (of_group.rows() > 0) sums.push_back(of_group);
  }
  return sums;
}

}  // namespace pinnquad
