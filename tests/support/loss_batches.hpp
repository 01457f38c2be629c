// SPDX-License-Identifier: MIT
// Mini-batches and contexts for the tests of losses: seeded, with the spread of standardised data.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/loss/context.hpp"

namespace pinnquad::test {

template <class Scalar, int OutputCount = rotor_count>
using PaperBatch = detail::LossBatch<Scalar, PaperFeatures::size, OutputCount, 64>;

/// A series with these values.
inline Eigen::ArrayXd array(std::initializer_list<double> values) {
  Eigen::ArrayXd result(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), result.data());
  return result;
}

/// Normal features, targets and predictions.
template <class Scalar, int OutputCount = rotor_count>
PaperBatch<Scalar, OutputCount> random_batch(int size, std::mt19937_64& engine) {
  PaperBatch<Scalar, OutputCount> batch;
  batch.resize(size);
  const auto fill = [&engine](auto& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) matrix.data()[i] = static_cast<Scalar>(standard_normal(engine));
  };
  fill(batch.features);
  fill(batch.target);
  fill(batch.prediction);
  return batch;
}

/// Scalers and spreads as of a flight: outputs of the paper's airframe around hover. Rotor speeds stay away from 0,
/// where the second derivative of RotorSpeedOutputs::command jumps.
template <class ContextType>
ContextType flight_context() {
  ContextType context;
  using Map = OutputMap<typename ContextType::Outputs>;
  const auto setting = Map::setting(airframe_value<typename ContextType::Vehicle, double>());
  const std::array<double, ContextType::Features::size> level{};
  Commands<double> middle{}, above{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    middle[i] = 0.5 + 0.02 * static_cast<double>(i);
    above[i] = middle[i] + (0.03 + 0.01 * static_cast<double>(i));
  }
  std::array<double, Map::size> outputs_above{};
  Map::from_commands(level.data(), middle.data(), setting, context.output.mean.data());
  Map::from_commands(level.data(), above.data(), setting, outputs_above.data());
  for (std::size_t i = 0; i < outputs_above.size(); ++i) {
    const double spread = std::abs(outputs_above[i] - context.output.mean[i]);
    context.output.standard_deviation[i] = spread > 1e-9 ? spread : 1.0;  // what does not move but by rounding
  }
  context.signed_sum_deviation = {0.11, 0.07, 0.05};
  return context;
}

}  // namespace pinnquad::test
