// SPDX-License-Identifier: MIT
// The flight stacks' controller (pinnquad/control/autopilot/neural_controller.hpp) of a model that is known at run time
// alone, its guard, and an airframe as it has one.
#pragma once

#include "airframe/names.hpp"
#include "model/run_time_view.hpp"
#include "pinnquad/control/autopilot/neural_controller.hpp"

namespace programs {

/// The guard that flies.
using FlightStackController = pinnquad::autopilot::NeuralController<RunTimeShape<pinnquad::PaperFeatures, float>,
                                                                    RunTimeView<pinnquad::PaperFeatures, float>>;
using FallbackInverse = FlightStackController::Analytic;
using FlightStackGuard = pinnquad::Extend<FlightStackController::NetworkGuard, pinnquad::Fallback<FallbackInverse>>;

/// The airframe as flight code has it: of the program's own airframes the type's numbers, else each rounded.
inline pinnquad::Airframe<float> flying_airframe(const NamedAirframe& airframe) {
  pinnquad::Airframe<float> result = pinnquad::airframe_in<float>(airframe.value);
  each_airframe([&](auto tag) {
    using Vehicle = typename decltype(tag)::type;
    const bool same =
        airframe.name == Vehicle::name &&
        pinnquad::detail::equal(airframe.value.mass_kg, pinnquad::airframe_value<Vehicle, double>().mass_kg);
    if (same) result = pinnquad::airframe_value<Vehicle, float>();
  });
  return result;
}

}  // namespace programs
