// SPDX-License-Identifier: MIT
// Trained models whose numbers are drawn at random, of any network, feature set, outputs and airframe, and their
// blocks.
#pragma once

#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/random_network.hpp"

namespace pinnquad::test {

template <class Network, class Features, class Outputs = CommandOutputs, class Vehicle = PaperQuadrotor>
using ModelOf = TrainedModel<Network, Context<Features, Vehicle, Outputs>>;

/// Of a small network; a monotone model has slopes above 0 and bounds about 0, so that it is proven.
template <class Model>
Model drawn_model(std::uint64_t seed, Model model = {}) {
  using Scalar = typename Model::Scalar;
  using Structure = detail::ProvenStructure<typename Model::Network, typename Model::Features>;
  std::mt19937_64 engine(seed);
  const auto draw = [&engine](double least, double most) { return static_cast<Scalar>(uniform(engine, least, most)); };
  auto& parameters = model.network.parameters;
  fill_uniform(parameters, engine, 0.35);
  if constexpr (!std::is_void_v<typename Structure::Base>) {
    using Base = typename Structure::Base;
    auto* const first = parameters.data();
    for (int i = 0; i < 3 * Base::taps; ++i) first[Base::slopes + i] = draw(0.5, 1);
    if constexpr (Structure::has_residual) {
      for (int k = 0; k < 4; ++k) {
        first[Base::parameter_count + k] = draw(-0.5, -0.1);
        first[Base::parameter_count + 4 + k] = draw(0.1, 0.5);
      }
    }
  }
  for (std::size_t i = 0; i < model.input.mean.size(); ++i) {
    model.input.mean[i] = draw(-1, 1);
    model.input.standard_deviation[i] = draw(0.5, 1.5);
    model.envelope_lower[i] = model.input.mean[i] - 3 * model.input.standard_deviation[i];
    model.envelope_upper[i] = model.input.mean[i] + 3 * model.input.standard_deviation[i];
  }
  for (std::size_t k = 0; k < model.output.mean.size(); ++k) {
    model.output.mean[k] = draw(0.4, 0.6);
    model.output.standard_deviation[k] = draw(0.1, 0.2);
  }
  return model;
}

/// Inside the envelope.
template <class Model>
typename Model::FeatureVector drawn_features(const Model& model, std::mt19937_64& engine) {
  typename Model::FeatureVector x{};
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto lower = static_cast<double>(model.envelope_lower[i]),
               upper = static_cast<double>(model.envelope_upper[i]);
    x[i] = static_cast<typename Model::Scalar>(lower + (upper - lower) * uniform(engine, 0.001, 0.999));
  }
  return x;
}

template <class Model>
std::vector<unsigned char> drawn_block(const Model& model) {
  std::mt19937_64 engine(77);
  std::vector<typename Model::FeatureVector> golden;
  for (int i = 0; i < 3; ++i) golden.push_back(drawn_features(model, engine));
  Provenance from{"none", 0x1234, 100, 7, 3, "none"};
  return model_block(model, golden, from, "Drawn");
}

/// Five outputs of a user's own.
struct FiveOutputs {
  static constexpr int size = 5;
  static constexpr bool linear = true;
  static constexpr bool takes_features = false;
  static constexpr std::array<const char*, size> names = {"u1", "u2", "u3", "u4", "u5"};
  static constexpr std::array<const char*, size> units = {"1", "1", "1", "1", "1"};

  template <class Scalar>
  static void commands(const Scalar*, const Scalar* y, const Airframe<Scalar>&, Scalar* u) noexcept {
    for (int i = 0; i < rotor_count; ++i) u[i] = y[i] + y[4];
  }
  template <class Scalar>
  static void from_commands(const Scalar*, const Scalar* u, const Airframe<Scalar>&, Scalar* y) noexcept {
    for (int i = 0; i < rotor_count; ++i) y[i] = u[i];
    y[4] = Scalar(0);
  }
};

}  // namespace pinnquad::test
