// SPDX-License-Identifier: MIT
// Steps of many vehicles in lanes, compiled once per instruction set (vehicle_steps.cpp); the one that runs here is
// taken when the module is loaded. Each vehicle has the bits of its step alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <tuple>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/simulation/switchable_quadrotor.hpp"

namespace python {

/// Numbers of a vehicle's state, as they lie in a VehicleState<double>.
inline constexpr std::size_t state_numbers = 18;

/// The vehicle of the paper's flights: its effects, before the ground effect.
using PaperEffects =
    std::tuple<pinnquad::StandardAtmosphere, pinnquad::ConstantWind, pinnquad::PeriodicWind, pinnquad::QuadraticDrag>;

/// Vehicles that are ready to be stepped in lanes.
class VehicleSteps {
 public:
  VehicleSteps() = default;
  VehicleSteps(const VehicleSteps&) = delete;
  VehicleSteps& operator=(const VehicleSteps&) = delete;
  virtual ~VehicleSteps();
  /// `steps` steps of the vehicles `first` to `last` under held commands, four per vehicle. One whose step is refused
  /// stays as it was before that step; `statuses` says why.
  virtual void step(double* states, const double* commands, std::size_t first, std::size_t last, std::uint64_t steps,
                    std::uint8_t* statuses) const noexcept = 0;
  /// A multiple of so many vehicles is stepped without waste.
  virtual std::size_t lanes() const noexcept = 0;
};

/// The table of an object compiled for an instruction set.
struct CompiledSteps {
  const char* instruction_set;
  std::unique_ptr<VehicleSteps> (*of)(const pinnquad::Airframe<double>& airframe, const pinnquad::Site<double>& site,
                                      const PaperEffects& effects, pinnquad::GroundEffectModel ground_effect,
                                      double step_s);
};
extern const CompiledSteps steps_avx2, steps_avx512;

}  // namespace python
