// SPDX-License-Identifier: MIT
#include "loop/vehicles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <thread>

#include <nlohmann/json.hpp>

#include "command_line/build_facts.hpp"
#include "loop/any_policy.hpp"
#include "loop/conditions.hpp"
#include "loop/loop_flights.hpp"
#include "loop/loop_spread.hpp"
#include "loop/unknown_vehicle.hpp"
#include "loop/vehicle_course.hpp"
#include "model/learnt_vehicle.hpp"
#include "pinnquad/control/adaptive_inverse.hpp"
#include "pinnquad/control/onboard/onboard_inverse.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/decimal.hpp"

namespace programs {

namespace {

using namespace pinnquad;

/// The thrust fractions of the analytic inverse of a vehicle in still air; what it knows of drag across the thrust,
/// where it is told.
class StillInverse {
 public:
  StillInverse(const SwitchedQuadrotor& vehicle, bool knows_drag) noexcept
      : vehicle_(vehicle), inverse_(vehicle), knows_drag_(knows_drag) {}

  Status operator()(const State<double>& state, const Accelerations<double>& wanted, std::uint64_t time_us,
                    Commands<double>& fractions) noexcept {
    Commands<double> commands{};
    const Status status = inverse_(state, wanted, time_us, commands);
    if (has_output(status)) fractions = vehicle_.rotors().fractions(commands);
    return status;
  }
  Vector3<double> across_m_s2(const State<double>& state) const noexcept {
    if (!knows_drag_) return Vector3<double>::Zero();
    Vector3<double> force_N = vehicle_.aerodynamic_wrench(state, vehicle_.surroundings(state, 0.0), {}).force_N;
    force_N[2] = 0;
    return body_to_world<double>(state.attitude, force_N) / vehicle_.airframe().mass_kg;
  }
  const SwitchedQuadrotor& vehicle() const noexcept { return vehicle_; }
  const AnalyticInverse<SwitchedQuadrotor>& in_commands() const noexcept { return inverse_; }

 private:
  SwitchedQuadrotor vehicle_;
  AnalyticInverse<SwitchedQuadrotor> inverse_;
  bool knows_drag_;
};

/// That with a bias learnt in flight, of thrust fractions: rotors lag in thrust, and noise of a command would shift the
/// mean thrust of a curve.
class KnownInverse {
 public:
  KnownInverse(const StillInverse& inverse, const BiasSettings<double>& bias,
               const FlownMotion<double>& motion) noexcept
      : adaptive_(inverse, inverse.vehicle().airframe(), bias, motion) {}

  Status operator()(const State<double>& state, const Accelerations<double>& wanted, std::uint64_t time_us,
                    Commands<double>& commands) noexcept {
    Commands<double> fractions{};
    const Status status = adaptive_(state, wanted, time_us, fractions);
    if (has_output(status)) commands = rotors().commands_of(fractions);
    return status;
  }
  void learn(std::uint64_t now_us, bool known, const State<double>& state, const Commands<double>& commands) noexcept {
    adaptive_.learn(now_us, known, state, rotors().fractions(commands));
  }
  Vector3<double> across_m_s2(const State<double>& state) const noexcept { return adaptive_.across_m_s2(state); }
  const StillInverse& inverse() const noexcept { return adaptive_.inverse(); }

 private:
  const Rotors<double>& rotors() const noexcept { return adaptive_.inverse().vehicle().rotors(); }

  AdaptiveInverse<double, StillInverse> adaptive_;
};

constexpr double tick_s = 0.002, told_delay_s = 0.004;
constexpr double lost_m = 15, lost_rad = 2.0943951023931953;  ///< 120 degrees of tilt

/// Gains that a lag of the rotors leaves room for.
FlightGains<double> gains_for(double lag_s) {
  FlightGains<double> gains;
  gains.roll_pitch_rate_1_s = std::min(22.0, 0.8 / (lag_s + 0.008));
  gains.tilt_1_s = std::min(9.0, gains.roll_pitch_rate_1_s / 2.4);
  gains.yaw_rate_1_s = std::min(8.0, gains.roll_pitch_rate_1_s / 2);
  gains.yaw_1_s = gains.yaw_rate_1_s / 2.6;
  gains.velocity_1_s = std::min(3.0, gains.tilt_1_s / 3);
  gains.position_1_s = gains.velocity_1_s / 1.67;
  return gains;
}

/// A bias slow enough for commands and states whose delay is not told.
BiasSettings<double> bias_for(double lag_s) {
  BiasSettings<double> bias;
  for (double& time_s : bias.time_constants_s) time_s *= std::max(1.0, 2 * (lag_s + 0.09) / 0.25);
  bias.most = {2.4, 1, 1, 1};
  return bias;
}

FlightController<double> outer_loop(const Airframe<double>& airframe, const FlightGains<double>& gains) {
  return FlightController<double>(gains, flight_limits(airframe, 1.0, gains));
}

/// Sines on the motion wanted, of so many times the strength of those that teach.
struct Shaking {
  std::array<double, 4> slopes{};  ///< of the signed sums
  double strength = 0, until_s = 0;

