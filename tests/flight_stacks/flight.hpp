// SPDX-License-Identifier: MIT
// Software in the loop: a module flies a simulated vehicle through a fault script; what happened is some figures.
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "fault_script.hpp"
#include "model_blocks.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "stacks.hpp"

namespace pinnquad::autopilot::test {

using pinnquad::Status;
using pinnquad::TrajectoryPoint;
using pinnquad::Vector3;

struct FlightFigures {
  bool crashed = false;
  double min_altitude_m = 1e9;
  double max_tilt_rad = 0;
  double max_error_m = 0;  ///< position, over the whole flight from 3 s on
  double rmse_m = 0;       ///< the same
  double late_rmse_m = 0;  ///< from 8 s on
  double flown_s = 0;
  double module_share = 0;  ///< of the ticks
  int takeovers = 0;
  float fallback_share = 0;
  unsigned refused_samples = 0;
  long distrusted = 0;                ///< ticks
  std::vector<Reaction> worst;        ///< of each fault
  std::vector<int> fell_back, asked;  ///< ticks of each fault
  std::vector<Status> offered;        ///< what became of the models offered, in order
};

/// One flight. `Stack` is of stacks.hpp; `target(time_s)` gives the set point.
template <class Stack>
class FaultyFlight {
 public:
  using Model = typename Stack::Model;
  using Vehicle =
      pinnquad::Quadrotor<double, pinnquad::StandardAtmosphere, pinnquad::ConstantWind, pinnquad::QuadraticDrag>;

  static constexpr long attitude_period_ms = 4, local_period_ms = 10, set_point_period_ms = 20;

  explicit FaultyFlight(const CoreSettings& settings = {})
      : stack_(settings),
        vehicle_(pinnquad::airframe_value<typename Model::Vehicle, double>(), pinnquad::paper_site<double>()),
        own_({}, pinnquad::flight_limits(vehicle_.airframe(), 1.0)) {}

  CoreSettings settings() const { return stack_.settings(); }

  /// Boot: a corrupt model is refused and the module stays out; then a sound one.
  bool boot() {
    offer(corrupt_);
    const bool stayed_out = !stack_.ready() && !stack_.run(0).has_commands;
    offer(sound_);
    return stayed_out && stack_.ready();
  }

  template <class Target, class Faults>
  FlightFigures fly(const Target& target, double duration_s, const Faults& faults) {
    return fly(target, duration_s, faults, [](const CoreRecord&) {});
  }
  /// `on_tick(record)` sees what the core received and answered in each.
  template <class Target, class Faults, class OnTick>
  FlightFigures fly(const Target& target, double duration_s, const Faults& faults, const OnTick& on_tick) {
    figures_.worst.assign(faults.size(), Reaction::flies);
    figures_.fell_back.assign(faults.size(), 0);
    figures_.asked.assign(faults.size(), 0);
    std::vector<bool> began(faults.size(), false), ended(faults.size(), false);
    start(target(0.0));
    double squares = 0, late_squares = 0;
    long counted = 0, late = 0, ticks = 0, by_module = 0;
    for (long ms = 0; static_cast<double>(ms) < 1000 * duration_s; ms += Stack::period_ms, ++ticks) {
      time_s_ = 1e-3 * static_cast<double>(ms);
      const auto now_us = static_cast<std::uint64_t>(boot_us + ms * 1000);
      active_ = {};
      for (std::size_t i = 0; i < faults.size(); ++i) {
        const Fault& fault = faults[i];
        const bool on = time_s_ >= fault.start_s - 1e-9 && time_s_ < fault.start_s + fault.duration_s - 1e-9;
        if (on) active_.push_back(&fault);
        if (on && !began[i]) began[i] = true, begin(fault);
        if (!on && began[i] && !ended[i]) ended[i] = true, end(fault);
      }
      feed(ms, now_us, target(time_s_));
      stack_.fly_by_hand(faulty(FaultKind::flown_by_hand));
      stack_.situation({!own_flies_ && !faulty(FaultKind::commands_lost) && ms > 0, false});
      const Answer answer = stack_.run(now_us);
      on_tick(stack_.record());
      note(answer, faults);
      choose(answer, ms);
      by_module += own_flies_ ? 0 : 1;
      if (!step_vehicle()) {
        figures_.crashed = true;
        break;
      }
      const double before = squares;
      measure(target(time_s_), squares, counted);
      if (time_s_ > 8) late_squares += squares - before, ++late;
      if (figures_.crashed) break;
    }
    figures_.flown_s = time_s_;
    figures_.rmse_m = counted > 0 ? std::sqrt(squares / static_cast<double>(counted)) : 0;
    figures_.late_rmse_m = late > 0 ? std::sqrt(late_squares / static_cast<double>(late)) : 0;
    figures_.module_share = static_cast<double>(by_module) / static_cast<double>(ticks);
    figures_.fallback_share = last_.fallback_share;
    figures_.refused_samples = last_.refused_samples;
    return figures_;
  }

