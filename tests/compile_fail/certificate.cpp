// SPDX-License-Identifier: MIT
// CASE NO_STRUCTURE: pinnquad: this model has no structure that could be proven
// CASE SLOPE_BELOW_ZERO: pinnquad: a slope of the model is not above 0
// CASE SLOPE_ZERO: pinnquad: a slope of the model is not above 0
// CASE BOUNDS_UPSIDE_DOWN: pinnquad: the bounds of the model's residual are none
// CASE RESIDUAL_SEES_TOO_MUCH: pinnquad: an answer from which features are Withheld takes all the others
// CASE WITHHELD_TWICE: pinnquad: what is Withheld are features in threes, ascending, that do not overlap
// CASE BASE_SEES_THE_TURNING: pinnquad: SignedSumsOn needs a base that is not shown the angular acceleration
// CASE NO_ANGULAR_ACCELERATION: pinnquad: a model that is monotone in the angular acceleration needs a feature set
#include "pinnquad/flight.hpp"

namespace {

using namespace pinnquad;

using Features = PhysicsFeatures;
constexpr int inputs = Features::size;
using Residual = Network<float, InputSize<residual_inputs<Features>>, Dense<4>>;
using Answer = MonotoneAnswer<Features, Residual>;

constexpr Answer::Parameters numbers() {
  Answer::Parameters parameters{};
  for (std::size_t i = 0; i < 3; ++i) parameters[i] = 0.5f;
#ifdef SLOPE_BELOW_ZERO
  parameters[1] = -0.5f;
#endif
#ifdef SLOPE_ZERO
  parameters[2] = 0;
#endif
  constexpr auto bounds = std::size_t(MonotoneBase<Features>::parameter_count);
  for (std::size_t k = 0; k < 4; ++k) {
    parameters[bounds + k] = -0.1f;
    parameters[bounds + 4 + k] = 0.1f;
  }
#ifdef BOUNDS_UPSIDE_DOWN
  parameters[bounds + 1] = 0.2f;
#endif
  return parameters;
}

struct Certified {
  using Scalar = float;
  using Network = Answer;
  using Features = PhysicsFeatures;
#ifdef NO_STRUCTURE
  using Outputs = CommandOutputs;
#else
  using Outputs = SignedSumOutputs;
#endif
  using Vehicle = PaperQuadrotor;
  static constexpr Answer::Parameters parameters = numbers();
  static constexpr Scaler<float, inputs> input{};
  static constexpr Scaler<float, 4> output{};
};
static_assert(require_certificate<Certified>());
static_assert(certificate_of<Certified>().slope[0] > 0.49 && certificate_of<Certified>().command_bound[3] < 0.11);

#ifdef RESIDUAL_SEES_TOO_MUCH
constexpr int wrong = Withheld<Network<float, InputSize<inputs>, Dense<4>>, inputs, 3>::outputs;
#elif defined(WITHHELD_TWICE)
constexpr int wrong = Withheld<Residual, inputs, 3, 5>::outputs;
#elif defined(BASE_SEES_THE_TURNING)
struct Turning : RigidBodyInverse {
  static constexpr bool sees_angular_acceleration = true;
};
constexpr int wrong = SignedSumsOn<Turning>::size;
#elif defined(NO_ANGULAR_ACCELERATION)
constexpr int wrong = MonotoneBase<Joined<SpecificForce, BodyRates>>::outputs;
#else
constexpr int wrong = 0;
#endif

}  // namespace

int main() { return wrong; }
