// SPDX-License-Identifier: MIT
// An exported header taken back to the trained model that it was written from.
#pragma once

#include "pinnquad/deploy/weight_file.hpp"

namespace pinnquad::test {

template <class Header>
using Trained = TrainedModel<typename Header::Network,
                             Context<typename Header::Features, typename Header::Vehicle, typename Header::Outputs>>;

template <class Header>
Trained<Header> trained_model(Trained<Header> model = {}) {
  model.network.parameters = Header::parameters;
  model.input = Header::input;
  model.output = Header::output;
  model.envelope_lower = Header::envelope_lower;
  model.envelope_upper = Header::envelope_upper;
  return model;
}

}  // namespace pinnquad::test