 private:
  static constexpr long boot_us = 5'000'000;

  void offer(const Block& block) {
    const Status status = stack_.offer(block.data(), block.size());
    figures_.offered.push_back(status);
  }

  void start(const TrajectoryPoint<double>& at) {
    body_.body.position_m = at.position_m;
    body_.body.velocity_m_s = at.velocity_m_s;
    body_.body.attitude = pinnquad::from_euler<double>({0, 0, at.yaw_rad});
    pinnquad::Commands<double> trim{};
    if (pinnquad::hover_trim(vehicle_, at.position_m, trim) != Status::ok) figures_.crashed = true;
    body_.rotors = trim;
    commands_ = trim;
  }

  void begin(const Fault& fault) {
    switch (fault.kind) {
      case FaultKind::model_swapped: offer(other_); break;
      case FaultKind::model_corrupt: offer(corrupt_); break;
      case FaultKind::model_wrong: offer(wrong_); break;
      case FaultKind::model_too_narrow: offer(narrow_); break;
      case FaultKind::model_low: offer(low_); break;
      case FaultKind::payload: weigh(fault.value); break;
      case FaultKind::wind: blow(fault.value); break;
      default: break;
    }
  }

  void end(const Fault& fault) {
    if (fault.kind == FaultKind::payload) weigh(1);
    if (fault.kind == FaultKind::wind) blow(0);
    if (fault.kind == FaultKind::model_swapped || fault.kind == FaultKind::model_too_narrow) offer(sound_);
  }

  void weigh(double share) {
    auto airframe = pinnquad::airframe_value<typename Model::Vehicle, double>();
    airframe.mass_kg *= share;
    vehicle_ = Vehicle(airframe, pinnquad::paper_site<double>());
  }

  void blow(double north_m_s) {
    vehicle_ =
        Vehicle(vehicle_.airframe(), pinnquad::paper_site<double>(), {}, pinnquad::ConstantWind{{north_m_s, 0, 0}}, {});
  }

  bool faulty(FaultKind kind) const {
    return std::any_of(active_.begin(), active_.end(), [kind](const Fault* fault) { return fault->kind == kind; });
  }
  double value_of(FaultKind kind, double otherwise) const {
    for (const Fault* fault : active_) {
      if (fault->kind == kind) return fault->value;
    }
    return otherwise;
  }
  Vector3<double> noise(double deviation) {
    Vector3<double> result;
    for (int i = 0; i < 3; ++i) result[i] = deviation * pinnquad::standard_normal(engine_);
    return result;
  }

  /// The estimator's state of this tick, faults included.
  void feed(long ms, std::uint64_t now_us, const TrajectoryPoint<double>& point) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double denormal = 1e-41;
    const auto due = [ms](long period_ms) { return ms % period_ms == 0; };
    const auto ahead_us = static_cast<std::uint64_t>(1e6 * value_of(FaultKind::stamps_ahead, 0));
    const std::uint64_t stamp_us = now_us + ahead_us;
    Vector3<double> rates = body_.body.body_rates_rad_s + noise(0.02);
    Vector3<double> position = body_.body.position_m + noise(0.005);
    Vector3<double> velocity = body_.body.velocity_m_s + noise(0.02);
    pinnquad::Quaternion<double> q = body_.body.attitude;
    if (faulty(FaultKind::infinite_rates)) rates[1] = std::numeric_limits<double>::infinity();
    if (faulty(FaultKind::denormal_motion)) {
      rates = Vector3<double>(denormal, -denormal, denormal);
      velocity = rates;
    }
    const double scale = value_of(FaultKind::attitude_scaled, 1);
    q = {q.w * scale, q.x * scale, q.y * scale, q.z * scale};
    if (faulty(FaultKind::nan_everywhere)) {
      rates[0] = position[2] = velocity[0] = nan;
      q.y = nan;
    }
    if (!faulty(FaultKind::rates_stop)) stack_.rates(stamp_us, rates);
    if (due(attitude_period_ms) && !faulty(FaultKind::attitude_stops)) stack_.attitude(stamp_us, q);
    if (faulty(FaultKind::velocity_nan)) velocity[1] = nan;
    if (!faulty(FaultKind::velocity_frozen)) estimated_ = {position, velocity};
    const auto late_us = static_cast<std::uint64_t>(1e6 * value_of(FaultKind::local_late, 0));
    if (due(local_period_ms) && !faulty(FaultKind::local_stops)) {
      stack_.local(stamp_us - late_us, estimated_[0], estimated_[1]);
    }
    if (due(set_point_period_ms) && !faulty(FaultKind::set_point_stops)) {
      TrajectoryPoint<double> asked = point;
      asked.position_m[0] += value_of(FaultKind::set_point_jumps, 0);
      stack_.set_point(stamp_us, asked);
    }
  }

