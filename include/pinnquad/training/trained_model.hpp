// SPDX-License-Identifier: MIT
// A network with its scalers and its training envelope: what is judged, exported and compared with the flight side.
#pragma once

#include <cmath>
#include <limits>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/sample_inputs.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/nn/network.hpp"
#include "pinnquad/training/folding.hpp"

namespace pinnquad {

/// Values of the network's own scalar type, as the exported header holds them.
template <class NetworkType, class ContextType>
struct TrainedModel {
  using Network = NetworkType;
  using Scalar = typename Network::Scalar;
  using Features = typename ContextType::Features;
  using Outputs = typename ContextType::Outputs;
  using Vehicle = typename ContextType::Vehicle;
  using FeatureVector = std::array<Scalar, static_cast<std::size_t>(Features::size)>;

  Network network{};
  Scaler<Scalar, Features::size> input{};
  Scaler<Scalar, rotor_count> output{};
  FeatureVector envelope_lower{};
  FeatureVector envelope_upper{};

  /// Commands for a feature vector in physical units, by the portable kernel; the envelope is not checked.
  Commands<Scalar> predict(const FeatureVector& x) const noexcept {
    FeatureVector z{};
    Commands<Scalar> y{};
    input.standardise(x.data(), z.data());
    network.forward(z.data(), y.data());
    output.restore(y.data(), y.data());
    constexpr Airframe<Scalar> airframe = airframe_value<Vehicle, Scalar>();
    for (Scalar& v : y) v = Outputs::command(v, airframe);
    return y;
  }
  Commands<Scalar> predict(const Sample& sample) const noexcept {
    return predict(sample_features<Features, Scalar>(sample));
  }
};

/// Share of a feature's range in the training set by which the envelope is wider on both sides.
inline constexpr double envelope_margin = 0.1;

/// Weights smaller than this become 0. Weight decay leaves a dead neuron weights of 1e-30 and below: no prediction changes by a
/// bit that matters, but their products would be denormal and cost a hundred times an ordinary operation in flight.
inline constexpr double negligible_weight = 1e-20;

/// Joins a network with the scalers of its context and the envelope of its training rows. Batch norm is folded away: what is
/// judged and exported is the network that flies.
template <class NetworkType, class ContextType>
TrainedModel<Folded<NetworkType>, ContextType> make_trained_model(const NetworkType& network,
                                                                  const ContextType& context, const Flight& flight,
                                                                  const IndexRange& training) {
  using Model = TrainedModel<Folded<NetworkType>, ContextType>;
  using Scalar = typename Model::Scalar;
  Model model;
  model.network = folded(network);
  for (Scalar& weight : model.network.parameters) {
    if (std::abs(static_cast<double>(weight)) < negligible_weight) weight = Scalar(0);
  }
  const auto cast = [](const auto& from, auto& to) {
    for (std::size_t i = 0; i < from.mean.size(); ++i) {
      to.mean[i] = static_cast<Scalar>(from.mean[i]);
      to.spread[i] = static_cast<Scalar>(from.spread[i]);
    }
  };
  cast(context.input, model.input);
  cast(context.output, model.output);
  constexpr std::size_t size = Model::Features::size;
  std::array<double, size> lower{}, upper{};
  lower.fill(std::numeric_limits<double>::infinity());
  upper.fill(-std::numeric_limits<double>::infinity());
  for (std::size_t row = training.begin; row < training.end; ++row) {
    const auto x = sample_features<typename Model::Features, double>(flight[row]);
    for (std::size_t i = 0; i < size; ++i) {
      lower[i] = x[i] < lower[i] ? x[i] : lower[i];
      upper[i] = x[i] > upper[i] ? x[i] : upper[i];
    }
  }
  for (std::size_t i = 0; i < size; ++i) {
    const double margin = envelope_margin * (upper[i] - lower[i]);
    model.envelope_lower[i] = static_cast<Scalar>(lower[i] - margin);
    model.envelope_upper[i] = static_cast<Scalar>(upper[i] + margin);
  }
  return model;
}

}  // namespace pinnquad
