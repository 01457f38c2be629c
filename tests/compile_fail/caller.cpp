// SPDX-License-Identifier: MIT
// CASE OTHER_MEANING: pinnquad: the model's commands mean something else to the caller
// CASE OTHER_MEANING_OF_EARLIER_FORMAT: pinnquad: the model's commands mean something else to the caller
// CASE OTHER_PERIOD: pinnquad: the model's sample period is not the caller's, or not said
// CASE PERIOD_UNSAID: pinnquad: the model's sample period is not the caller's, or not said
// CASE OTHER_MOTOR_ORDER: pinnquad: the caller's motors are in another order than the model's
// CASE BLOCK_OF_OTHER_MOTOR_ORDER: pinnquad: the caller's motors are in another order than the model's
// CASE BLOCK_OF_NO_CALLER: pinnquad: a block flies for the caller that its shape names
// CASE BLOCK_OF_HEADER: pinnquad: the model's commands mean something else to the caller
// CASE NOT_A_VEHICLE: pinnquad: a Caller's vehicle is not an airframe
#include "../support/recorded_model.hpp"
#include "pinnquad/exported/loaded_model.hpp"
#include "pinnquad/features/windowed.hpp"
#include "pinnquad/inference/self_test.hpp"

namespace {

using namespace pinnquad;
using test::DescribedModel;
using test::RecordedModel;

/// Rotors 1 and 2 have changed places.
struct Rewired : PaperQuadrotor {
  template <class Scalar>
  static constexpr Airframe<Scalar> value() {
    auto a = PaperQuadrotor::value<Scalar>();
    const auto first = a.rotors[0];
    a.rotors[0] = a.rotors[1];
    a.rotors[1] = first;
    return a;
  }
};

/// Another airframe whose motors are in the model's order.
struct Longer : PaperQuadrotor {
  template <class Scalar>
  static constexpr Airframe<Scalar> value() {
    auto a = PaperQuadrotor::value<Scalar>();
    for (auto& rotor : a.rotors) rotor.x_m *= Scalar(2);
    return a;
  }
};

using Mine = Caller<CommandMeaning::thrust, Longer, PeriodMicroseconds<4000>>;

template <class CallerType>
struct Shape {
  using Scalar = float;
  using Network = test::SmallModel::Network;
  using Features = PaperFeatures;
  using Outputs = CommandOutputs;
  using Vehicle = PaperQuadrotor;
  using Caller = CallerType;
};

#if defined(OTHER_MEANING)
using Inverse = InverseDynamics<RecordedModel, TrainingGuard, Caller<CommandMeaning::pulse_width, PaperQuadrotor>>;
#elif defined(OTHER_MEANING_OF_EARLIER_FORMAT)
using Inverse = InverseDynamics<DescribedModel, TrainingGuard, Caller<CommandMeaning::speed, PaperQuadrotor>>;
#elif defined(OTHER_PERIOD)
using Inverse = InverseDynamics<RecordedModel, TrainingGuard,
                                Caller<CommandMeaning::thrust, PaperQuadrotor, PeriodMicroseconds<5000>>>;
#elif defined(PERIOD_UNSAID)
using Inverse = InverseDynamics<DescribedModel, TrainingGuard, Mine>;
#elif defined(OTHER_MOTOR_ORDER)
using Inverse = InverseDynamics<RecordedModel, TrainingGuard, Caller<CommandMeaning::thrust, Rewired>>;
#elif defined(BLOCK_OF_OTHER_MOTOR_ORDER)
using Wired = Caller<CommandMeaning::thrust, Rewired>;
using Inverse = InverseDynamics<LoadedModel<Shape<Wired>>, TrainingGuard, Wired>;
#elif defined(BLOCK_OF_NO_CALLER)
using Inverse = InverseDynamics<LoadedModel<Shape<AnyCaller>>, TrainingGuard, Mine>;
#elif defined(BLOCK_OF_HEADER)
using Inverse =
    InverseDynamics<ModelView<RecordedModel>, TrainingGuard, Caller<CommandMeaning::pulse_width, PaperQuadrotor>>;
#elif defined(NOT_A_VEHICLE)
using Inverse = InverseDynamics<RecordedModel, TrainingGuard, Caller<CommandMeaning::thrust, int>>;
#else
using Inverse = InverseDynamics<LoadedModel<Shape<Mine>>, TrainingGuard, Mine>;
#endif

}  // namespace

static_assert(sizeof(Inverse) > 0);

int main() {
  const InverseDynamics<RecordedModel, TrainingGuard, Mine> sound;
  const InverseDynamics<DescribedModel, TrainingGuard, Caller<CommandMeaning::thrust, PaperQuadrotor>> earlier;
  return self_test(sound) == Status::ok && self_test(earlier) == Status::ok ? 0 : 1;
}
