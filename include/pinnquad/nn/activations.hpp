// SPDX-License-Identifier: MIT
// The activations of the library, each in a header of its own.
#pragma once

#include <tuple>

#include "pinnquad/nn/clip.hpp"
#include "pinnquad/nn/elu.hpp"
#include "pinnquad/nn/gelu.hpp"
#include "pinnquad/nn/gelu_tanh.hpp"
#include "pinnquad/nn/hard_swish.hpp"
#include "pinnquad/nn/leaky_relu.hpp"
#include "pinnquad/nn/mish.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/silu.hpp"
#include "pinnquad/nn/sine.hpp"
#include "pinnquad/nn/softplus.hpp"
#include "pinnquad/nn/softsign.hpp"
#include "pinnquad/nn/tanh.hpp"

namespace pinnquad {

/// Every activation of the library. The program finds one here by its `description` when it reads a header.
using Activations =
    std::tuple<Relu, Tanh, Gelu, Silu, Softplus, Sine, Clip, Elu, LeakyRelu, GeluTanh, HardSwish, Mish, Softsign>;

}  // namespace pinnquad
