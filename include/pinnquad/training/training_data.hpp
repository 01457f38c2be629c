// SPDX-License-Identifier: MIT
// A flight as the trainer wants it: standardised features and outputs, and the context that knows what they mean.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/sample_inputs.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/training/context.hpp"
#include "pinnquad/training/resolution.hpp"

namespace pinnquad {

/// Rows of standardised features and outputs, row-major.
template <class Scalar, int InputCount, int OutputCount>
struct TrainingData {
  std::vector<Scalar> features;  ///< size() x InputCount
  std::vector<Scalar> outputs;   ///< size() x OutputCount

  int size() const noexcept { return static_cast<int>(outputs.size()) / OutputCount; }
  const Scalar* features_of(int row) const noexcept { return features.data() + std::ptrdiff_t{row} * InputCount; }
  const Scalar* outputs_of(int row) const noexcept { return outputs.data() + std::ptrdiff_t{row} * OutputCount; }
};

namespace detail {

/// Mean and scale of every column; `unit_of(i)` is the unit of column i.
template <std::size_t Size, class UnitOf>
Scaler<double, static_cast<int>(Size)> column_scaler(const std::vector<std::array<double, Size>>& rows,
                                                     const UnitOf& unit_of) {
  Scaler<double, static_cast<int>(Size)> scaler;
  for (std::size_t i = 0; i < Size; ++i) {
    const ColumnStatistics column = column_statistics(rows, i, unit_of(i));
    scaler.mean[i] = column.mean;
    scaler.spread[i] = column.scale();
  }
  return scaler;
}

/// Feature vectors of a block of rows, physical units.
template <class Features>
std::vector<std::array<double, static_cast<std::size_t>(Features::size)>> feature_rows(const Flight& flight,
                                                                                       const IndexRange& range) {
  std::vector<std::array<double, static_cast<std::size_t>(Features::size)>> rows;
  rows.reserve(range.size());
  for (std::size_t row = range.begin; row < range.end; ++row) {
    rows.push_back(sample_features<Features, double>(flight[row]));
  }
  return rows;
}

/// Outputs of a sample in the schema's physical units.
template <class ContextType>
std::array<double, static_cast<std::size_t>(ContextType::output_count)> sample_outputs(const Sample& sample) {
  using Map = OutputMap<typename ContextType::Outputs>;
  constexpr auto setting = Map::setting(airframe_value<typename ContextType::Vehicle, double>());
  std::array<double, static_cast<std::size_t>(Map::size)> outputs{};
  const auto x = sample_features<typename ContextType::Features, double>(sample);
  Map::from_commands(x.data(), sample.commands.data(), setting, outputs.data());
  return outputs;
}

}  // namespace detail

/// Names of the features that stand still in the training rows (training/resolution.hpp): the network can't learn what they
/// do, and its model answers only where they stay.
template <class Features>
std::vector<std::string> still_features(const Flight& flight, const IndexRange& training) {
  const auto rows = detail::feature_rows<Features>(flight, training);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < static_cast<std::size_t>(Features::size); ++i) {
    if (column_statistics(rows, i, Features::units[i]).still()) names.emplace_back(Features::names[i]);
  }
  return names;
}

/// The context of a training set: scalers and spreads of its rows. A column that stands still gets the spread 1.
template <class ContextType>
ContextType make_context(const Flight& flight, const IndexRange& range) {
  using Features = typename ContextType::Features;
  std::vector<std::array<double, static_cast<std::size_t>(ContextType::output_count)>> outputs;
  std::vector<std::array<double, 3>> sums;
  const std::array<std::array<double, rotor_count>, 3> signs = {
      ContextType::template signs<Roll>(), ContextType::template signs<Pitch>(), ContextType::template signs<Yaw>()};
  for (std::size_t row = range.begin; row < range.end; ++row) {
    outputs.push_back(detail::sample_outputs<ContextType>(flight[row]));
    std::array<double, 3> sum{};
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] = signed_sum(signs[axis], flight[row].commands);
    sums.push_back(sum);
  }
  ContextType context;
  const auto feature_unit = [](std::size_t i) { return Features::units[i]; };
  const auto output_unit = [](std::size_t i) { return OutputMap<typename ContextType::Outputs>::units[i]; };
  context.input = detail::column_scaler(detail::feature_rows<Features>(flight, range), feature_unit);
  context.output = detail::column_scaler(outputs, output_unit);
  context.signed_sum_spread = detail::column_scaler(sums, [](std::size_t) { return CommandOutputs::unit; }).spread;
  return context;
}

/// Rows of a flight, standardised by a context (that of the training set, for every block).
template <class Scalar, class ContextType>
TrainingData<Scalar, ContextType::Features::size, ContextType::output_count> standardised(const ContextType& context,
                                                                                          const Flight& flight,
                                                                                          const IndexRange& range) {
  using Features = typename ContextType::Features;
  TrainingData<Scalar, Features::size, ContextType::output_count> data;
  data.features.reserve(range.size() * static_cast<std::size_t>(Features::size));
  data.outputs.reserve(range.size() * static_cast<std::size_t>(ContextType::output_count));
  for (std::size_t row = range.begin; row < range.end; ++row) {
    auto x = sample_features<Features, double>(flight[row]);
    auto y = detail::sample_outputs<ContextType>(flight[row]);
    context.input.standardise(x.data(), x.data());
    context.output.standardise(y.data(), y.data());
    for (const double v : x) data.features.push_back(static_cast<Scalar>(v));
    for (const double v : y) data.outputs.push_back(static_cast<Scalar>(v));
  }
  return data;
}

}  // namespace pinnquad
