// SPDX-License-Identifier: MIT
// Mini-batches and contexts for the tests of losses: seeded, with the spread of standardised data.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/loss/loss.hpp"

namespace pinnquad::test {

template <class Scalar>
using PaperBatch = LossBatch<Scalar, PaperFeatures::size, rotor_count, 64>;

/// A series with these values.
inline Eigen::ArrayXd array(std::initializer_list<double> values) {
  Eigen::ArrayXd result(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), result.data());
  return result;
}

/// Normal features, targets and predictions.
template <class Scalar>
PaperBatch<Scalar> random_batch(int size, std::mt19937_64& engine) {
  PaperBatch<Scalar> batch;
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
  constexpr Airframe<double> airframe = airframe_value<typename ContextType::Vehicle, double>();
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const double mean = 0.5 + 0.02 * static_cast<double>(i), spread = 0.03 + 0.01 * static_cast<double>(i);
    const double above = ContextType::Outputs::from_command(mean + spread, airframe);
    context.output.mean[i] = ContextType::Outputs::from_command(mean, airframe);
    context.output.spread[i] = above - context.output.mean[i];
  }
  context.signed_sum_spread = {0.11, 0.07, 0.05};
  return context;
}

}  // namespace pinnquad::test
