// SPDX-License-Identifier: MIT
// A model of logged flights in a closed loop: the vehicle that the logs show flies a figure-eight inside what they have
// flown, with the model as feed-forward, beside the analytic inverse and none.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "pinnquad/aero/drag.hpp"
#include "pinnquad/control/flatness.hpp"
#include "pinnquad/control/trajectory.hpp"
#include "pinnquad/simulation/simulator.hpp"
#include "pinnquad/simulation/tracking.hpp"
#include "training/logged_vehicle.hpp"
#include "training/model_kind.hpp"
#include "training/trained_network.hpp"
#include "training/wanted_row.hpp"

namespace programs {

using LoggedQuadrotor = pinnquad::Quadrotor<double, pinnquad::QuadraticDrag, LoggedTorque>;

/// The model as a feed-forward policy: asked with the rows of the last instants as a flight, as it was judged. Where it
/// has no answer (its window is not complete) the formula of the vehicle answers, and that is counted.
class LoggedFeedForward {
 public:
  /// Extra columns are held at the medians of the training rows.
  LoggedFeedForward(std::shared_ptr<const TrainedNetwork> model, TimeReach reach, const LoggedQuadrotor& vehicle,
                    const pinnquad::RowSet& training)
      : model_(std::move(model)), formula_(vehicle), window_s_(reach == TimeReach::present ? 0 : longest_window_s) {
    for (const pinnquad::ExtraColumn& column : training.pieces().front().flight->columns()) {
      std::vector<double> values = column.values;
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      pinnquad::ExtraColumn held;
      held.name = column.name;
      held.unit = column.unit;
      held.values = {*middle};
      held_.push_back(std::move(held));
    }
  }

  pinnquad::Status operator()(const pinnquad::State<double>& state, const pinnquad::Accelerations<double>& desired,
                              std::uint64_t time_us, pinnquad::Commands<double>& commands) noexcept {
    try {
      remember(state, desired, pinnquad::seconds_of(time_us));
      pinnquad::Flight flight;
      for (const pinnquad::Sample& sample : past_) flight.push_back(sample);
      for (pinnquad::ExtraColumn column : held_) {
        column.values.assign(past_.size(), column.values.front());
        flight.add_column(std::move(column));
      }
      ++asked_;
      const auto made = model_->predictions(pinnquad::RowSet(flight, {0, flight.size()})).back();
      if (std::all_of(made.begin(), made.end(), [](double u) { return std::isfinite(u); })) {
        ++answered_;
        for (std::size_t i = 0; i < commands.size(); ++i) commands[i] = std::clamp(made[i], 0.0, 1.0);
        return pinnquad::Status::ok;
      }
      return formula_(state, desired, time_us, commands);
    } catch (const std::exception&) {
      return pinnquad::Status::not_finite;
    }
  }

  double answered_share() const {
    return asked_ > 0 ? static_cast<double>(answered_) / static_cast<double>(asked_) : 0.0;
  }

 private:
  static constexpr double longest_window_s = 0.25;

  void remember(const pinnquad::State<double>& state, const pinnquad::Accelerations<double>& desired, double time_s) {
    past_.push_back(wanted_row(state, desired, time_s));
    past_.erase(past_.begin(), std::find_if(past_.begin(), past_.end(), [&](const pinnquad::Sample& old) {
                  return old.time_s >= time_s - window_s_;
                }));
  }

  std::shared_ptr<const TrainedNetwork> model_;
  pinnquad::AnalyticInverse<LoggedQuadrotor> formula_;
  double window_s_;
  std::vector<pinnquad::ExtraColumn> held_;
  std::vector<pinnquad::Sample> past_;
  std::size_t asked_ = 0, answered_ = 0;
};

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

/// Results of the flight, for report.json and the page; `why_not` alone where there was none.
inline nlohmann::json fly_logged(const std::shared_ptr<const TrainedNetwork>& model, TimeReach reach,
                                 const pinnquad::RowSet& training, const NamedAirframe& airframe,
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
  const auto told = [](const pinnquad::TrackingResult<double>& flown) {
    constexpr auto ok = pinnquad::Status::ok;
    return nlohmann::json{{"rmse_m", flown.rmse_m},
                          {"largest_error_m", flown.max_error_m},
                          {"flown_s", flown.flown_s},
                          {"status", pinnquad::to_string(flown.status != ok ? flown.status : flown.declined)}};
  };
  // the policy is copied into the loop: what it counts is shared
  struct Counted {
    std::shared_ptr<LoggedFeedForward> policy;
    pinnquad::Status operator()(const pinnquad::State<double>& state, const pinnquad::Accelerations<double>& desired,
                                std::uint64_t time_us, pinnquad::Commands<double>& commands) noexcept {
      return (*policy)(state, desired, time_us, commands);
    }
  };
  const Counted policy{std::make_shared<LoggedFeedForward>(model, reach, vehicle, training)};
  nlohmann::json result = {
      {"trajectory", "figure-eight"},
      {"half_length_m", eight->half_length_m},
      {"period_s", eight->period_s},
      {"model", told(pinnquad::track(vehicle, *eight, controller, policy, plan))},
      {"formula",
       told(pinnquad::track(vehicle, *eight, controller, pinnquad::AnalyticInverse<LoggedQuadrotor>(vehicle), plan))},
      {"hover_trim", told(pinnquad::track(vehicle, *eight, controller, trim, plan))}};
  result["model"]["answered_share"] = policy.policy->answered_share();
  return result;
}

/// Whether the model lost the vehicle: the flight ended, or went further off than the figure is long and no
/// feed-forward is off.
inline bool lost_vehicle(const nlohmann::json& flown) {
  if (!flown.contains("model")) return false;
  const nlohmann::json& model = flown["model"];
  return model["status"] != to_string(pinnquad::Status::ok) ||
         !(model["largest_error_m"] <=
           flown["hover_trim"]["largest_error_m"].get<double>() + 2 * flown["half_length_m"].get<double>());
}

}  // namespace programs
