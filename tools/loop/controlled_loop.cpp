// SPDX-License-Identifier: MIT
#include "loop/controlled_loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "flight/battery_choice.hpp"
#include "flight/block_loop.hpp"
#include "flight/loop_figures.hpp"
#include "flight/waypoints.hpp"
#include "loop/world.hpp"
#include "pinnquad/simulation/flights.hpp"

namespace programs {

namespace {

using namespace pinnquad;

/// Position errors over one flight.
struct Errors {
  std::vector<double> squares;  ///< of each control tick
  double period_s = 0;
  bool low = false;  ///< came to the ground

  bool reaches(double time_s) const { return at(time_s) < squares.size(); }
  /// Root mean square error between the times, m; the flight reaches `from_s`.
  double rmse_m(double from_s, double to_s) const {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = at(from_s); i < std::min(at(to_s), squares.size()); ++i, ++count) sum += squares[i];
    return std::sqrt(sum / static_cast<double>(count));
  }
  /// 0 where the flight ends before.
  double worst_m(double from_s) const {
    double most = 0;
    for (std::size_t i = at(from_s); i < squares.size(); ++i) most = std::max(most, squares[i]);
    return std::sqrt(most);
  }
  /// The largest error over a second.
  double worst_second_m(double from_s, double to_s) const {
    double most = 0;
    seconds(from_s, to_s, [&most](std::size_t, double rms_m) { most = std::max(most, rms_m); });
    return most;
  }
  /// Time from `onset_s` until the error over a second is, and stays, within 1.5 times `usual_m`.
  std::optional<double> recovery_s(double onset_s, double usual_m) const {
    const std::size_t onset = at(onset_s);
    std::size_t last = onset;
    seconds(onset_s, static_cast<double>(squares.size()) * period_s, [&](std::size_t end, double rms_m) {
      if (rms_m > 1.5 * usual_m) last = end;
    });
    if (last + 1 >= squares.size()) return {};
    return static_cast<double>(last - onset) * period_s;
  }

 private:
  /// Calls `visit(end, error)` for each second, tick by tick.
  template <class Visit>
  void seconds(double from_s, double to_s, const Visit& visit) const {
    const std::size_t window = at(1), first = at(from_s);
    std::vector<double> left(window + 1, 0.0);  // of the window before: sums to its end. Nothing is taken off a sum
    double sum = 0;
    for (std::size_t i = first; i < std::min(at(to_s), squares.size()); ++i) {
      const std::size_t place = (i - first) % window;
      sum = (place == 0 ? 0.0 : sum) + squares[i];
      if (i + 1 >= first + window) visit(i, std::sqrt((sum + left[place + 1]) / static_cast<double>(window)));
      if (place + 1 < window) continue;
      for (std::size_t k = window; k-- > 0;)
        left[k] = (k + 1 == window ? 0.0 : left[k + 1]) + squares[i + k + 1 - window];
    }
  }
  std::size_t at(double time_s) const { return static_cast<std::size_t>(std::lround(time_s / period_s)); }
};

const LoopCondition& condition_of(const std::string& name) {
  for (const LoopCondition& each : loop_conditions) {
    if (each.name == name) return each;
  }
  throw std::out_of_range(name);
}

/// The vehicle of "harder", of which controllers know nothing.
using HarderInLoop = Quadrotor<double, StandardAtmosphere, Battery, QuadraticDrag, RotorDrag, Inflow, BladeFlapping,
                               Wake, RotorGroundEffect<CheesemanBennett>, GroundContact>;

GroundEffectModel ground_effect_of(const LoopSetting& setting) {
  return setting.model.features().asks_for_altitude() ? GroundEffectModel::conyers : GroundEffectModel::none;
}

template <class Held>
std::optional<AnyTrajectory> any(const std::optional<Held>& held) {
  if (!held) return {};
  return AnyTrajectory{[path = *held](double time_s) { return path.sample(time_s); }};
}

/// A path whose points at the ticks of flights are worked out once for all of them.
AnyTrajectory sampled(const AnyTrajectory& path, double period_s, double duration_s) {
  constexpr double most = 100'000;  // 14 MB
  struct Shared {
    std::once_flag once;
    std::vector<TrajectoryPoint<double>> points;
  };
  const double ticks = std::min(most, std::ceil(duration_s / period_s));
  return {[path, period_s, ticks, shared = std::make_shared<Shared>()](double time_s) {
    const double tick = std::floor(time_s / period_s + 0.5);
    if (!(tick >= 0 && tick < ticks && tick * period_s == time_s)) return path.sample(time_s);
    std::call_once(shared->once, [&] {
      for (double i = 0; i < ticks; ++i) shared->points.push_back(path.sample(i * period_s));
    });
    return shared->points[static_cast<std::size_t>(tick)];
  }};
}

AnyTrajectory required(const std::optional<AnyTrajectory>& held) {
  if (!held) throw std::invalid_argument("the model's envelope holds no trajectory of this kind, however slow");
  return *held;
}

}  // namespace