  void add_to(Accelerations<double>& wanted, std::uint64_t time_us) const noexcept {
    if (!(strength > 0 && seconds_of(time_us) < until_s)) return;
    const Accelerations<double> added =
        excitation(OnboardSettings<double>::Excitation{}, time_us, slopes, {strength, strength, strength, strength});
    wanted.linear_m_s2 += added.linear_m_s2;
    wanted.angular_rad_s2 += added.angular_rad_s2;
  }
};

/// A flight's policy, as the controller holds it.
template <class Policy>
struct Flying {
  Policy* policy;
  const Shaking* shaking;

  Status operator()(const State<double>& state, const Accelerations<double>& wanted, std::uint64_t time_us,
                    Commands<double>& commands) noexcept {
    Accelerations<double> shaken = wanted;
    shaking->add_to(shaken, time_us);
    return (*policy)(state, shaken, time_us, commands);
  }
  void learn(std::uint64_t now_us, bool known, const State<double>& state, const Commands<double>& commands) noexcept {
    policy->learn(now_us, known, state, commands);
  }
  Vector3<double> across_m_s2(const State<double>& state) const noexcept { return policy->across_m_s2(state); }
};

State<double> hovering() {
  State<double> state;
  state.position_m = Vector3<double>(0, 0, -20);
  return state;
}

/// Slopes of the signed sums of thrust fractions by the acceleration that each makes, in hover. The fractions are those
/// of the start's curve, which a learner has too.
template <class Policy>
SignedSums<double> hover_slopes(Policy policy, const Airframe<double>& start) {
  const Rotors<double> rotors(start);
  const auto mix = pinnquad::detail::signed_mix(start);
  const auto sums = [&](const Accelerations<double>& wanted) {
    Commands<double> commands{};
    static_cast<void>(policy(hovering(), wanted, 0, commands));
    return pinnquad::detail::LagBank<double>::sums_of(rotors.fractions(commands), mix);
  };
  constexpr std::array<double, 4> by = {-0.3, 0.3, 0.3, 0.03};
  const SignedSums<double> before = sums({});
  SignedSums<double> slopes{};
  for (std::size_t k = 0; k < 4; ++k) {
    Accelerations<double> wanted;
    (k == 0 ? wanted.linear_m_s2[2] : wanted.angular_rad_s2[static_cast<int>(k) - 1]) = by[k];
    slopes[k] = (sums(wanted)[k] - before[k]) / by[k];
  }
  return slopes;
}

struct VehicleFlight {
  std::string controller, condition;
  std::size_t vehicle = 0;
};

/// One vehicle, one controller, one condition.
class Flown {
 public:
  Flown(const VehiclesOptions& options, const VehicleFlight& flight)
      : options_(options),
        flight_(flight),
        truth_(drawn_vehicle(options.seed, flight.vehicle)),
        start_(options.start == "laws" ? start_by_laws(truth_.airframe) : archetype_start(flight.vehicle)),
        still_(quadrotor_with(truth_.effects, truth_.airframe, Site<double>{})),
        gains_(gains_for(start_.rotor_time_constant_s)) {}

  nlohmann::json row() { return flight_.controller == "onboard" ? onboard() : known(); }
  /// Slopes over time of the vehicle to draw, as it is learnt on board; none of another one.
  const std::optional<Chart>& picture() const noexcept { return picture_; }

