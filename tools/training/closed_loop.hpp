// SPDX-License-Identifier: MIT
// A model of logged flights in a closed loop: the vehicle that is identified in them flies a figure-eight inside what
// they have flown, by the model, beside the analytic inverse, with and without the path's jerk.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "airframe/choice.hpp"
#include "flight/battery_choice.hpp"
#include "flight/block_feed_forward.hpp"
#include "flight/loop_figures.hpp"
#include "flight/loop_trajectories.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/data/plausibility.hpp"
#include "pinnquad/simulation/simulator.hpp"
#include "pinnquad/simulation/tracking.hpp"
#include "training/command_comparison.hpp"
#include "training/flown_vehicle.hpp"
#include "training/given_vehicle.hpp"

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

/// Limits that flights have reached in all but their last hundredths; of body axes each its own. A range of motions
/// (flight/loop_trajectories.hpp); speed counts for nothing where it was not logged.
struct FlownEnvelope {
  std::array<double, 3> fastest_m_s{}, turning_rad_s{}, angular_acceleration_rad_s2{};
  double tilt_rad = 0;
  bool has_velocity = true;

  std::optional<std::pair<double, double>> altitude_m() const { return {}; }
  std::optional<double> speed_m_s(std::size_t axis) const {
    constexpr double unknown_m_s = 1;  // a small figure then
    return has_velocity ? fastest_m_s[axis] : unknown_m_s;
  }
  bool holds(const pinnquad::MotionInputs<double>& motion) const {
    return (!has_velocity || within(motion.velocity_m_s, fastest_m_s)) &&
           pinnquad::tilt_rad(motion.attitude) <= tilt_rad && within(motion.body_rates_rad_s, turning_rad_s) &&
           within(motion.angular_acceleration_rad_s2, angular_acceleration_rad_s2);
  }

 private:
  static bool within(const pinnquad::Vector3<double>& vector, const std::array<double, 3>& limits) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(vector[axis]) <= limits[static_cast<std::size_t>(axis)])) return false;
    }
    return true;
  }
};

inline FlownEnvelope flown_envelope(const pinnquad::RowSet& rows, bool has_velocity) {
  constexpr double share = 0.98;
  const auto reached = [&rows](const auto& value_of) {
    std::vector<double> values;
    for (std::size_t row = 0; row < rows.size(); ++row) values.push_back(value_of(rows[row]));
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  FlownEnvelope envelope;
  envelope.has_velocity = has_velocity;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<int>(i);
    envelope.fastest_m_s[i] = reached([axis](const auto& sample) { return std::abs(sample.velocity_m_s[axis]); });
    envelope.turning_rad_s[i] = reached([axis](const auto& sample) { return std::abs(sample.body_rates_rad_s[axis]); });
    envelope.angular_acceleration_rad_s2[i] =
        reached([axis](const auto& sample) { return std::abs(sample.angular_acceleration_rad_s2[axis]); });
  }
  envelope.tilt_rad = reached([](const auto& sample) {
    return std::acos(std::clamp(std::cos(sample.roll_rad) * std::cos(sample.pitch_rad), -1.0, 1.0));
  });
  return envelope;
}

/// Results of the flight, for report.json, and its traces for the page; `why_not` alone where there was none. Under the
/// guard of its export: outside its envelope, and while its window fills, the analytic inverse answers.
inline nlohmann::json fly_logged(const pinnquad::BlockModel& model, const pinnquad::RowSet& training,
                                 const IdentifiedVehicle& identified, bool has_velocity, FlownTraces& traces) {
  if (!identified.airframe) return {{"why_not", "the flights do not identify their vehicle"}};
  constexpr double shortest_s = 2;
  const auto eight = eight_for(identified.airframe->value, 0, flown_envelope(training, has_velocity), shortest_s);
  if (!eight) return {{"why_not", "the flights hold no figure-eight, however slow"}};
  const IdentifiedQuadrotor vehicle = identified_quadrotor(identified);
  pinnquad::Commands<double> trim{};
  if (pinnquad::hover_trim(vehicle, eight->center_m, trim) != pinnquad::Status::ok) {
    return {{"why_not", "the vehicle that was identified does not hover"}};
  }
  pinnquad::TrackingPlan<double> plan;
  plan.duration_s = std::max(20.0, eight->ramp_s + 2 * eight->period_s);
  plan.steps_per_control = 4;
  const pinnquad::FlightController<double> controller({}, pinnquad::flight_limits(vehicle.airframe(), 1.0));
  using Analytic = pinnquad::AnalyticInverse<IdentifiedQuadrotor>;
  const Analytic analytic(vehicle);
  const auto fly = [&](BatteryWorld<IdentifiedQuadrotor> world, const AnyTrajectory& path,
                       const AnyFeedForward& feed_forward, FlownTrace& trace) {
    return pinnquad::track(vehicle, world, path, controller, feed_forward, plan, trace.observer(plan.duration_s));
  };
  const AnyTrajectory path{[&eight](double time_s) { return eight->sample(time_s); }};
  const AnyTrajectory no_jerk{[&eight](double time_s) { return without_jerk(eight->sample(time_s)); }};
  const auto alone = fly({{vehicle}}, no_jerk, AnyFeedForward(analytic), traces.without);
  nlohmann::json result = {{"trajectory", "figure-eight"},
                           {"half_length_m", eight->half_length_m},
                           {"half_width_m", eight->half_width_m},
                           {"period_s", eight->period_s},
                           {"without_jerk", loop_figures(alone)},
                           {"formula", loop_figures(fly({{vehicle}}, path, AnyFeedForward(analytic), traces.model))}};
  if (analytic_inverse_fails(result)) {
    return {{"why_not", "the vehicle that was identified is not known well enough: its own formula does not fly it"}};
  }
  using Guard = pinnquad::Extend<pinnquad::TrainingGuard, pinnquad::Fallback<Analytic>>;
  ComparedCommands compared;
  std::vector<double> columns = usual_columns(model, training);
  const auto battery = battery_of_flights(model, training, vehicle.airframe());
  const ComparedPolicy policy{model_inverse(model, Guard(analytic), 0, columns), analytic, vehicle.airframe(),
                              &compared};
  const auto by_model =
      fly({{identified_quadrotor(identified, battery)}, battery ? voltage_among(model, columns) : nullptr}, path,
          AnyFeedForward(policy), traces.model);
  result["model"] = loop_figures(by_model);
  result["against_formula"] = comparison_json(compared);
  result["model"]["answered_share"] = answered_share(by_model.fallback);
  return result;
}

}  // namespace programs