ControlledLoop::ControlledLoop(const LoopSetting& setting)
    : setting_(setting),
      told_(flight_vehicle<AgileFlight>(setting.airframe, ground_effect_of(setting))),
      flown_(setting.harder ? switched_effects<HarderInLoop>() : switched_effects<AgileFlight::Vehicle>()),
      range_(range_of(setting.model)) {
  if (!setting.harder) set_ground_effect(flown_, ground_effect_of(setting));
  if (setting.battery) switch_effect(flown_, *setting.battery);
  const double ground_z_m = told_.site().ground_z_m;
  const auto eight = eight_for(setting.airframe, ground_z_m, range_);
  at_once_["eight"] = required(any(eight));
  at_once_["yaw_eight"] = any(std::optional(with_yaw(*eight)));
  at_once_["circle"] = any(circle_for(setting.airframe, ground_z_m, range_));
  at_once_["step"] = AnyTrajectory{[start = eight->center_m](double time_s) {
    TrajectoryPoint<double> point;
    point.position_m = start;
    if (time_s > 0) point.position_m[0] += 50;
    return point;
  }};
  if (!setting.waypoints.empty()) {
    const WaypointPath path =
        waypoints_for(setting.waypoints, detail::center_for(ground_z_m, range_), ground_z_m, setting.airframe);
    setting_.duration_s = std::max(setting_.duration_s, path.duration_s());
    at_once_[setting.waypoints] = any(std::optional(path));
  }
  for (auto& [name, path] : at_once_) {
    if (path) path = sampled(*path, TrackingPlan<double>{}.control_period_s(), setting_.duration_s);
  }
  Status status = told_.status();
  Commands<double> trim{};
  if (status == Status::ok) status = hover_trim(told_, eight->center_m, trim);
  if (status != Status::ok) {
    throw std::invalid_argument(std::string("this airframe can't be flown here: ") + to_string(status));
  }
}

AnyTrajectory ControlledLoop::trajectory(const std::string& name, std::uint64_t seed) const {
  if (name == "random") {
    return required(any(random_path_for(setting_.airframe, told_.site().ground_z_m, range_, seed)));
  }
  return required(at_once_.at(name));
}

