// SPDX-License-Identifier: MIT
// Earlier names that exported headers of formats 1 to 3 and their trust.hpp say, beside the names of today
// (CHANGELOG.md has the table).
#pragma once

#include <type_traits>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/model/axis_aligned.hpp"
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

namespace detail {

template <class Trust>
using EarlierDistanceLimit = decltype(Trust::distance_limit);
template <class Trust>
struct RenamedDistance : Trust {
  static constexpr double squared_distance_limit = Trust::distance_limit;
};
template <class Trust>
using EarlierResidualLimit = decltype(Trust::innovation_limit);
template <class Trust>
struct RenamedResidual : Trust {
  static constexpr double command_residual_factor = Trust::innovation_factor;
  static constexpr double command_residual_limit = Trust::innovation_limit;
  static constexpr double command_residual_cleared = Trust::innovation_cleared;
};

/// A trust.hpp by the names of today (inference/joint_distance.hpp).
template <class Trust>
using DistanceTrust = std::conditional_t<is_detected<EarlierDistanceLimit, Trust>, RenamedDistance<Trust>, Trust>;
/// The same for inference/command_residual.hpp.
template <class Trust>
using ResidualTrust = std::conditional_t<is_detected<EarlierResidualLimit, Trust>, RenamedResidual<Trust>, Trust>;

}  // namespace detail
}  // namespace pinnquad
