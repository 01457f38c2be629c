// SPDX-License-Identifier: MIT
// Flights as rows for the trainer: standardised features and outputs, and the context that says how they were
// standardised.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/loss/context.hpp"

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

/// In the unit itself.
struct Resolution {
  double smallest_deviation;  ///< a standard deviation below this is rounding or noise
  double still_margin;        ///< how far a quantity that stood still may be from where it stood
};

/// Smallest standard deviation by which a quantity with this unit (of a feature set or an output schema) is divided:
///   unit      m/s^2  rad/s^2  m/s   rad/s  rad    1       m     rev/s  V
///   smallest  0.01   0.01     0.01  0.001  0.001  0.0001  0.01  0.01   0.01
///   margin    0.2    0.5      0.1   0.05   0.05   0.05    0.2   0.5    0.5
/// Any other unit: a millionth and a hundredth of |mean|, of 1 for a smaller mean. No smallest deviation is below a
/// millionth of |mean|: a float's rounding.
Resolution resolution_of(std::string_view unit, double mean);

/// By how many half-widths of its range a feature of this unit reaches beyond it on both sides, in a model that is
/// affine but for a bounded residual: a motion twice as great as any that was flown, of which squares and products are
/// four times as great. A height above the ground reaches nowhere: ground effect is not affine in it.
constexpr double affine_reach(std::string_view unit) noexcept {
  if (unit == "m") return 0;
  return unit == "m^2/s^2" || unit == "rad^2/s^2" ? 3 : 1;
}

/// Statistics of a column of training rows.
struct ColumnStatistics {
  double mean = 0;
  double standard_deviation = 0;  ///< divisor n
  double lowest = 0;
  double highest = 0;
  Resolution resolution{0, 0};

  bool still() const noexcept { return !(standard_deviation >= resolution.smallest_deviation); }

  /// Divisor of the column: 1 if it stands still.
  double scale() const noexcept { return still() ? 1.0 : standard_deviation; }

  /// By how much the envelope is wider than the range, on both sides: a tenth of the range or what the model reaches,
  /// in half-widths; no less than the smallest deviation, or than the still margin if the column stands still.
  double margin(double reach = 0) const noexcept {
    constexpr double least_reach = 0.2;
    const double least = still() ? resolution.still_margin : resolution.smallest_deviation;
    const double share = std::max(reach, least_reach) * (highest - lowest) / 2;
    return share > least ? share : least;
  }
};

/// Statistics of every column of a table that is made row by row and never held, by two passes: `each_row(visit)` calls
/// `visit(row)` for every row, the same ones in the same order each time, with a number for each of the units.
using RowVisit = std::function<void(const double* row)>;
std::vector<ColumnStatistics> column_statistics(const std::vector<std::string_view>& units,
                                                const std::function<void(const RowVisit&)>& each_row);

/// Outputs of a sample with these features in the schema's physical units. `setting`: the context's output_setting().
template <class ContextType, class FeatureVector, class Setting>
std::array<double, static_cast<std::size_t>(ContextType::output_count)> sample_outputs(const FeatureVector& x,
                                                                                       const Sample& sample,
                                                                                       const Setting& setting) {
  using Map = OutputMap<typename ContextType::Outputs>;
  std::array<double, static_cast<std::size_t>(Map::size)> outputs{};
  Map::from_commands(x.data(), sample.commands.data(), setting, outputs.data());
  return outputs;
}

/// Calls `visit(flight, row, x, y)` for every row that has features: these and the outputs, both standardised.
template <class ContextType, class Visit>
void each_standardised(const ContextType& context, const RowSet& rows, const Visit& visit) {
  const auto setting = context.template output_setting<typename ContextType::Outputs, double>();
  each_features<typename ContextType::Features, double>(rows, [&](const Flight& flight, std::size_t row, auto x) {
    auto y = sample_outputs<ContextType>(x, flight[row], setting);
    context.input.standardise(x.data(), x.data());
    context.output.standardise(y.data(), y.data());
    visit(flight, row, x, y);
  });
}

/// Statistics of every feature, physical units.
template <class Features>
std::vector<ColumnStatistics> feature_statistics(const RowSet& rows) {
  return column_statistics({Features::units.begin(), Features::units.end()}, [&](const RowVisit& visit) {
    each_features<Features, double>(rows, [&](const Flight&, std::size_t, const auto& x) { visit(x.data()); });
  });
}

}  // namespace detail

/// Names of the features that stand still in the training rows (detail::resolution_of()): the network can't learn their
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

/// The context of a training set: scalers of its rows. A column that stands still is divided by 1.
/// Flights count by their rows, whatever their weights. `airframe`: a value of the context's Vehicle, for a
/// GivenAirframe; of another there is nothing to give.
template <class ContextType>
ContextType make_context(const RowSet& rows,
                         const detail::ContextAirframe<typename ContextType::Vehicle>& airframe = {}) {
  using Features = typename ContextType::Features;
  constexpr auto inputs = static_cast<std::size_t>(Features::size);
  constexpr std::size_t outputs = std::size_t(ContextType::output_count), axes = 3;
  const std::array<std::array<double, rotor_count>, axes> signs = {
      airframe.template signs<Roll>(), airframe.template signs<Pitch>(), airframe.template signs<Yaw>()};
  const auto setting = airframe.template output_setting<typename ContextType::Outputs, double>();
  // one table: features, outputs, signed sums of the commands
  std::vector<std::string_view> units(Features::units.begin(), Features::units.end());
  units.insert(units.end(), OutputMap<typename ContextType::Outputs>::units.begin(),
               OutputMap<typename ContextType::Outputs>::units.end());
  units.insert(units.end(), axes, CommandOutputs::units[0]);
  const auto columns = detail::column_statistics(units, [&](const detail::RowVisit& visit) {
    each_features<Features, double>(rows, [&](const Flight& flight, std::size_t row, const auto& x) {
      const Sample& sample = flight[row];
      const auto y = detail::sample_outputs<ContextType>(x, sample, setting);
      std::array<double, inputs + outputs + axes> values{};
      for (std::size_t i = 0; i < inputs; ++i) values[i] = x[i];
      for (std::size_t i = 0; i < outputs; ++i) values[inputs + i] = y[i];
      for (std::size_t i = 0; i < axes; ++i) values[inputs + outputs + i] = signed_sum(signs[i], sample.commands);
      visit(values.data());
    });
  });
  ContextType context{airframe};
  for (std::size_t i = 0; i < inputs; ++i) {
    context.input.mean[i] = columns[i].mean;
    context.input.standard_deviation[i] = columns[i].scale();
  }
  for (std::size_t i = 0; i < outputs; ++i) {
    context.output.mean[i] = columns[inputs + i].mean;
    context.output.standard_deviation[i] = columns[inputs + i].scale();
  }
  for (std::size_t i = 0; i < axes; ++i) context.signed_sum_deviation[i] = columns[inputs + outputs + i].scale();
  return context;
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
  detail::each_standardised(context, rows, [&](const Flight& flight, std::size_t, const auto& x, const auto& y) {
    for (const double v : x) data.features.push_back(static_cast<Scalar>(v));
    for (const double v : y) data.outputs.push_back(static_cast<Scalar>(v));
    if (weighted) data.weights.push_back(flight.weight);
  });
  return data;
}

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/training/impl/training_data.hpp"
#endif
