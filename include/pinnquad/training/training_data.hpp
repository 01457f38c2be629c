// SPDX-License-Identifier: MIT
// A flight as the trainer wants it: standardised features and outputs, and the context that knows what they mean.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/sample_inputs.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/loss/loss.hpp"

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

/// Mean and spread (divisor n) by two passes. A column that does not vary gets the spread 1.
template <std::size_t Size>
Scaler<double, static_cast<int>(Size)> column_scaler(const std::vector<std::array<double, Size>>& rows) {
  constexpr double rounding = 1e-12;  // what a constant column's spread may come to by rounding, relative to its mean
  Scaler<double, static_cast<int>(Size)> scaler;
  const double count = static_cast<double>(rows.size());
  for (std::size_t i = 0; i < Size; ++i) {
    double sum = 0;
    for (const auto& row : rows) sum += row[i];
    const double mean = sum / count;
    double squares = 0;
    for (const auto& row : rows) squares += (row[i] - mean) * (row[i] - mean);
    const double spread = std::sqrt(squares / count);
    scaler.mean[i] = mean;
    scaler.spread[i] = spread > rounding * std::abs(mean) ? spread : 1.0;
  }
  return scaler;
}

/// Outputs of a sample in the schema's physical units.
template <class ContextType>
std::array<double, rotor_count> sample_outputs(const Sample& sample) {
  constexpr Airframe<double> airframe = airframe_value<typename ContextType::Vehicle, double>();
  std::array<double, rotor_count> outputs{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    outputs[i] = ContextType::Outputs::from_command(sample.commands[i], airframe);
  }
  return outputs;
}

}  // namespace detail

/// The context of a training set: scalers and spreads of its rows.
template <class ContextType>
ContextType make_context(const Flight& flight, const IndexRange& range) {
  using Features = typename ContextType::Features;
  std::vector<std::array<double, static_cast<std::size_t>(Features::size)>> features;
  std::vector<std::array<double, rotor_count>> outputs;
  std::vector<std::array<double, 3>> sums;
  const std::array<std::array<double, rotor_count>, 3> signs = {
      ContextType::template signs<Roll>(), ContextType::template signs<Pitch>(), ContextType::template signs<Yaw>()};
  for (std::size_t row = range.begin; row < range.end; ++row) {
    features.push_back(sample_features<Features, double>(flight[row]));
    outputs.push_back(detail::sample_outputs<ContextType>(flight[row]));
    std::array<double, 3> sum{};
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] = signed_sum(signs[axis], flight[row].commands);
    sums.push_back(sum);
  }
  ContextType context;
  context.input = detail::column_scaler(features);
  context.output = detail::column_scaler(outputs);
  context.signed_sum_spread = detail::column_scaler(sums).spread;
  return context;
}

/// Rows of a flight, standardised by a context (that of the training set, for every block).
template <class Scalar, class ContextType>
TrainingData<Scalar, ContextType::Features::size, rotor_count> standardised(const ContextType& context,
                                                                            const Flight& flight,
                                                                            const IndexRange& range) {
  using Features = typename ContextType::Features;
  TrainingData<Scalar, Features::size, rotor_count> data;
  data.features.reserve(range.size() * static_cast<std::size_t>(Features::size));
  data.outputs.reserve(range.size() * rotor_count);
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
