// SPDX-License-Identifier: MIT
#include "pinnquad/training/trained_model.hpp"

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/nn/relu.hpp"

using namespace pinnquad;

template <int Inputs, int Outputs>
Commands<double> predicted() {
  const TrainedModel<Network<float, InputSize<Inputs>, Dense<Outputs>>, Context<PaperFeatures, PaperQuadrotor>> model;
  const auto commands = model.predict(Sample{});
  return {commands[0], commands[1], commands[2], commands[3]};
}

// SOUND
const auto commands = predicted<16, 4>();

// CASE SIX_OUTPUTS: pinnquad: a trained model's network has one output per output of its context's schema
const auto commands = predicted<16, 6>();
// CASE FIFTEEN_INPUTS: pinnquad: a trained model's network has one input per feature of its context
const auto commands = predicted<15, 4>();
