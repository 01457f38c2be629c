// SPDX-License-Identifier: MIT
// CASE SIX_OUTPUTS: pinnquad: a trained model's network has one output per output of its context's schema
// CASE FIFTEEN_INPUTS: pinnquad: a trained model's network has one input per feature of its context
#include "pinnquad/training/trained_model.hpp"

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/nn/relu.hpp"

#if defined(SIX_OUTPUTS)
using Net = pinnquad::Network<float, pinnquad::InputSize<16>, pinnquad::Dense<6>>;
#elif defined(FIFTEEN_INPUTS)
using Net = pinnquad::Network<float, pinnquad::InputSize<15>, pinnquad::Dense<4>>;
#else
using Net = pinnquad::Network<float, pinnquad::InputSize<16>, pinnquad::Dense<4>>;
#endif

int main() {
  const pinnquad::TrainedModel<Net, pinnquad::Context<pinnquad::PaperFeatures, pinnquad::PaperQuadrotor>> model;
  return model.predict(pinnquad::Sample{})[0] > 1.0F ? 1 : 0;
}