 private:
  /// The analytic inverse of what is told.
  nlohmann::json known() {
    const bool knows = flight_.controller == "true_inverse";
    const Airframe<double>& told = knows ? truth_.airframe : start_;
    const SwitchedQuadrotor guessed = quadrotor_with(
        switched_effects<Quadrotor<double, StandardAtmosphere, QuadraticDrag>>(), start_, Site<double>{});
    const double lag_s = told.rotor_time_constant_s;
    KnownInverse policy(StillInverse(knows ? still_ : guessed, knows), bias_for(lag_s),
                        FlownMotion<double>(20'000, lag_s, knows ? truth_.delay_s : told_delay_s));
    return fly(
        policy, policy.inverse().in_commands(), [](double) {}, [&] { return told; });
  }

  nlohmann::json onboard() {
    OnboardInverse<double> policy(start_);
    std::array<double, 4> swapped_s = {-1, -1, -1, -1};
    std::array<std::uint32_t, 4> row{};
    std::array<std::size_t, 4> swaps{};
    std::size_t unproven = 0;
    std::optional<LearntVehicle<double>> drawn;
    if (flight_.vehicle == options_.drawn) drawn.emplace(start_);
    const auto at_start = policy.certificate();
    const auto watch = [&](double time_s) {
      policy.excite(time_s < VehicleCourse::hover_s && time_s < options_.frozen_s);
      policy.freeze(time_s >= options_.frozen_s);
      if (drawn) drawn->note(time_s, policy);
      for (std::size_t k = 0; k < 4; ++k) {
        const auto& sum = policy.certificate()[k];
        if (!sum.proven && sum.forward.theta != at_start[k].forward.theta) ++unproven;
        if (sum.proven_row == row[k]) continue;
        row[k] = sum.proven_row;
        ++swaps[k];
        if (swapped_s[k] < 0) swapped_s[k] = time_s;
      }
    };
    nlohmann::json result = fly(policy, policy, watch, [&] { return policy.airframe(); });
    const SignedSums<double> truth = true_slopes();
    SignedSums<double> slopes{};
    for (std::size_t k = 0; k < 4; ++k) slopes[k] = 1 / truth[k];
    if (drawn) picture_ = drawn->picture(slopes);
    nlohmann::json& learnt = result["learnt"] = {{"rows", policy.rows()},
                                                 {"unproven_ticks", unproven},
                                                 {"drag", {policy.drag().linear_1_s, policy.drag().quadratic_1_m}}};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& sum = policy.certificate()[k];
      const double slope = sum.forward.slope();
      nlohmann::json& said = learnt[sum_names[k]] = {{"proven", sum.proven},
                                                     {"first_swap_s", nullptr},
                                                     {"swaps", swaps[k]},
                                                     {"lag_s", sum.forward.lag.seconds()},
                                                     {"half_width", nullptr},
                                                     {"holds", nullptr},
                                                     {"terms_bound", sum.terms_bound},
                                                     {"gain", sum.gain},
                                                     {"refused_last", to_string(sum.refused_last)}};
      if (swapped_s[k] >= 0) said["first_swap_s"] = swapped_s[k];
      if (!sum.proven) continue;
      said["half_width"] = sum.half_width / std::abs(slope);
      said["holds"] = std::abs(slope - 1 / truth[k]) <= sum.half_width;
    }
    return result;
  }

  SignedSums<double> true_slopes() const { return hover_slopes(AnalyticInverse<SwitchedQuadrotor>(still_), start_); }

  /// `inverse`: whose slopes are those of the policy. `at(t)`: before each tick; `airframe()`: the one that flies.
  template <class Policy, class Inverse, class At, class AirframeNow>
  nlohmann::json fly(Policy& policy, const Inverse& inverse, const At& at, const AirframeNow& airframe) {
    Commands<double> hover{};
    static_cast<void>(policy(hovering(), {}, 0, hover));
    for (double& command : hover) command = std::clamp(command, 0.0, 1.0);
    Shaking shaking;
    if (flight_.condition == "saturated") {
      const auto start = forward_model(start_);
      for (std::size_t k = 0; k < 4; ++k) shaking.slopes[k] = start[k].slope();
      shaking.strength = flight_.controller == "onboard" ? 4 : 5;  // beside its own
      shaking.until_s = VehicleCourse::hover_s;
    }
    const AnyPolicy any(Flying<Policy>{&policy, &shaking});
    fly_course(any, hover, at, airframe);
    const SignedSums<double> truth = true_slopes(), flown = hover_slopes(inverse, start_);
    nlohmann::json row = {{"controller", flight_.controller},
                          {"condition", flight_.condition},
                          {"vehicle", flight_.vehicle},
                          {"archetype", truth_.archetype},
                          {"frozen_s", options_.frozen_s},
                          {"rmse_cm", 100 * std::sqrt(squares_ / std::max(1.0, ticks_))},
                          {"worst_cm", 100 * worst_m_},
                          {"learning_rmse_cm", 100 * std::sqrt(learning_squares_ / std::max(1.0, learning_ticks_))},
                          {"crashed", lost_at_s_ >= 0},
                          {"lost_at_s", nullptr},
                          {"saturated_share", saturated_share_},
                          {"slopes", nlohmann::json::object()}};
    if (lost_at_s_ >= 0) row["lost_at_s"] = lost_at_s_;
    for (std::size_t k = 0; k < 4; ++k) row["slopes"][sum_names[k]] = flown[k] / truth[k];
    return row;
  }

  SwitchedQuadrotor world(std::uint64_t seed) const {
    SwitchedEffects effects = truth_.effects;
    if (flight_.condition == "payload_late") switch_effect(effects, Payload{0.3 * truth_.airframe.mass_kg, 30});
    if (flight_.condition == "gusts") {
      std::mt19937_64 engine(0x67757374u + 7919 * seed);
      DrawnWind wind(engine);
      wind.mean_m_s = 4;
      switch_effect(effects, wind.mean());
      switch_effect(effects, wind.gusts(engine, 2.5 * wind.mean_m_s));
    }
    return quadrotor_with(effects, truth_.airframe, Site<double>{});
  }

  void fly_course(AnyPolicy any, const Commands<double>& hover, const std::function<void(double)>& at,
                  const std::function<Airframe<double>()>& airframe) {
    const std::uint64_t seed = options_.seed * 1'000'003 + flight_.vehicle;
    const SwitchedQuadrotor vehicle = world(seed);
    const SwitchedQuadrotor::TimeStep step = vehicle.time_step(tick_s);
    const VehicleCourse course(truth_.airframe.thrust_to_weight(), options_.frozen_s);
    VehicleSensors sensors(tick_s, truth_.delay_s, flight_.condition == "noise_3" ? 3 : 1, seed);
    const auto clock_us = [](std::size_t tick) { return static_cast<std::uint64_t>(tick) * 2'000; };
    std::size_t before = 0;
    if (flight_.condition == "ground_minute") before = stand(any, sensors, clock_us);
    TrackingController<double, AnyPolicy> controller(airframe(), outer_loop(airframe(), gains_), any);
    VehicleState<double> state;
    state.body = hovering();
    state.rotors = hover;
    Commands<double> commands = hover;
    const auto ticks = static_cast<std::size_t>(std::lround(course.end_s() / tick_s));
    const double scored_from_s = course.eight_from_s() + VehicleCourse::settled_s;
    std::size_t saturated_ticks = 0, flown = 0;
    for (; flown < ticks; ++flown) {
      const double time_s = static_cast<double>(flown) * tick_s;
      state.time_s = time_s;
      const TrajectoryPoint<double> point = course.sample(time_s);
      const double error_m = (point.position_m - state.body.position_m).norm();
      const double tilt = world_down_axis(state.body.attitude)[2];
      if (!(error_m <= lost_m) || !(tilt >= std::cos(lost_rad))) break;
      score(time_s, error_m, scored_from_s);
      at(time_s);
      if (flown % 10 == 0) controller.change_to(airframe(), outer_loop(airframe(), gains_));
      State<double> seen = sensors(state.body);
      if (flight_.condition == "nan" && time_s >= 15 && time_s < 15.3) {
        seen.velocity_m_s.setConstant(std::numeric_limits<double>::quiet_NaN());
        seen.body_rates_rad_s = seen.velocity_m_s;
      }
      static_cast<void>(controller(seen, point, clock_us(before + flown), commands));  // or they stay as they are
      if (saturated(commands)) ++saturated_ticks;
      if (vehicle.step(state, commands, step) != Status::ok) break;
    }
    saturated_share_ = static_cast<double>(saturated_ticks) / static_cast<double>(std::max<std::size_t>(1, flown));
    if (flown == ticks) return;
    lost_at_s_ = static_cast<double>(flown) * tick_s;
    for (; flown < ticks; ++flown) score(static_cast<double>(flown) * tick_s, lost_m, scored_from_s);
  }

  /// A minute on the ground that the policy takes for flight: commands that rise to nine tenths of what lifts the
  /// vehicle, which turn a little and move nothing. The ticks of it.
  template <class Clock>
  std::size_t stand(AnyPolicy& any, VehicleSensors& sensors, const Clock& clock_us) const {
    constexpr std::size_t ticks = 30'000;
    Commands<double> trim{};
    static_cast<void>(hover_trim(still_, hovering().position_m, trim));
    const ThrustFractions<double> lifting = still_.rotors().fractions(trim);
    const auto mix = pinnquad::detail::signed_mix(start_);
    for (std::size_t tick = 0; tick < ticks; ++tick) {
      const double share = static_cast<double>(tick) / static_cast<double>(ticks);
      const double time_s = static_cast<double>(tick) * tick_s;
      ThrustFractions<double> fractions = lifting;
      for (std::size_t i = 0; i < rotor_count; ++i) {
        fractions[i] *= 0.9 * share;
        for (std::size_t k = 1; k < 4; ++k) {
          fractions[i] += 0.01 * mix.by[i][k] * std::sin(6.5 * static_cast<double>(k) * time_s);
        }
        fractions[i] = std::clamp(fractions[i], 0.0, 1.0);
      }
      any.learn(clock_us(tick), true, sensors(hovering()), still_.rotors().commands_of(fractions));
    }
    return ticks;
  }

  void score(double time_s, double error_m, double scored_from_s) {
    if (time_s < options_.frozen_s) {
      learning_squares_ += error_m * error_m;
      ++learning_ticks_;
    }
    if (time_s < scored_from_s) return;
    squares_ += error_m * error_m;
    ++ticks_;
    worst_m_ = std::max(worst_m_, error_m);
  }

  const VehiclesOptions& options_;
  VehicleFlight flight_;
  UnknownVehicle truth_;
  Airframe<double> start_;
  SwitchedQuadrotor still_;
  FlightGains<double> gains_;
  double squares_ = 0, ticks_ = 0, learning_squares_ = 0, learning_ticks_ = 0, worst_m_ = 0;
  double lost_at_s_ = -1, saturated_share_ = 0;
  std::optional<Chart> picture_;
};

void print_vehicles(const VehiclesOptions& options, const std::vector<nlohmann::json>& rows) {
  std::printf(
      "%zu vehicle%s of seed %llu, each %s; learnt for %g s\n"
      "figure-eight: RMSE of the position in cm of those that are not lost\n"
      "slopes flown: error in %%, median\n"
      "  %-14s %-14s %8s %8s %6s %9s %7s %7s %7s\n",
      options.vehicles, options.vehicles == 1 ? "" : "s", static_cast<unsigned long long>(options.seed),
      options.start == "laws" ? "by laws of its mass and propeller" : "within 40 % of its archetype", options.frozen_s,
      "condition", "controller", "median", "p90", "lost", "thrust", "roll", "pitch", "yaw");
  for (std::size_t first = 0; first < rows.size(); first += options.vehicles) {
    std::vector<double> errors;
    std::array<std::vector<double>, 4> slopes;
    for (std::size_t i = first; i < first + options.vehicles; ++i) {
      if (!rows[i]["crashed"].get<bool>()) errors.push_back(rows[i]["rmse_cm"].get<double>());
      for (std::size_t k = 0; k < 4; ++k) {
        slopes[k].push_back(100 * std::abs(rows[i]["slopes"][sum_names[k]].get<double>() - 1));
      }
    }
    std::printf("  %-14s %-14s %8.2f %8.2f %6zu", rows[first]["condition"].get<std::string>().c_str(),
                rows[first]["controller"].get<std::string>().c_str(), quantile(errors, 0.5), quantile(errors, 0.9),
                options.vehicles - errors.size());
    for (std::size_t k = 0; k < 4; ++k) std::printf(" %*.1f", k == 0 ? 9 : 7, quantile(slopes[k], 0.5));
    std::printf("\n");
  }
}

}  // namespace

int fly_vehicles(const VehiclesOptions& options) {
  std::vector<LoopFlight> flights;
  for (const std::string& condition : options.conditions) {
    for (const std::string& controller : options.controllers) {
      for (std::size_t i = 0; i < options.vehicles; ++i)
        flights.push_back({controller, condition, "", "", static_cast<int>(i)});
    }
  }
  const nlohmann::json plan = {{"format", 1},
                               {"program", hexadecimal(program_hash())},
                               {"seed", options.seed},
                               {"start", options.start},
                               {"frozen", options.frozen_s},
                               {"draw", options.drawn}};
  LoopJournal journal(options.out, plan);
  const std::vector<nlohmann::json> rows =
      rows_of(flights, &journal, std::max(1U, std::thread::hardware_concurrency()), [&](const LoopFlight& flight) {
        Flown flown(options, {flight.controller, flight.condition, static_cast<std::size_t>(flight.seed)});
        nlohmann::json row = flown.row();
        if (flown.picture()) {
          const std::string of = flight.condition + "_" + std::to_string(flight.seed);
          write_svg(options.out + "/slopes_" + of + ".svg", *flown.picture());
        }
        return row;
      });
  const nlohmann::json report = {{"vehicles", options.vehicles},
                                 {"seed", options.seed},
                                 {"start", options.start},
                                 {"frozen_s", options.frozen_s},
                                 {"rows", rows}};
  AtomicFile file(options.out + "/loop.json");
  file.stream() << report.dump(2) << '\n';
  file.commit();
  if (options.json) {
    std::printf("%s\n", report.dump(2).c_str());
  } else {
    print_vehicles(options, rows);
  }
  return 0;
}

}  // namespace programs
