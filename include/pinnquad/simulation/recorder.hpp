// SPDX-License-Identifier: MIT
// A recorder is a policy: what a flight log says of the motion of one instant and of the commands behind it.
// Contract, called in time order:
//   void hold(const Commands<double>& commands, double time_s);
//     at each control tick: from this instant on these commands, not clipped, go out to the motors;
//   template <class... Effects> Sample operator()(const Quadrotor<double, Effects...>&, const VehicleState<double>&,
//                                                 const Commands<double>& commands);
//     the row of the present instant; `commands` are those held up to it.
// A vehicle's battery_voltage [V] is recorded beside it, of a vehicle that has a battery.
// Optional: `Status status() const noexcept`, asked before the flight: whether its settings make sense;
//   std::vector<ColumnName> columns() const, and for each row, behind it, a value per column:
//   template <class... Effects>
//   void measure(const Quadrotor<double, Effects...>&, const VehicleState<double>&, double* values).
#pragma once

#include <cstddef>
#include <deque>
#include <type_traits>
#include <utility>
#include <vector>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad {

namespace detail {
template <class Recorder>
using HoldOf = decltype(std::declval<Recorder&>().hold(std::declval<const Commands<double>&>(), 0.0));
template <class Recorder>
using RowOf = std::enable_if_t<
    std::is_same_v<Sample, decltype(std::declval<Recorder&>()(std::declval<const Quadrotor<double>&>(),
                                                              std::declval<const VehicleState<double>&>(),
                                                              std::declval<const Commands<double>&>()))>>;
template <class Recorder>
using RecorderStatusOf = decltype(std::declval<const Recorder&>().status());
template <class Recorder>
using RecorderColumnsOf = decltype(std::declval<const Recorder&>().columns());
template <class Recorder>
inline constexpr bool has_columns = is_detected<RecorderColumnsOf, Recorder>;

/// A recorder whose settings cannot be wrong has no status(): ok.
template <class Recorder>
Status recorder_status(const Recorder& recorder) noexcept {
  if constexpr (is_detected<RecorderStatusOf, Recorder>) {
    return recorder.status();
  } else {
    return Status::ok;
  }
}
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class Recorder>
inline constexpr bool is_recorder = is_detected<detail::HoldOf, Recorder>&& is_detected<detail::RowOf, Recorder>;

/// The vehicle's row at its present time, without error. Accelerations are those of the dynamics with the rotors as
/// they turn now, behind their lag (docs/paper.md, deviation 14). Commands are those held up to this instant, clipped:
/// a flight log has commands, and the paper's network gives them. Behind a 5 ms lag the rotors differ from them by some
/// 1e-2 in agile flight: motion and command determine each other no better. Altitude is above ground.
struct ExactRecorder {
  void hold(const Commands<double>& /*commands*/, double /*time_s*/) const noexcept {}

  template <class... Effects>
  Sample operator()(const Quadrotor<double, Effects...>& quadrotor, const VehicleState<double>& vehicle,
                    const Commands<double>& commands) const noexcept {
    const State<double>& body = vehicle.body;
    const Accelerations<double> motion = quadrotor.evaluate(vehicle).motion;
    const EulerAngles<double> euler = to_euler(body.attitude);
    Sample sample;
    sample.time_s = vehicle.time_s;
    sample.linear_acceleration_m_s2 = motion.linear_m_s2;
    sample.angular_acceleration_rad_s2 = motion.angular_rad_s2;
    sample.velocity_m_s = body_velocity(body);
    sample.body_rates_rad_s = body.body_rates_rad_s;
    sample.roll_rad = euler.roll_rad;
    sample.pitch_rad = euler.pitch_rad;
    sample.yaw_rad = euler.yaw_rad;
    sample.altitude_m = quadrotor.site().ground_z_m - body.position_m[2];
    for (std::size_t i = 0; i < commands.size(); ++i) sample.commands[i] = clip_command(commands[i]);
    return sample;
  }
};

/// The errors of a log. The defaults are none: NoisyRecorder then writes ExactRecorder's numbers.
struct RecorderErrors {
  double gyro_noise_rad_s{0};           ///< standard deviation per axis and gyro sample, white
  double derivative_interval_s{0.010};  ///< between the two gyro samples whose difference is the acceleration; above 0
  double command_latency_s{0};          ///< the commands of a row are those held this long before it ...
  double command_jitter_s{0};           ///< ... and up to this much longer: uniform, each row's its own
  double velocity_noise_m_s{0};         ///< standard deviation per body axis, white
  double attitude_noise_rad{0};         ///< standard deviation of a turn about each body axis, white
};

/// Two errors that bring the default random pilot's flights to the correlation of the paper's Fig. 2, 0.67 between roll
/// acceleration and signed command sum; exact rows have 0.98. The paper's own cause is unknown. Over 15,000 rows, seeds
/// 1, 2, 3 (docs/simulator.md has more settings):
///   noisy_gyro_errors      roll 0.67 0.68 0.64   pitch 0.67 0.67 0.67   yaw 0.12 0.11 0.11
///   late_command_errors    roll 0.68 0.69 0.67   pitch 0.68 0.68 0.68   yaw 0.83 0.83 0.84
/// The paper calls yaw strongly correlated too, which speaks for the second.
constexpr RecorderErrors noisy_gyro_errors() noexcept {
  RecorderErrors errors;
  errors.gyro_noise_rad_s = 0.05;  // over 10 ms: 7.1 rad/s^2 in the acceleration, whose own deviation is 6.6 in roll
  errors.command_jitter_s = 0.010;
  return errors;
}
/// Commands that were recorded 40 ms late.
constexpr RecorderErrors late_command_errors() noexcept {
  RecorderErrors errors;
  errors.command_latency_s = 0.040;
  return errors;
}

/// ExactRecorder's row with the errors of a log, w_k = w + s n_k, n_k standard normal, for two gyro samples
/// h = derivative_interval_s apart, the later one at the row:
///   body rates             w + s n_1
///   angular acceleration   w_dot + s (n_1 - n_0) / h      white, deviation sqrt(2) s / h
/// so that both share the later sample's noise, as in a log that differentiates its gyro; that a difference is a mean
/// over h is left out. Commands are those in force at t - command_latency_s - U(0, command_jitter_s), clipped; before
/// the first tick they are the first tick's. Altitude and linear acceleration are without error. Every row draws the
/// same number of values: an error that is changed leaves the others' noise alone.
template <class Engine>
class NoisyRecorder {
 public:
  /// The engine is the recorder's own from here on.
  explicit NoisyRecorder(const Engine& engine, const RecorderErrors& errors = {}) : engine_(engine), errors_(errors) {}