nlohmann::json ControlledLoop::fly(const LoopFlight& flight, const LoopGains& gains, const PolicyMaker& make,
                                   bool feeds_back) const {
  const auto seed = static_cast<std::uint64_t>(flight.seed);
  const AnyTrajectory path = trajectory(flight.trajectory, seed);
  const LoopCondition& condition = condition_of(flight.condition);
  TrackingPlan<double> how;
  how.duration_s = setting_.duration_s;
  const double half_s = 0.5 * how.duration_s;
  const double period_s = how.control_period_s();
  const Site<double> site = told_.site();
  std::vector<double> columns = setting_.columns;
  LoopWorld world(setting_.airframe, flown_, site, condition, setting_.sensors, how, seed,
                  setting_.battery ? voltage_among(setting_.model, columns) : nullptr);
  const FlightGains<double> feedback = flight_gains(gains);
  FlightLimits<double> limits =
      flight_limits(setting_.airframe, told_.rotor_scale(told_.surroundings({}, 0)), feedback);
  limits.max_horizontal_speed_m_s = 12;
  limits.max_climb_m_s = 5;
  limits.max_descent_m_s = 3;
  auto bias =
      setting_.model.with([](const auto& model) { return quick_where_told(bias_settings<double>(model.records())); });
  bias.most_across_m_s2 = 6;
  const double speed_m_s =
      std::min({limits.max_horizontal_speed_m_s, range_.speed_m_s(0).value_or(limits.max_horizontal_speed_m_s),
                range_.speed_m_s(1).value_or(limits.max_horizontal_speed_m_s)});
  const LoopKnowledge known{setting_.model, columns, told_, bias, setting_.sensors.delay_s, &path, speed_m_s};
  const AnyPolicy policy = make(flight.controller, known, gains);
  Errors errors;
  errors.period_s = period_s;
  errors.squares.reserve(static_cast<std::size_t>(how.duration_s / period_s) + 1);
  double effort = 0, at_bound = 0;
  Commands<double> before{};
  const auto observer = [&](double, const TrajectoryPoint<double>& point, const VehicleState<double>& vehicle,
                            const Commands<double>& commands) noexcept {
    errors.squares.push_back((point.position_m - vehicle.body.position_m).squaredNorm());
    at_bound += policy.at_bound() ? 1 : 0;
    errors.low = errors.low || vehicle.body.position_m[2] >= site.ground_z_m;
    for (std::size_t i = 0; i < commands.size(); ++i) {
      if (errors.squares.size() > 1) effort += std::abs(commands[i] - before[i]);
    }
    before = commands;
  };
  const FlightController<double> outer(feeds_back ? FlightGains<double>{0, 0, 0, 0, 0, 0} : feedback, limits);
  const TrackingResult<double> flown = track(told_, world, path, outer, policy, how, observer);
  const double onset_s = condition.at_half ? half_s : 0;
  const double usual_m =
      condition.at_half ? errors.worst_second_m(settled_s, half_s) : errors.worst_second_m(half_s, how.duration_s);
  const bool crashed = flown.status != Status::ok || errors.low || !(errors.worst_m(settled_s) < lost_m);
  const double ticks = static_cast<double>(std::max<std::size_t>(1, errors.squares.size()));
  nlohmann::json row = {{"controller", flight.controller},
                        {"condition", flight.condition},
                        {"trajectory", flight.trajectory},
                        {"gains", flight.gains},
                        {"seed", flight.seed},
                        {"rmse_cm", nullptr},
                        {"worst_cm", nullptr},
                        {"recovery_s", nullptr},
                        {"crashed", crashed},
                        {"saturated_share", flown.saturated_share},
                        {"effort_1_s", effort / (ticks * period_s)},
                        {"step_ns", 1e9 * policy.busy_s() / ticks},
                        {"bias_at_bound_share", at_bound / ticks},
                        {"answered_share", nullptr},
                        {"wind_north_m_s", world.drawn().wind_north_m_s},
                        {"wind_east_m_s", world.drawn().wind_east_m_s},
                        {"mass_factor", world.drawn().mass},
                        {"inertia_factor", world.drawn().inertia},
                        {"thrust_factor", world.drawn().thrust},
                        {"rotor_factor", world.drawn().rotor}};
  if (errors.reaches(settled_s)) {
    row["rmse_cm"] = 100 * errors.rmse_m(settled_s, how.duration_s);
    row["worst_cm"] = 100 * errors.worst_m(settled_s);
  }
  const auto recovered = errors.recovery_s(onset_s, usual_m);
  if (recovered && !crashed) row["recovery_s"] = *recovered;
  if (flown.fallback.asked > 0) row["answered_share"] = answered_share(flown.fallback);
  if (condition.at_half && flight.seed == 1 && flight.trajectory == "eight") {
    row["series"] = {{"period_s", 25 * period_s}, {"error_cm", nlohmann::json::array()}};
    for (std::size_t i = 0; i < errors.squares.size(); i += 25) {
      row["series"]["error_cm"].push_back(std::round(1e4 * std::sqrt(errors.squares[i])) / 100);
    }
  }
  return row;
}

std::vector<std::string> bias_warnings(const nlohmann::json& rows) {
  constexpr double least_share = 0.01;  // of a flight: a gust is over sooner
  std::vector<std::pair<std::array<std::string, 2>, double>> most;
  for (const nlohmann::json& row : rows) {
    const double share = row.value("bias_at_bound_share", 0.0);  // a journal of before has none
    if (share < least_share) continue;
    const std::array<std::string, 2> flown = {row["controller"], row["condition"]};
    const auto same = std::find_if(most.begin(), most.end(), [&](const auto& each) { return each.first == flown; });
    if (same == most.end()) {
      most.emplace_back(flown, share);
    } else {
      same->second = std::max(same->second, share);
    }
  }
  std::vector<std::string> lines;
  for (const auto& [flown, share] : most) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "%s, %s: its bias stood at its bound for up to %.0f %% of a flight, and what is beyond it stays as "
                  "an error: tell it the mass and the rotors that fly (--airframe)",
                  flown[0].c_str(), flown[1].c_str(), std::max(1.0, 100 * share));
    lines.emplace_back(text);
  }
  return lines;
}

}  // namespace programs
