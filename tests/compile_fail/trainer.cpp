// SPDX-License-Identifier: MIT
// CASE NOT_A_LOSS: pinnquad: Trainer's second argument is not a loss
// CASE NOT_A_NETWORK: pinnquad: Trainer's first argument is not a Network
// CASE INPUTS_DIFFER: pinnquad: the network's input count differs from the feature set's size
// CASE OUTPUTS_DIFFER: pinnquad: the network's output count differs from the output schema's size
// CASE NO_BACKWARD_RULE: pinnquad: this layer cannot be trained; specialise BackwardRule
// CASE BACKWARD_RULE_MAY_THROW: pinnquad: a BackwardRule's backward.. must be noexcept
// CASE NO_SLOPE: pinnquad: this layer cannot be trained; an element-wise layer needs slope
// CASE NOT_AN_OPTIMIZER: pinnquad: Trainer's third argument is not an optimiser
// CASE SCHEDULED_NOT_AN_OPTIMIZER: pinnquad: Scheduled's first argument is not an optimiser
// CASE SCHEDULED_NOT_A_RATE: pinnquad: Scheduled's second argument is not a rate
// CASE UPDATE_MAY_THROW: pinnquad: Trainer's third argument is not an optimiser. it needs begin.. and update.. const noexcept
// CASE RATE_MAY_THROW: pinnquad: Scheduled's second argument is not a rate. it needs factor.done. const noexcept
// CASE SCHEDULED_WITHOUT_RATE: pinnquad: Scheduled's first argument has no member learning_rate
// CASE NO_BATCH: pinnquad: Trainer's batch size must be 1 or more
// CASE BATCH_NORM_OF_ONE: pinnquad: batch norm can't be trained in batches of one sample
// CASE BATCH_NORM_BEHIND_ACTIVATION: pinnquad: a BatchNorm that does not follow a Dense can't be folded
#include "pinnquad/training/trainer.hpp"

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/optimizer.hpp"
#include "pinnquad/training/trained_model.hpp"

namespace {

using pinnquad::Dense;
using pinnquad::InputSize;
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

/// The same, with the derivative.
struct Turned : Reverse {
  template <class Scalar, int In>
  struct Bind : Reverse::Bind<Scalar, In> {};
};

struct Square {
  template <class Scalar, int In>
  struct Bind : pinnquad::ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static Scalar activate(Scalar v) noexcept { return v * v; }
  };
};

/// An optimiser without a learning rate, and one that may throw.
struct Rateless {
  int begin(long, double) const { return 0; }
  template <class Pack, class Scalar>
  void update(int, Scalar*, const Scalar*, Scalar*, Scalar*, int) const noexcept {}
};
struct MayThrow {
  double learning_rate = 1.0;
  int begin(long, double) const { return 0; }
  template <class Pack, class Scalar>
  void update(int, Scalar*, const Scalar*, Scalar*, Scalar*, int) const {}
  double factor(double) const { return 1.0; }
};

}  // namespace

template <class Scalar, int In>
struct pinnquad::BackwardRule<Turned::Bind<Scalar, In>> {
  static void backward(const Scalar*, const Scalar*, const Scalar*, const Scalar* dy, Scalar* dx, Scalar*)
#if !defined(BACKWARD_RULE_MAY_THROW)
      noexcept
#endif
  {
    for (int i = 0; i < In; ++i) dx[i] = dy[In - 1 - i];
  }
};

namespace {

#if defined(INPUTS_DIFFER)
using Net = Network<float, InputSize<15>, Dense<8>, Relu, Dense<4>>;
#elif defined(OUTPUTS_DIFFER)
using Net = Network<float, InputSize<16>, Dense<8>, Relu, Dense<3>>;
#elif defined(NO_BACKWARD_RULE)
using Net = Network<float, InputSize<16>, Dense<8>, Reverse, Dense<4>>;
#elif defined(NO_SLOPE)
using Net = Network<float, InputSize<16>, Dense<8>, Square, Dense<4>>;
#elif defined(BATCH_NORM_OF_ONE)
using Net = Network<float, InputSize<16>, pinnquad::DenseWithoutBias<8>, pinnquad::BatchNorm, Relu, Dense<4>>;
#elif defined(BATCH_NORM_BEHIND_ACTIVATION)
using Net = Network<float, InputSize<16>, Dense<8>, Relu, pinnquad::BatchNorm, Dense<4>>;
#elif defined(NOT_A_NETWORK)
using Net = Dense<4>;
#else
using Net = Network<float, InputSize<16>, Dense<8>, Relu, Turned, Dense<4>>;
#endif

#if defined(NOT_A_LOSS)
using Loss = Nothing;
#else
using Loss = pinnquad::Mse;
#endif

using Knowledge = pinnquad::Context<pinnquad::PaperFeatures, pinnquad::PaperQuadrotor>;
#if defined(NOT_AN_OPTIMIZER)
using Optimizer = Nothing;
#elif defined(SCHEDULED_NOT_AN_OPTIMIZER)
using Optimizer = pinnquad::Scheduled<Nothing, pinnquad::CosineDecay>;
#elif defined(SCHEDULED_NOT_A_RATE)
using Optimizer = pinnquad::Scheduled<pinnquad::Adam, pinnquad::Constant>;
#elif defined(UPDATE_MAY_THROW)
using Optimizer = MayThrow;
#elif defined(RATE_MAY_THROW)
using Optimizer = pinnquad::Scheduled<pinnquad::Adam, MayThrow>;
#elif defined(SCHEDULED_WITHOUT_RATE)
using Optimizer = pinnquad::Scheduled<Rateless, pinnquad::CosineDecay>;
#else
using Optimizer = pinnquad::Adam;
#endif

#if defined(BATCH_NORM_OF_ONE)
constexpr int batch_size = 1;
#elif defined(NO_BATCH)
constexpr int batch_size = 0;
#else
constexpr int batch_size = 64;
#endif

using Trainer = pinnquad::Trainer<Net, Loss, Optimizer, Knowledge, pinnquad::ShuffledBatches, batch_size>;

}  // namespace

int main() {
  using Model = decltype(pinnquad::make_trained_model(Net{}, Knowledge{}, {}));
  return static_cast<int>(sizeof(Trainer) + sizeof(Model) + sizeof(Nothing) + sizeof(Reverse) + sizeof(Square) +
                          sizeof(Rateless) + sizeof(MayThrow)) > 0
             ? 0
             : 1;
}
