// SPDX-License-Identifier: MIT
// Writes sound blocks into a folder, for the fuzzer to begin with: run_time_model_seeds DIR
#include <cstdio>
#include <string>

#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/features/windowed.hpp"
#include "pinnquad/nn/activations.hpp"
#include "pinnquad/outputs/rigid_body_base.hpp"
#include "pinnquad/outputs/wrench_outputs.hpp"
#include "support/drawn_model.hpp"

namespace {

using namespace pinnquad;
using test::ModelOf;

using Physics = PhysicsFeatures;
using Residual = Network<float, InputSize<residual_inputs<Physics>>, Dense<3>, Tanh, Dense<4>>;
using Window = PartlyWindowed<WithColumns<PaperFeatures, BatteryVoltage>, AngularAcceleration, 3,
                              PeriodMicroseconds<10000>, Centred>;

template <class Model>
void write(const std::string& folder, const char* name) {
  write_weight_file(folder + "/" + name, test::drawn_block(test::drawn_model<Model>(1)));
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fprintf(stderr, "run_time_model_seeds: expected a folder\n");
    return 2;
  }
  const std::string folder = arguments[1];
  try {
    write<ModelOf<Network<float, InputSize<16>, Dense<3>, Gelu, Dense<4>>, PaperFeatures>>(folder, "float");
    write<ModelOf<Network<double, InputSize<Window::size>, DenseWithoutBias<4>>, Window, RotorSpeedOutputs>>(folder,
                                                                                                             "window");
    write<ModelOf<Network<float, InputSize<16>, Clip, Dense<6>>, PaperFeatures, AccelerationOutputs>>(folder, "six");
    write<ModelOf<MonotonePredictor<Physics, Residual>, Physics, AxisCommandOutputs>>(folder, "monotone");
    write<ModelOf<MonotonePredictor<Physics, Residual>, Physics, SignedSumsOn<RigidBodyBase>>>(folder, "on_base");
    write<ModelOf<Network<float, InputSize<16>, LayerNorm<9>, Dense<8>, Glu<3>, RmsNorm<5>, Dense<4>>, PaperFeatures>>(
        folder, "norms");
  } catch (const pinnquad::OutputError& error) {
    std::fprintf(stderr, "run_time_model_seeds: %s\n", error.what());
    return 2;
  }
}
