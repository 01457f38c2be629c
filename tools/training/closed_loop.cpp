// SPDX-License-Identifier: MIT
// The flight of closed_loop.hpp.
#include "training/closed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "flight/battery_choice.hpp"
#include "flight/block_feed_forward.hpp"
#include "flight/loop_trajectories.hpp"
#include "pinnquad/simulation/simulator.hpp"
#include "pinnquad/simulation/tracking.hpp"
#include "training/command_comparison.hpp"
#include "training/given_vehicle.hpp"

namespace {

using namespace pinnquad;

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
  bool holds(const MotionInputs<double>& motion) const {
    return (!has_velocity || within(motion.velocity_m_s, fastest_m_s)) &&
           pinnquad::tilt_rad(motion.attitude) <= tilt_rad && within(motion.body_rates_rad_s, turning_rad_s) &&
           within(motion.angular_acceleration_rad_s2, angular_acceleration_rad_s2);
  }

 private:
  static bool within(const Vector3<double>& vector, const std::array<double, 3>& limits) {
    return (vector.array().abs() <= Eigen::Array3d::Map(limits.data())).all();
  }
};

FlownEnvelope flown_envelope(const RowSet& rows, bool has_velocity) {
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

}  // namespace

nlohmann::json programs::fly_logged(const BlockModel& model, const RowSet& training,
                                    const IdentifiedVehicle& identified, bool has_velocity, FlownTraces& traces) {
  if (!identified.airframe) return {{"why_not", "the flights do not identify their vehicle"}};
  constexpr double shortest_s = 2;
  const auto eight = eight_for(identified.airframe->value, 0, flown_envelope(training, has_velocity), shortest_s);
  if (!eight) return {{"why_not", "the flights hold no figure-eight, however slow"}};
  const IdentifiedQuadrotor vehicle = identified_quadrotor(identified);
  Commands<double> trim{};
  if (hover_trim(vehicle, eight->center_m, trim) != Status::ok) {
    return {{"why_not", "the vehicle that was identified does not hover"}};
  }
  TrackingPlan<double> plan;
  plan.duration_s = std::max(20.0, eight->ramp_s + 2 * eight->period_s);
  plan.steps_per_control = 4;
  const FlightController<double> controller({}, flight_limits(vehicle.airframe(), 1.0));
  using Analytic = AnalyticInverse<IdentifiedQuadrotor>;
  const Analytic analytic(vehicle);
  const auto fly = [&](BatteryWorld<IdentifiedQuadrotor> world, const AnyTrajectory& path,
                       const AnyFeedForward& feed_forward, FlownTrace& trace) {
    return track(vehicle, world, path, controller, feed_forward, plan, trace.observer(plan.duration_s));
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
  using Guard = Extend<TrainingGuard, Fallback<Analytic>>;
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