  const RecorderErrors& errors() const noexcept { return errors_; }

  /// `out_of_range` for an error that is negative or no number, or gyro samples no time apart.
  Status status() const noexcept {
    using detail::plausible_or_zero;
    const RecorderErrors& e = errors_;
    const bool holds = detail::plausible(e.derivative_interval_s) && plausible_or_zero(e.gyro_noise_rad_s) &&
                       plausible_or_zero(e.command_latency_s) && plausible_or_zero(e.command_jitter_s) &&
                       plausible_or_zero(e.velocity_noise_m_s) && plausible_or_zero(e.attitude_noise_rad);
    return holds ? Status::ok : Status::out_of_range;
  }

  void hold(const Commands<double>& commands, double time_s) {
    held_.push_back({time_s, commands});
    const double oldest_s = time_s - errors_.command_latency_s - errors_.command_jitter_s;
    while (held_.size() > 1 && held_[1].since_s <= oldest_s) held_.pop_front();
  }

  template <class... Effects>
  Sample operator()(const Quadrotor<double, Effects...>& quadrotor, const VehicleState<double>& vehicle,
                    const Commands<double>& commands) {
    const double jitter_s = uniform(engine_, 0, errors_.command_jitter_s);
    const double in_force_s = vehicle.time_s - errors_.command_latency_s - jitter_s;
    Sample sample = ExactRecorder{}(quadrotor, vehicle, commands_at(in_force_s, commands));

    const Vector3<double> before = noise(errors_.gyro_noise_rad_s), now = noise(errors_.gyro_noise_rad_s);
    sample.body_rates_rad_s += now;
    sample.angular_acceleration_rad_s2 += (now - before) / errors_.derivative_interval_s;
    sample.velocity_m_s += noise(errors_.velocity_noise_m_s);
    const Vector3<double> turn = noise(errors_.attitude_noise_rad) * 0.5;  // half angles: small, so cosine ~ 1
    const EulerAngles<double> euler =
        to_euler(vehicle.body.attitude * Quaternion<double>{1.0, turn[0], turn[1], turn[2]});
    sample.roll_rad = euler.roll_rad;
    sample.pitch_rad = euler.pitch_rad;
    sample.yaw_rad = euler.yaw_rad;
    return sample;
  }

 private:
  struct HeldCommands {
    double since_s;
    Commands<double> commands;
  };

  const Commands<double>& commands_at(double time_s, const Commands<double>& latest) const {
    constexpr double rounding_s = 1e-9;  // times are sums of steps: a tick is not missed by their last bits
    for (std::size_t i = held_.size(); i > 0; --i) {
      if (held_[i - 1].since_s <= time_s + rounding_s) return held_[i - 1].commands;
    }
    return held_.empty() ? latest : held_.front().commands;
  }

  Vector3<double> noise(double deviation) {
    Vector3<double> result;
    for (int i = 0; i < 3; ++i) result[i] = deviation * standard_normal(engine_);
    return result;
  }

  Engine engine_;
  RecorderErrors errors_;
  std::deque<HeldCommands> held_;
};

}  // namespace pinnquad
