// SPDX-License-Identifier: MIT
// A network with its scalers and its training envelope: what is judged, exported and compared with the flight side.
#pragma once

#include <cmath>

#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/exported/stated_bounds.hpp"
#include "pinnquad/inference/pipeline.hpp"
#include "pinnquad/nn/network.hpp"
#include "pinnquad/training/folding.hpp"
#include "pinnquad/training/training_data.hpp"

namespace pinnquad {

/// Values of the network's own scalar type, as the exported header holds them.
template <class NetworkType, class ContextType>
struct TrainedModel : detail::ContextAirframe<typename ContextType::Vehicle> {
  static_assert(NetworkType::outputs == ContextType::output_count,
                "pinnquad: a trained model's network has one output per output of its context's schema");
  static_assert(NetworkType::inputs == ContextType::Features::size,
                "pinnquad: a trained model's network has one input per feature of its context");
  using Network = NetworkType;
  using Scalar = typename Network::Scalar;
  using Features = typename ContextType::Features;
  using Outputs = typename ContextType::Outputs;
  using Vehicle = typename ContextType::Vehicle;
  using FeatureVector = std::array<Scalar, static_cast<std::size_t>(Features::size)>;

  Network network{};
  Scaler<Scalar, Features::size> input{};
  Scaler<Scalar, Network::outputs> output{};
  FeatureVector envelope_lower{};
  FeatureVector envelope_upper{};

  /// Commands for a feature vector in physical units, by the portable kernel; the envelope is not checked.
  Commands<Scalar> predict(const FeatureVector& x) const noexcept {
    Scalar outputs[Network::outputs] = {};
    Commands<Scalar> commands{};
    const detail::Scales<Scalar> scales{input.mean.data(),     input.standard_deviation.data(),
                                        output.mean.data(),    output.standard_deviation.data(),
                                        envelope_lower.data(), envelope_upper.data()};
    detail::Pipeline<Features, Outputs, Vehicle>::run(
        scales, x.data(), static_cast<Scalar*>(outputs), commands.data(),
        [this](const Scalar* standardised, Scalar* made) { network.forward(standardised, made); },
        this->template output_setting<Outputs, Scalar>());
    return commands;
  }
  Commands<Scalar> predict(const Sample& sample) const noexcept {
    return predict(sample_features<Features, Scalar>(sample));
  }
};

namespace detail {
/// An affine map, alone or below a bounded residual.
template <class Predictor>
inline constexpr bool affine_predictor = StatedStructure<Predictor>::known;
template <class Scalar, int Inputs, int Outputs>
inline constexpr bool affine_predictor<Network<Scalar, InputSize<Inputs>, Dense<Outputs>>> = true;

/// Weight decay leaves a dead neuron weights of 1e-30 and below. As 0 they change no prediction by a bit that matters;
/// their products would be denormal and cost a hundred times an ordinary operation in flight.
template <class Scalar>
Scalar without_negligible(Scalar weight) noexcept {
  constexpr double negligible = 1e-20;
  return std::abs(static_cast<double>(weight)) < negligible ? Scalar(0) : weight;
}
}  // namespace detail

/// Joins a network with the scalers of its context and the envelope of its training rows: their range, wider by a tenth
/// on both sides (detail::ColumnStatistics), of a model that is affine but for a bounded residual twice as wide and
/// more (detail::affine_reach). Batch norm is folded away: the network that is judged and exported flies.
template <class NetworkType, class ContextType>
TrainedModel<detail::Folded<NetworkType>, ContextType> make_trained_model(const NetworkType& network,
                                                                          const ContextType& context,
                                                                          const RowSet& training) {
  using Model = TrainedModel<detail::Folded<NetworkType>, ContextType>;
  using Scalar = typename Model::Scalar;
  Model model{context};
  model.network = folded(network);
  for (Scalar& weight : model.network.parameters) weight = detail::without_negligible(weight);
  const auto cast = [](const auto& from, auto& to) {
    for (std::size_t i = 0; i < from.mean.size(); ++i) {
      to.mean[i] = static_cast<Scalar>(from.mean[i]);
      to.standard_deviation[i] = static_cast<Scalar>(from.standard_deviation[i]);
    }
  };
  cast(context.input, model.input);
  cast(context.output, model.output);
  const auto columns = detail::feature_statistics<typename Model::Features>(training);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto& column = columns[i];
    double margin = column.margin();
    if constexpr (detail::affine_predictor<typename Model::Network>) {
      margin = column.margin(detail::affine_reach(Model::Features::units[i]));
    }
    model.envelope_lower[i] = static_cast<Scalar>(column.lowest - margin);
    model.envelope_upper[i] = static_cast<Scalar>(column.highest + margin);
  }
  return model;
}

}  // namespace pinnquad
