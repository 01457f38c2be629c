// SPDX-License-Identifier: MIT
// Both cores with a structured model, limits of trust, and an analytic inverse with other effects than by default.
#pragma once

#include "models/structured_quadrotor.hpp"
#include "pinnquad/aero/drag.hpp"
#include "stacks.hpp"
#include "structured_trust.hpp"

namespace pinnquad::autopilot::test {

template <>
struct TrustOf<StructuredQuadModel> {
  using type = StructuredQuadModelTrust;
};

using TrustingController =
    NeuralController<StructuredQuadModel, pinnquad::ModelView<StructuredQuadModel>,
                     pinnquad::Quadrotor<float, pinnquad::LinearDamping, pinnquad::QuadraticDrag>,
                     StructuredQuadModelTrust>;
using TrustingPx4Stack = Px4StackOf<StructuredQuadModel, TrustingController>;
using TrustingCrazyflieStack = CrazyflieStackOf<StructuredQuadModel, TrustingController>;

template <class Stack>
inline constexpr bool is_trusting =
    std::is_same_v<Stack, TrustingPx4Stack> || std::is_same_v<Stack, TrustingCrazyflieStack>;

}  // namespace pinnquad::autopilot::test
