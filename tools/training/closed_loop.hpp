// SPDX-License-Identifier: MIT
// A model of logged flights in a closed loop: the vehicle that the logs show flies a figure-eight inside what they have
// flown, with the model as feed-forward, beside the analytic inverse and none.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "airframe/choice.hpp"
#include "flight/block_feed_forward.hpp"
#include "flight/loop_figures.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/control/flatness.hpp"
#include "pinnquad/control/trajectory.hpp"
#include "pinnquad/simulation/simulator.hpp"
#include "pinnquad/simulation/tracking.hpp"
#include "training/logged_vehicle.hpp"

namespace programs {

using LoggedQuadrotor = pinnquad::Quadrotor<double, pinnquad::QuadraticDrag, LoggedTorque>;

/// The median of each column that the model asks for, in the first training flight: what the loop holds it at.
inline std::vector<double> held_columns(const pinnquad::BlockModel& model, const pinnquad::RowSet& training) {
  std::vector<double> held;
  for (const pinnquad::ColumnName& column : model.columns()) {
    const pinnquad::Flight& flight = *training.pieces().front().flight;
    std::vector<double> values = flight.column(column.name)->values;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    held.push_back(*middle);
  }
  return held;
}

/// Limits that flights have reached in all but their last hundredths.
struct FlownEnvelope {
  double speed_m_s = 0, tilt_rad = 0, turning_rad_s = 0, angular_acceleration_rad_s2 = 0;
};

inline FlownEnvelope flown_envelope(const pinnquad::RowSet& rows) {
  constexpr double share = 0.98;
  std::array<std::vector<double>, 4> values;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const pinnquad::Sample& sample = rows[row];
    values[0].push_back(sample.velocity_m_s.norm());
    values[1].push_back(std::acos(std::clamp(std::cos(sample.roll_rad) * std::cos(sample.pitch_rad), -1.0, 1.0)));
    values[2].push_back(sample.body_rates_rad_s.norm());
    values[3].push_back(sample.angular_acceleration_rad_s2.norm());
  }
  const auto reached = [&](std::vector<double>& of) {
    const auto place = of.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(of.size() - 1));
    std::nth_element(of.begin(), place, of.end());
    return *place;
  };
  return {reached(values[0]), reached(values[1]), reached(values[2]), reached(values[3])};
}

/// The fastest figure-eight of its size, within the envelope; speed counts for nothing where it was not logged. None if
/// not even a slow one is.
inline std::optional<pinnquad::FigureEight<double>> eight_within(const FlownEnvelope& envelope, bool has_velocity) {
  constexpr double slowest_s = 60, slower = 1.05;
  pinnquad::FigureEight<double> eight;
  const double size = has_velocity ? std::clamp(envelope.speed_m_s / 4, 0.05, 1.0) : 0.25;
  eight.center_m = {0, 0, -20};
  eight.half_length_m *= size;
  eight.half_width_m *= size;
  eight.half_height_m *= size;
  for (eight.period_s = 2; eight.period_s < slowest_s; eight.period_s *= slower) {
    bool inside = true;
    for (double time_s = 0; inside && time_s < eight.ramp_s + eight.period_s; time_s += 0.02 * eight.period_s) {
      const auto point = eight.sample(time_s);
      pinnquad::FlatMotion<double> motion;
      inside = pinnquad::flat_motion(point, pinnquad::standard_gravity_m_s2<double>, motion) == pinnquad::Status::ok &&
               (!has_velocity || point.velocity_m_s.norm() <= envelope.speed_m_s) &&
               pinnquad::tilt_rad(motion.attitude) <= envelope.tilt_rad &&
               motion.body_rates_rad_s.norm() <= envelope.turning_rad_s &&
               motion.angular_acceleration_rad_s2.norm() <= envelope.angular_acceleration_rad_s2;
    }
    if (inside) return eight;
  }
  return {};
}

/// Results of the flight, for report.json and the page; `why_not` alone where there was none. The model answers outside
/// its envelope too; while its window fills, the analytic inverse does.
inline nlohmann::json fly_logged(const pinnquad::BlockModel& model, const pinnquad::RowSet& training,
                                 const NamedAirframe& airframe,
                                 const std::array<std::array<double, pinnquad::rotor_count>, 3>& signs,
                                 bool has_velocity) {
  const LoggedEffects effects = logged_effects(training, signs);
  const auto made = logged_vehicle(airframe.value, effects);
  if (!made) return {{"why_not", "the commands of the logs do not lift and turn a vehicle as they should"}};
  const auto eight = eight_within(flown_envelope(training), has_velocity);
  if (!eight) return {{"why_not", "the flights hold no figure-eight, however slow"}};
  const LoggedQuadrotor vehicle(*made, {}, {}, LoggedTorque{effects.damping_1_s, effects.trim_rad_s2});
  pinnquad::HoverTrim<double> trim;
  if (pinnquad::hover_trim(vehicle, eight->center_m, trim) != pinnquad::Status::ok) {
    return {{"why_not", "the vehicle of the logs does not hover"}};
  }
  pinnquad::TrackingPlan<double> plan;
  plan.duration_s = std::max(20.0, eight->ramp_s + 2 * eight->period_s);
  plan.steps_per_control = 4;
  const pinnquad::FlightController<double> controller({}, pinnquad::flight_limits(*made, 1.0));
  using Analytic = pinnquad::AnalyticInverse<LoggedQuadrotor>;
  using Guard = pinnquad::Guard<pinnquad::FiniteInputs, pinnquad::FiniteOutputs, pinnquad::ClipCommands<>,
                                pinnquad::Fallback<Analytic>>;
  const Analytic analytic(vehicle);
  const auto fly = [&](const auto& feed_forward) {
    return pinnquad::track(vehicle, *eight, controller, feed_forward, plan);
  };
  const auto by_model = with_feed_forward(model, Guard(analytic), 0, held_columns(model, training), fly);
  nlohmann::json result = {{"trajectory", "figure-eight"},
                           {"half_length_m", eight->half_length_m},
                           {"period_s", eight->period_s},
                           {"model", loop_figures(by_model)},
                           {"formula", loop_figures(fly(analytic))},
                           {"hover_trim", loop_figures(fly(trim))}};
  result["model"]["answered_share"] = answered_share(by_model.fallback);
  return result;
}

}  // namespace programs
