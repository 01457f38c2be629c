// SPDX-License-Identifier: MIT
#include "pinnquad/training/trainer.hpp"

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/optimizer.hpp"
#include "pinnquad/training/trained_model.hpp"

using namespace pinnquad;

struct Nothing {};

using Knowledge = Context<PaperFeatures, PaperQuadrotor>;
template <class... Specs>
using From16 = Network<float, InputSize<16>, Specs...>;
using Net = From16<Dense<8>, Relu, Dense<4>>;

template <class Network = Net, class Loss = Mse, class Optimizer = Adam, int Batch = 64>
constexpr std::size_t trained = sizeof(Trainer<Network, Loss, Optimizer, Knowledge, ShuffledBatches, Batch>);
template <class Network>
constexpr std::size_t made = sizeof(make_trained_model(Network{}, Knowledge{}, {}));
template <class Optimizer>
constexpr std::size_t optimised = trained<Net, Mse, Optimizer>;

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

/// An optimiser, or a rate, that may throw.
struct MayThrow {
  double learning_rate = 1.0;
  int begin(long, double) const { return 0; }
  template <class Pack, class Scalar>
  void update(int, Scalar*, const Scalar*, Scalar*, Scalar*, int) const {}
  double factor(double) const { return 1.0; }
};

/// The same, with the derivative.
struct Turned : Reverse {
  template <class Scalar, int In>
  struct Bind : Reverse::Bind<Scalar, In> {};
};

// SOUND
template <class Scalar, int In>
struct pinnquad::BackwardRule<Turned::Bind<Scalar, In>> {
  static void backward(const Scalar*, const Scalar*, const Scalar*, const Scalar* dy, Scalar* dx, Scalar*) noexcept {
    for (int i = 0; i < In; ++i) dx[i] = dy[In - 1 - i];
  }
};
const auto size = trained<From16<Dense<8>, Relu, Turned, Dense<4>>> + made<Net>;

// CASE NOT_A_LOSS: pinnquad: Trainer's second argument is not a loss
const auto size = trained<Net, Nothing>;
// CASE NOT_A_NETWORK: pinnquad: Trainer's first argument is not a Network
const auto size = trained<Dense<4>>;
// CASE INPUTS_DIFFER: pinnquad: the network's input count differs from the feature set's size
const auto size = trained<Network<float, InputSize<15>, Dense<8>, Relu, Dense<4>>>;
// CASE OUTPUTS_DIFFER: pinnquad: the network's output count differs from the output schema's size
const auto size = trained<From16<Dense<8>, Relu, Dense<3>>>;
// CASE NO_BACKWARD_RULE: pinnquad: this layer cannot be trained; specialise BackwardRule
const auto size = trained<From16<Dense<8>, Reverse, Dense<4>>>;
// CASE BACKWARD_RULE_MAY_THROW: pinnquad: a BackwardRule's backward.. must be noexcept
template <class Scalar, int In>
struct pinnquad::BackwardRule<Turned::Bind<Scalar, In>> {
  static void backward(const Scalar*, const Scalar*, const Scalar*, const Scalar* dy, Scalar* dx, Scalar*) {
    for (int i = 0; i < In; ++i) dx[i] = dy[In - 1 - i];
  }
};
const auto size = trained<From16<Dense<8>, Turned, Dense<4>>>;
// CASE NO_SLOPE: pinnquad: this layer cannot be trained; an element-wise layer needs slope
struct Square {
  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static Scalar activate(Scalar v) noexcept { return v * v; }
  };
};
const auto size = trained<From16<Dense<8>, Square, Dense<4>>>;
// CASE NOT_AN_OPTIMIZER: pinnquad: Trainer's third argument is not an optimiser
const auto size = optimised<Nothing>;
// CASE SCHEDULED_NOT_AN_OPTIMIZER: pinnquad: Scheduled's first argument is not an optimiser
const auto size = optimised<Scheduled<Nothing, CosineDecay>>;
// CASE SCHEDULED_NOT_A_RATE: pinnquad: Scheduled's second argument is not a rate
const auto size = optimised<Scheduled<Adam, Constant>>;
// CASE UPDATE_MAY_THROW: pinnquad: Trainer's third argument is not an optimiser. it needs begin.. and update.. const noexcept
const auto size = optimised<MayThrow>;
// CASE RATE_MAY_THROW: pinnquad: Scheduled's second argument is not a rate. it needs factor.done. const noexcept
const auto size = optimised<Scheduled<Adam, MayThrow>>;
// CASE SCHEDULED_WITHOUT_RATE: pinnquad: Scheduled's first argument has no member learning_rate
struct Rateless {
  int begin(long, double) const { return 0; }
  template <class Pack, class Scalar>
  void update(int, Scalar*, const Scalar*, Scalar*, Scalar*, int) const noexcept {}
};
const auto size = optimised<Scheduled<Rateless, CosineDecay>>;
// CASE NO_BATCH: pinnquad: Trainer's batch size must be 1 or more
const auto size = trained<Net, Mse, Adam, 0>;
// CASE BATCH_NORM_OF_ONE: pinnquad: batch norm can't be trained in batches of one sample
const auto size = trained<From16<DenseWithoutBias<8>, BatchNorm, Relu, Dense<4>>, Mse, Adam, 1>;
// CASE BATCH_NORM_BEHIND_ACTIVATION: pinnquad: a BatchNorm that does not follow a Dense can't be folded
const auto size = made<From16<Dense<8>, Relu, BatchNorm, Dense<4>>>;
