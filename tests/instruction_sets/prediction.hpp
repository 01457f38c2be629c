// SPDX-License-Identifier: MIT
// The model that every instruction set predicts with: sizes with a remainder, weights worked out by the compiler.
#pragma once

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

namespace instruction_sets {

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

/// An exported model: its first golden vector's commands come from a program that does not know this library.
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

/// A block of it, which main.cpp writes before any call.
extern unsigned char block[];
extern std::size_t block_bytes;

/// y[0, 4) in registers, y[4, 8) from memory to memory, y[8, 12) by the portable kernel, y[12, 16) of the exported
/// model, y[16, 20) of its outputs as speeds, y[20, 28) from its block: in place, loaded; y[28, 32) with batch norm,
/// y[32, 36) of smooth activations by the vector unit, y[36, 40) by the portable kernel, y[40, 44) in a batch, y[44,
/// 48) beside the Jacobian, y[48] the largest difference of its entries to those of the portable pass; y[49, 53) of the
/// exported model's outputs as a wrench, y[53, 57) as a residual.
inline constexpr int outputs = 57;

}  // namespace instruction_sets
