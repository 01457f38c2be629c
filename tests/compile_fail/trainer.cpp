// SPDX-License-Identifier: MIT
// CASE NOT_A_LOSS: pinnquad: Trainer's second argument is not a loss
// CASE NOT_A_NETWORK: pinnquad: Trainer's first argument is not a Network
// CASE INPUTS_DIFFER: pinnquad: the network's input count differs from the feature set's size
// CASE OUTPUTS_DIFFER: pinnquad: the network's output count differs from the rotor count
// CASE NO_BACKWARD_RULE: pinnquad: this layer cannot be trained; specialise BackwardRule
// CASE NO_SLOPE: pinnquad: this layer cannot be trained; BackwardRule needs slope
#include "pinnquad/training/trainer.hpp"

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/loss/mse.hpp"
#include "pinnquad/nn/relu.hpp"

namespace {

using pinnquad::Dense;
using pinnquad::Inputs;
using pinnquad::Network;
using pinnquad::Relu;

struct Nothing {};

/// It flies, but nobody has written down its derivative.
struct Reverse {
  template <class ScalarType, int In>
  struct Bind {
    using Scalar = ScalarType;
    static constexpr int inputs = In, outputs = In, parameter_count = 0;
    static void forward(const Scalar*, const Scalar* x, Scalar* y) noexcept {
      for (int i = 0; i < In; ++i) y[i] = x[In - 1 - i];
    }
  };
};

struct Square {
  template <class Scalar, int In>
  struct Bind : pinnquad::ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static Scalar activate(Scalar v) noexcept { return v * v; }
  };
};

#if defined(INPUTS_DIFFER)
using Net = Network<float, Inputs<15>, Dense<8>, Relu, Dense<4>>;
#elif defined(OUTPUTS_DIFFER)
using Net = Network<float, Inputs<16>, Dense<8>, Relu, Dense<3>>;
#elif defined(NO_BACKWARD_RULE)
using Net = Network<float, Inputs<16>, Dense<8>, Reverse, Dense<4>>;
#elif defined(NO_SLOPE)
using Net = Network<float, Inputs<16>, Dense<8>, Square, Dense<4>>;
#elif defined(NOT_A_NETWORK)
using Net = Dense<4>;
#else
using Net = Network<float, Inputs<16>, Dense<8>, Relu, Dense<4>>;
#endif

#if defined(NOT_A_LOSS)
using Loss = Nothing;
#else
using Loss = pinnquad::Mse;
#endif

using Knowledge = pinnquad::Context<pinnquad::PaperFeatures, pinnquad::PaperQuadrotor>;
using Trainer = pinnquad::Trainer<Net, Loss, pinnquad::Adam, Knowledge>;

}  // namespace

int main() {
  return static_cast<int>(sizeof(Trainer) + sizeof(Nothing) + sizeof(Reverse) + sizeof(Square)) > 0 ? 0 : 1;
}
