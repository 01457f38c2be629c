// SPDX-License-Identifier: MIT
// Writes sound blocks into a folder, for the fuzzer to begin with: run_time_model_seeds DIR
#include "fuzz/seeds.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/features/windowed.hpp"
#include "pinnquad/nn/activations.hpp"
#include "pinnquad/outputs/rigid_body_base.hpp"
#include "pinnquad/outputs/wrench_outputs.hpp"
#include "support/drawn_model.hpp"
#include "support/small_model_variants.hpp"

namespace {

using namespace pinnquad;
using test::ModelOf;

using Physics = PhysicsFeatures;
using Residual = Network<float, InputSize<residual_inputs<Physics>>, Dense<3>, Tanh, Dense<4>>;
using Window = PartlyWindowed<WithColumns<PaperFeatures, BatteryVoltage>, AngularAcceleration, 3,
                              PeriodMicroseconds<10000>, Centred>;

template <class Model>
std::string block() {
  return pinnquad_test::as_text(test::drawn_block(test::drawn_model<Model>(1)));
}

}  // namespace

int main(int argument_count, char** arguments) {
  return pinnquad_test::write_seeds(
      argument_count, arguments,
      {pinnquad_test::as_text(model_block<test::SmallModel>()),
       pinnquad_test::as_text(model_block<test::DoubleModel>()),
       block<ModelOf<Network<float, InputSize<16>, Dense<3>, Gelu, Dense<4>>, PaperFeatures>>(),
       block<ModelOf<Network<double, InputSize<Window::size>, DenseWithoutBias<4>>, Window, RotorSpeedOutputs>>(),
       block<ModelOf<Network<float, InputSize<16>, Clip, Dense<6>>, PaperFeatures, AccelerationOutputs>>(),
       block<ModelOf<MonotonePredictor<Physics, Residual>, Physics, AxisCommandOutputs>>(),
       block<ModelOf<MonotonePredictor<Physics, Residual>, Physics, SignedSumsOn<RigidBodyBase>>>(),
       block<ModelOf<Network<float, InputSize<16>, LayerNorm<9>, Dense<8>, Glu<3>, RmsNorm<5>, Dense<4>>,
                     PaperFeatures>>()});
}
