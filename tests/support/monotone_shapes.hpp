// SPDX-License-Identifier: MIT
// Monotone models for tests (model/axis_aligned.hpp): of physics features, alone, with a residual and through a
// window; their numbers are random, their slopes above 0.
#pragma once

#include <random>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/exported/certificate.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "support/random_network.hpp"

namespace pinnquad::test {

template <class FeatureSet, class Answer>
struct MonotoneShape {
  using Scalar = typename Answer::Scalar;
  using Network = Answer;
  using Features = FeatureSet;
  using Outputs = AxisCommandOutputs;
  using Vehicle = PaperQuadrotor;
};

using PhysicsWindow = PartlyWindowed<PhysicsFeatures, AccelerationFeatures, 3, PeriodMicroseconds<20000>>;
/// A window that has the specific force of its other taps alone.
using ForceWindow = PartlyWindowed<PhysicsFeatures, SpecificForce, 3, PeriodMicroseconds<20000>>;

template <class FeatureSet, class Activation = Relu, class Scalar = float>
using SmallResidual = pinnquad::Network<Scalar, InputSize<residual_inputs<FeatureSet>>, Dense<8>, Activation, Dense<8>,
                                        Activation, Dense<4>>;

using BaseAlone = MonotoneShape<PhysicsFeatures, MonotoneBase<PhysicsFeatures>>;
using WithResidual = MonotoneShape<PhysicsFeatures, MonotonePredictor<PhysicsFeatures, SmallResidual<PhysicsFeatures>>>;
using WindowedModel =
    MonotoneShape<PhysicsWindow, MonotonePredictor<PhysicsWindow, SmallResidual<PhysicsWindow, Tanh>>>;
using ForceWindowedModel = MonotoneShape<ForceWindow, MonotonePredictor<ForceWindow, SmallResidual<ForceWindow>>>;

/// Numbers of a model of a shape, as an exported header's, in an instance.
template <class Shape>
struct MonotoneModel {
  static constexpr ModelKind kind = ModelKind::instance;
  using Scalar = typename Shape::Scalar;
  using Network = typename Shape::Network;
  using Features = typename Shape::Features;
  using Outputs = typename Shape::Outputs;
  using Vehicle = typename Shape::Vehicle;
  using Structure = detail::ProvenStructure<Network, Features>;
  using Base = typename Structure::Base;
  static constexpr std::size_t inputs = static_cast<std::size_t>(Features::size);

  typename Network::Parameters parameters{};
  Scaler<Scalar, Features::size> input{};
  Scaler<Scalar, 4> output{};
  std::array<Scalar, inputs> envelope_lower{};
  std::array<Scalar, inputs> envelope_upper{};
  std::array<std::array<Scalar, inputs>, 1> golden_features{};
  std::array<Commands<Scalar>, 1> golden_commands{};

  explicit MonotoneModel(std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    fill_uniform(parameters, engine, 0.6);
    fill_uniform(input.mean, engine, 2);
    for (Scalar& v : input.standard_deviation) v = static_cast<Scalar>(uniform(engine, 0.5, 4));
    for (Scalar& v : output.mean) v = static_cast<Scalar>(uniform(engine, -0.1, 0.1));
    for (Scalar& v : output.standard_deviation) v = static_cast<Scalar>(uniform(engine, 0.05, 0.3));
    for (int i = 0; i < 3 * Base::taps; ++i) slope(i) = static_cast<Scalar>(uniform(engine, 0.1, 1));
    for (int k = 0; Structure::has_residual && k < 4; ++k) {
      bound(k) = static_cast<Scalar>(uniform(engine, -0.5, -0.1));
      bound(4 + k) = static_cast<Scalar>(uniform(engine, 0.1, 0.5));
    }
    for (std::size_t i = 0; i < inputs; ++i) {
      envelope_lower[i] = input.mean[i] - 4 * input.standard_deviation[i];
      envelope_upper[i] = input.mean[i] + 4 * input.standard_deviation[i];
    }
    golden_features[0] = input.mean;
  }

  void forward(const Scalar* x, Scalar* y) const noexcept { Network::forward(parameters.data(), x, y); }

  /// Tap by tap, axis by axis.
  Scalar& slope(int i) { return parameters[static_cast<std::size_t>(Base::slopes + i)]; }
  /// Lower bounds, then upper ones.
  Scalar& bound(int i) { return parameters[static_cast<std::size_t>(Base::parameter_count + i)]; }

  /// For another vehicle than the shape's.
  Certificate certificate(const Airframe<Scalar>& airframe) const {
    return certificate_of<Shape>(detail::certified_vehicle<Outputs>(airframe), parameters.data(),
                                 {input.mean.data(), input.standard_deviation.data(), output.mean.data(),
                                  output.standard_deviation.data(), envelope_lower.data(), envelope_upper.data()});
  }
  Certificate certificate() const { return certificate(airframe_value<Vehicle, Scalar>()); }
};

}  // namespace pinnquad::test
