// SPDX-License-Identifier: MIT
// A translation unit of flight code that only predicts, compiled once per instruction set and never run: check.sh reads
// its symbols. Sizes with a remainder, weights worked out by the compiler.
#include "../support/small_model.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/inference/batched_inverse.hpp"
#include "pinnquad/inference/command_jacobian.hpp"
#include "pinnquad/inference/self_test.hpp"
#include "pinnquad/nn/batch_norm.hpp"
#include "pinnquad/nn/batched_network.hpp"
#include "pinnquad/nn/elu.hpp"
#include "pinnquad/nn/gelu.hpp"
#include "pinnquad/nn/leaky_relu.hpp"
#include "pinnquad/nn/packed_network.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/silu.hpp"
#include "pinnquad/nn/sine.hpp"
#include "pinnquad/nn/softplus.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/outputs/wrench_outputs.hpp"

namespace {

using Net =
    pinnquad::Mlp<float, pinnquad::InputSize<16>, pinnquad::Hidden<3, 25>, pinnquad::OutputSize<4>, pinnquad::Relu>;
/// Runs from memory to memory: too wide for registers, with an activation that calls the C library.
using WideNet =
    pinnquad::Network<float, pinnquad::InputSize<16>, pinnquad::Dense<70>, pinnquad::Tanh, pinnquad::Dense<4>>;

/// Every smooth activation that calls the C library, leaky ReLU, and derivatives asked with inputs.
using SmoothNet =
    pinnquad::Network<float, pinnquad::InputSize<16>, pinnquad::Dense<9>, pinnquad::Gelu, pinnquad::Dense<9>,
                      pinnquad::Silu, pinnquad::Dense<9>, pinnquad::Softplus, pinnquad::Dense<9>, pinnquad::Sine,
                      pinnquad::Dense<9>, pinnquad::Elu, pinnquad::Dense<9>, pinnquad::LeakyRelu, pinnquad::Dense<4>>;

/// Numbers in +-0.5 without a pattern that a sum would cancel: a linear congruence.
template <class Network>
constexpr typename Network::Parameters some_parameters() noexcept {
  typename Network::Parameters parameters{};
  unsigned state = 12345;
  for (auto& p : parameters) {
    state = state * 1664525u + 1013904223u;
    p = static_cast<float>(state >> 8) / 16777216.0f - 0.5f;
  }
  return parameters;
}

/// With batch norm: the Jacobian takes its roots.
using NormNet = pinnquad::BatchNormMlp<float, pinnquad::InputSize<16>, pinnquad::Hidden<1, 9>, pinnquad::OutputSize<4>,
                                       pinnquad::Relu>;

/// The same numbers, positive as a variance is.
template <class Network>
constexpr typename Network::Parameters some_variances() noexcept {
  auto parameters = some_parameters<Network>();
  for (auto& p : parameters) p = p < 0 ? -p : p;
  return parameters;
}

using Model = pinnquad::test::SmallModel;

/// Its outputs taken for rotor speeds, rev/s.
struct SpeedNumbers : Model {
  using Outputs = pinnquad::RotorSpeedOutputs;
};
using SpeedModel = pinnquad::test::AsHeader<SpeedNumbers>;

/// Its outputs taken for a wrench, and for what is added to another inverse.
struct WrenchNumbers : Model {
  using Outputs = pinnquad::WrenchOutputs;
};
struct ResidualNumbers : Model {
  using Outputs = pinnquad::ResidualOutputs<pinnquad::LinearizedBase>;
};
using WrenchModel = pinnquad::test::AsHeader<WrenchNumbers>;
using ResidualModel = pinnquad::test::AsHeader<ResidualNumbers>;

constexpr Net::Parameters parameters = some_parameters<Net>();
constexpr WideNet::Parameters wide_parameters = some_parameters<WideNet>();
constexpr pinnquad::PackedNetwork<Net> packed{parameters};
constexpr pinnquad::PackedNetwork<WideNet> packed_wide{wide_parameters};
constexpr Net portable{parameters};
constexpr NormNet::Parameters norm_parameters = some_variances<NormNet>();
constexpr const float* norm_parameters_begin = norm_parameters.data();

/// All that is asked of a model.
template <class AnyModel>
void predict(const AnyModel& model, const float* x, float* y) {
  const pinnquad::InverseDynamics<AnyModel> inverse(model);
  float jacobian[4 * Model::Features::size];
  pinnquad::Status status = inverse.predict_features(x, y);
  pinnquad::predict_batch(inverse, x, y, &status, 1);
  y[0] += static_cast<float>(pinnquad::predict_with_jacobian(inverse, x, y, jacobian) == status);
  y[1] += static_cast<float>(pinnquad::self_test(inverse) == status);
}

/// A block of the exported model, in place and packed.
void predict_from_block(const unsigned char* block, std::size_t block_bytes, const float* x, float* y) {
  using View = pinnquad::ModelView<Model>;
  static View::Packed memory;
  View view;
  if (View::open(block, block_bytes, view) == pinnquad::Status::ok) predict(view, x, y);
  if (View::open(block, block_bytes, view, memory) == pinnquad::Status::ok) predict(view, x, y);
}

void differentiate(const float* x, float* y) {
  float jacobian[4 * 16];
  pinnquad::JacobianPass<NormNet>::run(norm_parameters_begin, x, y, jacobian);
}

void predict_smoothly(const float* x, float* y) {
  static constexpr SmoothNet::Parameters smooth_parameters = some_parameters<SmoothNet>();
  static constexpr pinnquad::PackedNetwork<SmoothNet> packed_smooth{smooth_parameters};
  constexpr const float* weights = smooth_parameters.data();
  packed_smooth.forward(x, y);
  SmoothNet::forward(weights, x, y + 4);
  pinnquad::BatchedNetwork<SmoothNet>::forward(weights, x, y + 8, 1);
  float by_vectors[4 * 16], by_scalars[4 * 16];
  pinnquad::JacobianPass<SmoothNet>::run(weights, x, y + 12, by_scalars);
  pinnquad::JacobianPass<SmoothNet>::run(packed_smooth, weights, x, y + 12, by_vectors);
}
}  // namespace

extern "C" void predict_all(const unsigned char* block, std::size_t block_bytes, const float* x, float* y) {
  packed.forward(x, y);
  packed_wide.forward(x, y + 4);
  portable.forward(x, y + 8);
  predict(Model{}, x, y);
  predict(SpeedModel{}, x, y);
  predict(WrenchModel{}, x, y);
  predict(ResidualModel{}, x, y);
  predict_from_block(block, block_bytes, x, y);
  differentiate(x, y);
  predict_smoothly(x, y);
}
