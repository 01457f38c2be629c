// SPDX-License-Identifier: MIT
// The paper's network (Sec. 5.2) for a feature set: ten hidden layers of 25 ReLU.
#pragma once

#include "pinnquad/nn/network.hpp"
#include "pinnquad/nn/relu.hpp"

namespace programs {

template <class Features>
using PaperNetwork = pinnquad::Mlp<float, pinnquad::InputSize<Features::size>, pinnquad::Hidden<10, 25>,
                                   pinnquad::OutputSize<pinnquad::rotor_count>, pinnquad::Relu>;

}  // namespace programs
