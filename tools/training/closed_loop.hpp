// SPDX-License-Identifier: MIT
// A model of logged flights in a closed loop: the vehicle that the logs show flies a figure-eight inside what they have
// flown, with the model as feed-forward, beside the analytic inverse and none.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "airframe/choice.hpp"
#include "flight/block_feed_forward.hpp"
#include "flight/loop_figures.hpp"
#include "flight/loop_trajectories.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/simulation/simulator.hpp"
#include "pinnquad/simulation/tracking.hpp"
#include "training/logged_vehicle.hpp"

namespace programs {

using LoggedQuadrotor = pinnquad::Quadrotor<double, pinnquad::QuadraticDrag, LoggedTorque>;

/// The median of each column that the model asks for, in the first training flight: what the loop holds it at.
inline std::vector<double> usual_columns(const pinnquad::BlockModel& model, const pinnquad::RowSet& training) {
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

/// Of what fly_logged() found: why the model is not fit to fly; empty if it is, or was not flown.
inline std::string unfit_to_fly(const nlohmann::json& flown) {
  constexpr double least_answered = 0.5;
  if (!flown.contains("model")) return "";
  const nlohmann::json& model = flown["model"];
  char text[160] = "";
  if (lost_vehicle(flown)) {
    std::snprintf(text, sizeof text, "loses the vehicle in the closed loop (%.1f m off)",
                  model["largest_error_m"].get<double>());
  } else if (model["answered_share"] < least_answered) {
    std::snprintf(text, sizeof text, "answers %.1f %% of a figure-eight that the logs' own limits hold",
                  100 * model["answered_share"].get<double>());
  }
  return text;
}

/// Results of the flight, for report.json and the page; `why_not` alone where there was none. Under the guard of its
/// export: outside its envelope, and while its window fills, the analytic inverse answers.
inline nlohmann::json fly_logged(const pinnquad::BlockModel& model, const pinnquad::RowSet& training,
                                 const NamedAirframe& airframe,
                                 const std::array<std::array<double, pinnquad::rotor_count>, 3>& signs,
                                 bool has_velocity) {
  const LoggedEffects effects = logged_effects(training, signs);
  const auto made = logged_vehicle(airframe.value, effects);
  if (!made) return {{"why_not", "the commands of the logs do not lift and turn a vehicle as they should"}};
  constexpr double shortest_s = 2;
  const auto eight = eight_for(*made, 0, flown_envelope(training, has_velocity), shortest_s);
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
  const Analytic analytic(vehicle);
  const auto fly = [&](const auto& feed_forward) {
    return pinnquad::track(vehicle, *eight, controller, feed_forward, plan);
  };
  nlohmann::json result = {{"trajectory", "figure-eight"},           {"half_length_m", eight->half_length_m},
                           {"half_width_m", eight->half_width_m},    {"period_s", eight->period_s},
                           {"formula", loop_figures(fly(analytic))}, {"hover_trim", loop_figures(fly(trim))}};
  if (lost_vehicle(result, "formula") || result["formula"]["rmse_m"] > result["hover_trim"]["rmse_m"]) {
    return {{"why_not", "the vehicle of the logs is not known well enough: its own formula does not fly it"}};
  }
  using Guard = pinnquad::Extend<pinnquad::TrainingGuard, pinnquad::Fallback<Analytic>>;
  const auto by_model = with_feed_forward(model, Guard(analytic), 0, usual_columns(model, training), fly);
  result["model"] = loop_figures(by_model);
  result["model"]["answered_share"] = answered_share(by_model.fallback);
  return result;
}

}  // namespace programs
