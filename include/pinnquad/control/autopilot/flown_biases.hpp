// SPDX-License-Identifier: MIT
// The biases of network and analytic inverse (control/motion_bias.hpp), learnt from one flown motion; the alarm of the
// network's, and the command residual, of what its bias cannot explain.
#pragma once

#include <cstdint>

#include "pinnquad/control/autopilot/bias_alarm.hpp"
#include "pinnquad/control/autopilot/core_settings.hpp"
#include "pinnquad/control/autopilot/flown_trust.hpp"
#include "pinnquad/control/autopilot/inputs.hpp"
#include "pinnquad/control/flown_motion.hpp"
#include "pinnquad/control/motion_bias.hpp"
#include "pinnquad/control/tick_clock.hpp"

namespace pinnquad::autopilot::detail {

/// A tick, as the biases see it.
struct FlownTick {
  std::uint64_t now_us{0};
  bool in_flight{false};
  bool known{false};      ///< the commands drove the motors, and the state is fresh
  bool freezes{false};    ///< they were not all of an answer, or at their ends; or the ground may bear it
  bool on_ground{false};  ///< its thrust has gone
};

/// `Trust`: FlownTrust's.
template <class Trust>
class FlownBiases {
 public:
  /// Two windows of the command residual. A raised alarm is cleared no faster than alarm_clear_s.
  static constexpr std::uint64_t residual_window_us = 2 * motions_of_window * FlownMotionSettings<float>{}.period_us;
  static constexpr float alarm_clear_s = BiasAlarm::clear_s;
  /// After this time a flown motion does not depend on commands and samples before: three periods, the delay, and the
  /// rotors' lag until a float does not tell.
  static std::uint64_t motion_settles_us(const Airframe<float>& airframe, const CoreSettings& settings) noexcept {
    constexpr float lags = 20.0f;
    const float settles_s = settings.state_delay_s + lags * airframe.rise_time_constant_s(0);
    return 3 * FlownMotionSettings<float>{}.period_us + static_cast<std::uint64_t>(1e6f * settles_s);
  }

  FlownBiases(const Airframe<float>& airframe, const CoreSettings& settings) noexcept
      : motion_({FlownMotionSettings<float>{}.period_us, airframe.rise_time_constant_s(0), settings.state_delay_s}),
        network_(airframe, bias_settings(settings)),
        analytic_(network_) {}

  FlownMotion<float>& motion() noexcept { return motion_; }
  const MotionBias<float>& network() const noexcept { return network_; }
  const MotionBias<float>& analytic() const noexcept { return analytic_; }
  const FlownTrust<Trust>& trust() const noexcept { return trust_; }
  /// True while the network's bias has stood at its bound for too long.
  bool alarm() const noexcept { return alarm_.raised(); }

  /// Of both: where the network declines, its bias moves with the analytic inverse's.
  void time_constants(const SignedSums<float>& times_s) noexcept {
    network_.time_constants(times_s);
    analytic_.time_constants(times_s);
  }
  void another_model() noexcept {
    if (!given_) network_.reset();
    alarm_.reset();
    trust_.reset();
  }

  /// Goes on from a logged tick.
  void resume(const CoreRecord& logged) noexcept {
    resume_biases(logged);
    if constexpr (FlownTrust<Trust>::known) trust_.resume(logged.innovation, logged.trusted != 0);
    // where the command residual is below its limit, `distrusted` is the bias' alarm
    if (logged.trusted != 0 && logged.reaction <= static_cast<std::uint8_t>(Reaction::levels) && logged.asked != 0) {
      alarm_.resume(logged.cause == static_cast<std::uint8_t>(Status::distrusted));
    }
  }
  /// The biases of a logged tick: the next learn() learns nothing.
  void give(const CoreRecord& logged) noexcept {
    resume_biases(logged);
    given_ = true;
  }

  /// Both biases learn where a motion is complete. Where the tick freezes they stay as they are; without a motion they
  /// wait; on the ground they are forgotten. `network`, `analytic`: an inverse's Status and commands for a motion.
  template <class Network, class Analytic>
  void learn(const FlownTick& tick, const State<float>& state, const Commands<float>& commands, const Network& network,
             const Analytic& analytic) noexcept {
    const std::uint64_t now_us = tick.now_us;
    const float step_s = clock_.step_s(now_us);
    if (!tick.in_flight) {
      alarm_.reset();
      trust_.reset();
    }
    const bool complete = motion_.tick(now_us, tick.known, state, commands);
    if (tick.freezes) motion_.interrupt();
    if (given_) {
      given_ = false;
    } else if (tick.on_ground) {
      network_.reset();
      analytic_.reset();
    } else if (tick.freezes) {
      network_.freeze();
      analytic_.freeze();
    } else if (complete) {
      compare(now_us, network, analytic);
    } else {
      network_.wait(step_s);
      analytic_.wait(step_s);
    }
    if (tick.known) alarm_.update(network_.share_of_bound(), analytic_.share_of_bound(), step_s);
  }

 private:
  void resume_biases(const CoreRecord& logged) noexcept {
    const auto sums = [](const float(&b)[4]) noexcept { return SignedSums<float>{b[0], b[1], b[2], b[3]}; };
    const float(&d)[3] = logged.bias_across_m_s2;
    const Vector3<float> across(d[0], d[1], d[2]);
    network_.resume(sums(logged.bias_sums), across, logged.bias_waited_s, static_cast<Status>(logged.bias_status));
    analytic_.resume(sums(logged.analytic_bias_sums), across, logged.analytic_bias_waited_s,
                     static_cast<Status>(logged.analytic_bias_status));
  }

  /// Where the network declines the motion that was flown, its bias moves with the analytic inverse's: it would be of
  /// another time when the network answers again.
  template <class Network, class Analytic>
  PINNQUAD_NOINLINE void compare(std::uint64_t now_us, const Network& network, const Analytic& analytic) noexcept {
    const MotionInputs<float>& motion = motion_.motion();
    const Commands<float>& flown = motion_.flown();
    const float period_s = motion_.period_s(0);
    Commands<float> said{};
    const SignedSums<float> before = analytic_.sums();
    if (analytic(motion, said) == Status::ok) static_cast<void>(analytic_.learn(motion, flown, said, period_s));
    if (network(motion, said) != Status::ok) {
      network_.follow(before, analytic_.sums());
      return;
    }
    if constexpr (FlownTrust<Trust>::known) {
      Commands<float> with_bias = said;
      network_.add_to(with_bias);
      trust_.judge(now_us, motion_.settings().period_us, with_bias, flown);
    }
    static_cast<void>(network_.learn(motion, flown, said, period_s));
  }

  FlownMotion<float> motion_;
  MotionBias<float> network_, analytic_;
  FlownTrust<Trust> trust_{};
  BiasAlarm alarm_;
  pinnquad::detail::TickClock<float> clock_;
  bool given_ = false;
};

}  // namespace pinnquad::autopilot::detail
