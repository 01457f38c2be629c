// SPDX-License-Identifier: MIT
// Steps of many vehicles in lanes: each has the bits of its step alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "pinnquad/simulation/switched_quadrotor.hpp"

namespace python {

/// Numbers of a vehicle's state, as they lie in a VehicleState<double>.
inline constexpr std::size_t state_numbers = 19;

/// Vehicles that are ready to be stepped in lanes: in groups, each with airframes of its own, or one airframe for all.
class VehicleSteps {
 public:
  VehicleSteps() = default;
  VehicleSteps(const VehicleSteps&) = delete;
  VehicleSteps& operator=(const VehicleSteps&) = delete;
  virtual ~VehicleSteps();
  /// One airframe for all.
  virtual void set_airframe(const pinnquad::Airframe<double>& airframe) = 0;
  /// Airframes of a group's vehicles, `count` of them, at most lanes(). The groups are made in order. False, and
  /// nothing done, where rotors turn in different senses: lanes share them.
  virtual bool set_airframes(std::size_t group, const pinnquad::Airframe<double>* airframes, std::size_t count) = 0;
  /// `steps` steps of the vehicles `first` (the first of a group) to `last` under held commands, four per vehicle. One
  /// whose step is refused stays as it was before that step; `statuses` says why.
  virtual void step(double* states, const double* commands, std::size_t first, std::size_t last, std::uint64_t steps,
                    std::uint8_t* statuses) const noexcept = 0;
  /// Of a group.
  virtual std::size_t lanes() const noexcept = 0;
};

/// Under these effects. Airframes are set before the first step.
std::unique_ptr<VehicleSteps> steps_in_lanes(const pinnquad::Site<double>& site, double step_s,
                                             const pinnquad::SwitchedEffects& effects);

}  // namespace python