  template <class Faults>
  void note(const Answer& answer, const Faults& faults) {
    figures_.distrusted += answer.cause == Status::distrusted ? 1 : 0;
    for (std::size_t i = 0; i < faults.size(); ++i) {
      if (time_s_ < faults[i].start_s - 1e-9 || time_s_ >= faults[i].start_s + faults[i].duration_s) continue;
      figures_.worst[i] = std::max(figures_.worst[i], answer.reaction);
      if (answer.reaction <= Reaction::levels) ++figures_.asked[i];
      if (answer.reaction <= Reaction::levels && answer.status == Status::fell_back) ++figures_.fell_back[i];
    }
    last_ = answer;
  }

  /// The commands that reach the motors: the module's, or the stack's own controller's for a second where it gave up.
  void choose(const Answer& answer, long ms) {
    if (!own_flies_ && !answer.has_commands) {
      own_flies_ = true;
      own_since_ms_ = ms;
      held_.position_m = body_.body.position_m;
      const pinnquad::Heading<double> heading = pinnquad::heading(body_.body.attitude);
      held_.yaw_rad = std::atan2(heading.sine, heading.cosine);
      ++figures_.takeovers;
    }
    if (own_flies_ && answer.has_commands && ms - own_since_ms_ >= 1000) own_flies_ = false;  // selected again
    if (faulty(FaultKind::commands_lost)) return;
    if (!own_flies_) {
      commands_ = answer.commands;
      return;
    }
    pinnquad::Accelerations<double> wanted, feedback;
    if (own_(body_.body, held_, wanted, feedback) != Status::ok) return;
    wanted.linear_m_s2 += feedback.linear_m_s2;
    wanted.angular_rad_s2 += feedback.angular_rad_s2;
    pinnquad::Commands<double> commands{};
    if (pinnquad::inverse_commands(vehicle_, body_.body, wanted, body_.time_s, commands) == Status::ok) {
      commands_ = pinnquad::desaturate(vehicle_.rotors(), commands);
    }
  }

  bool step_vehicle() {
    pinnquad::Commands<double> made = commands_;
    made[0] *= value_of(FaultKind::bent_rotor, 1);
    if (std::fmod(time_s_, 0.4) < 0.2) made[0] *= value_of(FaultKind::rotor_flutters, 1);
    for (double& u : made) u *= value_of(FaultKind::weak_battery, 1);
    for (int i = 0; i < Stack::period_ms; ++i) {
      if (vehicle_.step(body_, made, 1e-3) != Status::ok) return false;
    }
    return true;
  }

  void measure(const TrajectoryPoint<double>& point, double& squares, long& counted) {
    const double altitude_m = vehicle_.site().ground_z_m - body_.body.position_m[2];
    figures_.min_altitude_m = std::min(figures_.min_altitude_m, altitude_m);
    const double upright = pinnquad::body_down_axis(body_.body.attitude)[2];
    figures_.max_tilt_rad = std::max(figures_.max_tilt_rad, std::acos(std::min(1.0, upright)));
    const double error_m = (point.position_m - body_.body.position_m).norm();
    if (time_s_ > 3) {
      figures_.max_error_m = std::max(figures_.max_error_m, error_m);
      squares += error_m * error_m;
      ++counted;
    }
    if (altitude_m <= 0) figures_.crashed = true;
  }

  const Block sound_ = sound_block<Model>(), other_ = other_block<Model>(), narrow_ = narrow_block<Model>(),
              low_ = low_block<Model>(), corrupt_ = corrupt_block<Model>(), wrong_ = wrong_block<Model>();
  Stack stack_;
  Vehicle vehicle_;
  pinnquad::FlightController<double> own_;
  TrajectoryPoint<double> held_;
  bool own_flies_ = false;
  long own_since_ms_ = 0;
  pinnquad::VehicleState<double> body_{};
  pinnquad::Commands<double> commands_{};
  std::array<Vector3<double>, 2> estimated_{Vector3<double>::Zero(), Vector3<double>::Zero()};
  std::mt19937_64 engine_{7};
  double time_s_ = 0;
  std::vector<const Fault*> active_;
  Answer last_{};
  FlightFigures figures_;
};

}  // namespace pinnquad::autopilot::test
