// SPDX-License-Identifier: MIT
// Writes the models that are measured to the files named, by the library's own header writer: random weights that keep
// activations alive, scalers and an envelope of an agile multirotor, golden vectors.
#include <random>
#include <string>

#include "pinnquad/core/random.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/model/axis_aligned.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"

namespace {

using namespace pinnquad;

void write(const std::string& path, const std::string& name) {
  using Net = Mlp<float, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>;
  using Model = TrainedModel<Net, Context<PaperFeatures, PaperQuadrotor>>;
  std::mt19937_64 engine(7);
  Model model;
  int inputs = 16;
  std::size_t next = 0;
  for (const int outputs : {25, 25, 25, 25, 25, 25, 25, 25, 25, 25, 4}) {
    const double limit = std::sqrt(6.0 / inputs);  // He et al. (2015): ReLU keeps the spread from layer to layer
    for (int i = 0; i < inputs * outputs; ++i) model.network.parameters[next++] = float(uniform(engine, -limit, limit));
    for (int i = 0; i < outputs; ++i) model.network.parameters[next++] = float(uniform(engine, -0.1, 0.1));
    inputs = outputs;
  }
  // accelerations, velocity, rates, tilt, heading: spread in SI units
  const double spread[16] = {4, 4, 4, 10, 10, 10, 3, 3, 3, 1.5, 1.5, 1.5, 0.8, 0.5, 0.7, 0.7};
  for (std::size_t i = 0; i < 16; ++i) {
    model.input.mean[i] = float(spread[i] * uniform(engine, -0.2, 0.2));
    model.input.standard_deviation[i] = float(spread[i]);
    model.envelope_lower[i] = float(-5.0 * spread[i]);
    model.envelope_upper[i] = float(5.0 * spread[i]);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    model.output.mean[i] = 0.5F;
    model.output.standard_deviation[i] = 0.1F;
  }
  std::vector<Model::FeatureVector> golden(4);
  for (auto& x : golden) {
    for (std::size_t i = 0; i < 16; ++i) x[i] = float(spread[i] * uniform(engine, -1.0, 1.0));
  }
  write_model_header(path, name, model, golden, {"random weights", 0, 0, 7, 0, "none"});
}

/// A base and a residual of the recipe `structured`; as a block, too.
void write_structured(const std::string& path, const std::string& block, const std::string& name) {
  using Features = InverseFeatures;
  using Residual = Mlp<float, InputSize<residual_inputs<Features>>, Hidden<2, 32>, OutputSize<4>, Relu>;
  using Answer = MonotonePredictor<Features, Residual>;
  using Model = TrainedModel<Answer, Context<Features, PaperQuadrotor, AxisCommandOutputs>>;
  std::mt19937_64 engine(8);
  Model model;
  for (float& v : model.network.parameters) v = float(uniform(engine, -0.2, 0.2));
  for (std::size_t i = 0; i < 3; ++i) model.network.parameters[i] = float(uniform(engine, 0.2, 0.8));  // slopes
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t bounds = std::size_t(MonotoneBase<Features>::parameter_count);
    model.network.parameters[bounds + k] = -0.3F;
    model.network.parameters[bounds + 4 + k] = 0.3F;
  }
  for (std::size_t i = 0; i < model.input.mean.size(); ++i) {
    model.input.mean[i] = float(uniform(engine, -0.2, 0.2));
    model.input.standard_deviation[i] = 8.0F;
    model.envelope_lower[i] = -200.0F;
    model.envelope_upper[i] = 200.0F;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    model.output.mean[i] = i == 0 ? 2.0F : 0.0F;
    model.output.standard_deviation[i] = 0.1F;
  }
  std::vector<Model::FeatureVector> golden(4);
  for (auto& x : golden) {
    for (float& v : x) v = float(8 * uniform(engine, -1.0, 1.0));
  }
  const Provenance provenance{"random weights", 0, 0, 8, 0, "none"};
  write_model_header(path, name, model, golden, provenance);
  write_weight_file(block, model_block(model, golden, provenance, name));
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  write(arguments[1], "PaperModel");
  write_structured(arguments[2], arguments[3], "StructuredModel");
  return 0;
}
