// SPDX-License-Identifier: MIT
// The flight stacks' controller (pinnquad/control/autopilot/neural_controller.hpp) of a model that is known at run time
// alone, its guard, and an airframe as it has one.
#pragma once

#include "model/run_time_view.hpp"
#include "pinnquad/control/autopilot/neural_controller.hpp"

namespace programs {

/// The guard that flies.
using FlightStackController =
    pinnquad::autopilot::NeuralController<RunTimeShape<CoreFeatures, float>, RunTimeView<CoreFeatures, float>>;
using FallbackInverse = FlightStackController::Analytic;
using FlightStackGuard = pinnquad::Extend<FlightStackController::NetworkGuard, pinnquad::Fallback<FallbackInverse>>;

/// The airframe as flight code has it.
inline pinnquad::Airframe<float> flying_airframe(const pinnquad::BlockModel& model) {
  return model.with([](const auto& own) {
    if constexpr (std::is_same_v<std::decay_t<decltype(own.flown_airframe())>, pinnquad::Airframe<float>>) {
      return own.flown_airframe();
    } else {
      return pinnquad::airframe_in<float>(own.airframe());
    }
  });
}

}  // namespace programs
