// SPDX-License-Identifier: MIT
// Names of pinnquad 0.x that exported headers of formats 1 to 3 say, beside the names of today (CHANGELOG.md has the table).
#pragma once

#include "pinnquad/model/masked.hpp"
#include "pinnquad/model/saturated.hpp"
#include "pinnquad/nn/layer.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/outputs/rigid_body_base.hpp"

namespace pinnquad {

template <int Size>
using Inputs = InputSize<Size>;
using SignedSumOutputs = AxisCommandOutputs;
using LinearizedInverse = LinearizedBase;
using RigidBodyInverse = RigidBodyBase;
template <class Inner>
using Bounded = Saturated<Inner>;
template <class Inner, int InputCount, int... Places>
using Withheld = Masked<Inner, InputCount, Places...>;

}  // namespace pinnquad
