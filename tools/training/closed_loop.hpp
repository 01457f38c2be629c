// SPDX-License-Identifier: MIT
// A model of logged flights in a closed loop: the vehicle that is identified in them flies a figure-eight inside what
// they have flown, by the model, beside the analytic inverse, with and without the path's jerk.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include <nlohmann/json.hpp>

#include "flight/loop_figures.hpp"
#include "identify/identified_vehicle.hpp"
#include "pinnquad/aero/battery.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace programs {

/// Of an identification the part that an airframe can't hold: linear drag, damping, turning by the air, the trim in
/// yaw. A number that is not told to within half of it is 0, and so is one that would drive the vehicle on.
struct IdentifiedAir {
  static constexpr pinnquad::VariesWith varies_with = pinnquad::VariesWith::motion;
  std::array<double, 3> linear_drag_1_s{}, damping_1_s{}, by_velocity_rad_s_m{};
  double yaw_trim_rad_s2 = 0;

  IdentifiedAir() = default;
  explicit IdentifiedAir(const pinnquad::Identification& found) {
    const auto told = [](const pinnquad::Estimate& estimate) {
      return pinnquad::is_told(estimate, 0.5) ? estimate.value : 0.0;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      linear_drag_1_s[axis] = std::max(told(found.linear_drag_1_s[axis]), 0.0);
      damping_1_s[axis] = std::max(told(found.damping_1_s[axis]), 0.0);
      by_velocity_rad_s_m[axis] = told(found.by_velocity_rad_s_m[axis]);
    }
    // in hover, where all rotors together bear the vehicle
    yaw_trim_rad_s2 = told(found.imbalance[2]) * told(found.effectiveness_rad_s2[2]) *
                      pinnquad::standard_gravity_m_s2<double> / found.thrust_m_s2.value;
  }

  template <class Scalar>
  pinnquad::Wrench<Scalar> wrench(const pinnquad::AeroCondition<Scalar>& condition,
                                  const pinnquad::Airframe<Scalar>& airframe) const noexcept {
    pinnquad::Wrench<Scalar> result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<int>(axis), across = axis == 1 ? 0 : 1;
      const auto& velocity = condition.air_relative_velocity_m_s;
      result.force_N[i] = -airframe.mass_kg * Scalar(linear_drag_1_s[axis]) * velocity[i];
      Scalar turn = Scalar(by_velocity_rad_s_m[axis]) * velocity[across] -
                    Scalar(damping_1_s[axis]) * condition.body_rates_rad_s[i];
      if (axis == 2) turn += Scalar(yaw_trim_rad_s2);
      result.torque_N_m[i] = airframe.inertia_kg_m2[axis] * turn;
    }
    return result;
  }
};

using IdentifiedQuadrotor =
    pinnquad::Quadrotor<double, pinnquad::Switched<pinnquad::Battery>, pinnquad::QuadraticDrag, IdentifiedAir>;

/// As it was identified. Drag along an axis is linear and quadratic where the flights tell the linear part, else all
/// quadratic, as the airframe has it.
inline IdentifiedQuadrotor identified_quadrotor(const IdentifiedVehicle& vehicle,
                                                const std::optional<pinnquad::Battery>& battery = {}) {
  pinnquad::Airframe<double> airframe = vehicle.airframe->value;
  const IdentifiedAir air(vehicle.found);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(air.linear_drag_1_s[axis] > 0)) continue;
    const pinnquad::Estimate& beside = vehicle.found.quadratic_drag_1_m[axis];
    const double drag_1_m = pinnquad::is_told(beside, 0.5) ? std::max(beside.value, 0.0) : 0.0;
    airframe.drag_area_m2[axis] = drag_1_m * airframe.mass_kg / pinnquad::rated_air_density_kg_m3<double>;
  }
  return IdentifiedQuadrotor(airframe, {}, {battery.value_or(pinnquad::Battery{}), battery.has_value()}, {}, air);
}

/// Results of the flight, for report.json, and its traces for the page; `why_not` alone where there was none. Under the
/// guard of its export: outside its envelope, and while its window fills, the analytic inverse answers.
nlohmann::json fly_logged(const pinnquad::BlockModel& model, const pinnquad::RowSet& training,
                          const IdentifiedVehicle& identified, bool has_velocity, FlownTraces& traces);

}  // namespace programs
