// SPDX-License-Identifier: MIT
// The paper's network (Sec. 5.2) with and without batch norm.
#pragma once

#include "pinnquad/inference/features.hpp"
#include "pinnquad/nn/network.hpp"
#include "pinnquad/nn/relu.hpp"
#include "study_models.hpp"

namespace study {

template <class Features, class BatchNormChoice>
struct PaperNetwork {
  using type = pinnquad::Mlp<float, pinnquad::Inputs<Features::size>, pinnquad::Hidden<10, 25>,
                             pinnquad::Outputs<pinnquad::rotor_count>, pinnquad::Relu>;
};

/// The network as it is judged.
template <class Network>
Network flight_ready(const Network& network) {
  return network;
}

}  // namespace study
