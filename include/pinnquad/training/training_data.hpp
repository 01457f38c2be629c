// SPDX-License-Identifier: MIT
// Flights as rows for the trainer: standardised features and outputs, and the context that says how they were
// standardised. Each function takes a set of rows, or a flight and a range of its rows.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/training/context.hpp"
#include "pinnquad/training/resolution.hpp"

namespace pinnquad {

/// Rows of standardised features and outputs, row-major.
template <class Scalar, int InputCount, int OutputCount>
struct TrainingData {
  std::vector<Scalar> features;  ///< size() x InputCount
  std::vector<Scalar> outputs;   ///< size() x OutputCount
  std::vector<double> weights;   ///< size(), those of the flights; empty where all are 1. Read by an order of one's own

  int size() const noexcept { return static_cast<int>(outputs.size()) / OutputCount; }
  const Scalar* features_of(int row) const noexcept { return features.data() + std::ptrdiff_t{row} * InputCount; }
  const Scalar* outputs_of(int row) const noexcept { return outputs.data() + std::ptrdiff_t{row} * OutputCount; }
};

namespace detail {

/// Outputs of a sample with these features in the schema's physical units. `setting`:
/// ContextAirframe::output_setting().
template <class ContextType, class FeatureVector, class Setting>
std::array<double, static_cast<std::size_t>(ContextType::output_count)> sample_outputs(const FeatureVector& x,
                                                                                       const Sample& sample,
                                                                                       const Setting& setting) {
  using Map = OutputMap<typename ContextType::Outputs>;
  std::array<double, static_cast<std::size_t>(Map::size)> outputs{};
  Map::from_commands(x.data(), sample.commands.data(), setting, outputs.data());
  return outputs;
}

/// Statistics of every feature, physical units.
template <class Features>
std::array<ColumnStatistics, static_cast<std::size_t>(Features::size)> feature_statistics(const RowSet& rows) {
  constexpr auto size = static_cast<std::size_t>(Features::size);
  return column_statistics<size>(
      [&](const auto& visit) {
        each_features<Features, double>(rows, [&](const Flight&, std::size_t, const auto& x) { visit(x); });
      },
      [](std::size_t i) { return Features::units[i]; });
}

}  // namespace detail

/// Names of the features that stand still in the training rows (training/resolution.hpp): the network can't learn their
/// effect, and its model is valid only where they stay.
template <class Features>
std::vector<std::string> still_features(const RowSet& training) {
  const auto columns = detail::feature_statistics<Features>(training);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].still()) names.emplace_back(Features::names[i]);
  }
  return names;
}
template <class Features>
std::vector<std::string> still_features(const Flight& flight, const IndexRange& training) {
  return still_features<Features>(RowSet(flight, training));
}

/// The context of a training set: scalers of its rows. A column that stands still is divided by 1.
/// Flights count by their rows, whatever their weights. `airframe`: where the context's Vehicle is a GivenAirframe.
template <class ContextType>
ContextType make_context(const RowSet& rows, const ContextAirframe<typename ContextType::Vehicle>& airframe) {
  using Features = typename ContextType::Features;
  constexpr auto inputs = static_cast<std::size_t>(Features::size);
  constexpr std::size_t outputs = std::size_t(ContextType::output_count), axes = 3;
  const std::array<std::array<double, rotor_count>, axes> signs = {
      airframe.template signs<Roll>(), airframe.template signs<Pitch>(), airframe.template signs<Yaw>()};
  const auto setting = airframe.template output_setting<typename ContextType::Outputs, double>();
  // one table: features, outputs, signed sums of the commands
  const auto each_row = [&](const auto& visit) {
    each_features<Features, double>(rows, [&](const Flight& flight, std::size_t row, const auto& x) {
      const Sample& sample = flight[row];
      const auto y = detail::sample_outputs<ContextType>(x, sample, setting);
      std::array<double, inputs + outputs + axes> values{};
      for (std::size_t i = 0; i < inputs; ++i) values[i] = x[i];
      for (std::size_t i = 0; i < outputs; ++i) values[inputs + i] = y[i];
      for (std::size_t i = 0; i < axes; ++i) values[inputs + outputs + i] = signed_sum(signs[i], sample.commands);
      visit(values);
    });
  };
  const auto unit_of = [](std::size_t i) {
    if (i < inputs) return Features::units[i];
    return i < inputs + outputs ? OutputMap<typename ContextType::Outputs>::units[i - inputs] : CommandOutputs::unit;
  };
  const auto columns = column_statistics<inputs + outputs + axes>(each_row, unit_of);
  ContextType context{airframe};
  for (std::size_t i = 0; i < inputs; ++i) {
    context.input.mean[i] = columns[i].mean;
    context.input.standard_deviation[i] = columns[i].scale();
  }
  for (std::size_t i = 0; i < outputs; ++i) {
    context.output.mean[i] = columns[inputs + i].mean;
    context.output.standard_deviation[i] = columns[inputs + i].scale();
  }
  for (std::size_t i = 0; i < axes; ++i) context.signed_sum_spread[i] = columns[inputs + outputs + i].scale();
  return context;
}
template <class ContextType>
ContextType make_context(const RowSet& rows) {
  return make_context<ContextType>(rows, ContextAirframe<typename ContextType::Vehicle>{});
}
template <class ContextType>
ContextType make_context(const Flight& flight, const IndexRange& range) {
  return make_context<ContextType>(RowSet(flight, range));
}

/// Rows, standardised by a context (that of the training set, for every block), with the weights of their flights.
template <class Scalar, class ContextType>
TrainingData<Scalar, ContextType::Features::size, ContextType::output_count> standardised(const ContextType& context,
                                                                                          const RowSet& rows) {
  using Features = typename ContextType::Features;
  TrainingData<Scalar, Features::size, ContextType::output_count> data;
  data.features.reserve(rows.size() * static_cast<std::size_t>(Features::size));
  data.outputs.reserve(rows.size() * static_cast<std::size_t>(ContextType::output_count));
  const bool weighted = std::any_of(rows.pieces().begin(), rows.pieces().end(),
                                    [](const FlightRows& piece) { return piece.flight->weight != 1; });
  const auto setting = context.template output_setting<typename ContextType::Outputs, double>();
  each_features<Features, double>(rows, [&](const Flight& flight, std::size_t row, auto x) {
    auto y = detail::sample_outputs<ContextType>(x, flight[row], setting);
    context.input.standardise(x.data(), x.data());
    context.output.standardise(y.data(), y.data());
    for (const double v : x) data.features.push_back(static_cast<Scalar>(v));
    for (const double v : y) data.outputs.push_back(static_cast<Scalar>(v));
    if (weighted) data.weights.push_back(flight.weight);
  });
  return data;
}
template <class Scalar, class ContextType>
TrainingData<Scalar, ContextType::Features::size, ContextType::output_count> standardised(const ContextType& context,
                                                                                          const Flight& flight,
                                                                                          const IndexRange& range) {
  return standardised<Scalar>(context, RowSet(flight, range));
}

}  // namespace pinnquad
