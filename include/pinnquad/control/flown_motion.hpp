// SPDX-License-Identifier: MIT
// The flown motion of a window, as a model can be asked about it, and the mean commands that the rotors followed in it.
// A bias that is learnt in flight (control/motion_bias.hpp) and the command residual (docs/trust.md) compare motion and
// commands of one instant.
#pragma once

#include <cstddef>
#include <cstdint>

#include "pinnquad/control/rotor_follower.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/features/features.hpp"

namespace pinnquad {

/// Means over two periods of length T that follow each other. An acceleration is the difference of the mean velocities
/// or body rates of the two over T: the weight of the acceleration at time t rises to the border of the two and falls
/// from there. State and commands have the same weights, so that all are of one instant. The next motion shares a
/// period with this one: noise of a mean cancels in the sum of the two. A sample holds until the next one: the time
/// between two means is T, however the samples lie, or the noise would not cancel. The commands are behind the rotors'
/// lag, and as old as the state. Periods begin at whole multiples of T on the samples' clock, so that a
/// replay of a part of the ticks knows where. `Rotors`: a RotorFollower.
template <class Scalar, class Rotors = detail::RotorFollower<Scalar>>
class FlownMotion {
 public:
  /// T; the time constant of the rotors; by how much a state comes late beside the commands, of estimator and filters.
  explicit FlownMotion(std::uint32_t period_us = 25'000, Scalar rotor_lag_s = Scalar(0),
                       Scalar delay_s = Scalar(0)) noexcept
      : period_us_(period_us),
        period_s_(Scalar(1e-6) * static_cast<Scalar>(period_us)),
        settles_us_(3 * std::uint64_t{period_us} +
                    static_cast<std::uint64_t>(Scalar(1e6) * (delay_s + Scalar(20) * rotor_lag_s))),
        rotors_(rotor_lag_s, delay_s) {}

  std::uint32_t period_us() const noexcept { return period_us_; }

  /// Samples with the times at which they were taken: a period without one of each is none. One that is of an earlier
  /// period does not count, nor one that repeats the one before to the bit, unless it is 0, a vehicle at rest: a sensor
  /// that is late or frozen has none.
  void velocity(std::uint64_t time_us, const Vector3<Scalar>& m_s) noexcept {
    take(time_us, m_s, velocity_m_s_, now_.has_velocity, velocity_of_);
  }
  void body_rates(std::uint64_t time_us, const Vector3<Scalar>& rad_s) noexcept {
    take(time_us, rad_s, rates_rad_s_, now_.has_rates, rates_of_);
  }

  /// Drops the open periods: other commands flew, or the estimator was reset.
  void interrupt() noexcept { now_.whole = before_.whole = false; }

  /// One tick: the state, and the commands in force since the tick before. True if a period has ended, and the one
  /// before it was whole too: motion() and flown() are theirs. `known`: these commands drove the motors, and the state
  /// is fresh.
  bool tick(std::uint64_t now_us, bool known, const State<Scalar>& state, const Commands<Scalar>& commands) noexcept {
    const bool numbers = all_finite(commands);
    const bool follows = known && numbers && now_us > before_us_ && now_us - before_us_ <= longest_tick_us();
    if (!follows) {
      interrupt();
      if (numbers) rotors_.restart(commands);  // one that is none would stay behind the lag for good
    }
    const std::uint64_t number = now_us / period_us_;
    bool ended = false;
    if (number != number_) {
      ended = now_.whole && before_.whole && finish();
      before_ = now_;
      now_ = {};
      number_ = number;
      now_.has_velocity = velocity_of_ == number;
      now_.has_rates = rates_of_ == number;
      now_.whole = follows && now_us - number * period_us_ <= longest_tick_us();
    }
    if (follows) weigh(now_us, Scalar(1e-6) * static_cast<Scalar>(now_us - before_us_), state, commands);
    before_us_ = now_us;
    return ended;
  }

  /// Time between two motions.
  Scalar period_s(Scalar /*tick_s*/) const noexcept { return period_s_; }
  const MotionInputs<Scalar>& motion() const noexcept { return motion_; }
  const Commands<Scalar>& flown() const noexcept { return flown_; }
  /// The motion's, NED.
  const Vector3<Scalar>& velocity_m_s() const noexcept { return mean_velocity_m_s_; }
  /// After this time a motion does not depend on commands and samples before: three periods, the delay, and the rotors'
  /// lag until a float does not tell.
  std::uint64_t settles_us() const noexcept { return settles_us_; }

 private:
  std::uint64_t longest_tick_us() const noexcept {
    const std::uint64_t half = period_us_ / 2;
    return half < 20'000 ? half : 20'000;
  }

  /// Weighted sums over ticks.
  struct Weighted {
    Scalar weight{0};
    Quaternion<Scalar> attitude{Scalar(0), Scalar(0), Scalar(0), Scalar(0)};
    Vector3<Scalar> velocity = Vector3<Scalar>::Zero(), rates = Vector3<Scalar>::Zero();
    Commands<Scalar> commands{};

    void add(Scalar by, const State<Scalar>& state, const Commands<Scalar>& rotors) noexcept {
      const Quaternion<Scalar>&q = state.attitude, &sum = attitude;
      const Scalar along = sum.w * q.w + sum.x * q.x + sum.y * q.y + sum.z * q.z;
      const Scalar turn = along < Scalar(0) ? -by : by;  // q and -q are one attitude
      attitude = {sum.w + turn * q.w, sum.x + turn * q.x, sum.y + turn * q.y, sum.z + turn * q.z};
      weight += by;
      velocity += by * state.velocity_m_s;
      rates += by * state.body_rates_rad_s;
      for (std::size_t i = 0; i < rotors.size(); ++i) commands[i] += by * rotors[i];
    }
  };
  struct Period {
    Weighted rising, falling;  ///< as the earlier of the two, and as the later
    bool has_velocity = false, has_rates = false;
    bool whole = false;  ///< so far, since it began

    Vector3<Scalar> velocity() const noexcept { return (rising.velocity + falling.velocity) / weight(); }
    Vector3<Scalar> rates() const noexcept { return (rising.rates + falling.rates) / weight(); }
    Scalar weight() const noexcept { return rising.weight + falling.weight; }
  };

  /// `of`: the period of the last one. A sample comes before the tick that opens its period.
  void take(std::uint64_t time_us, const Vector3<Scalar>& value, Vector3<Scalar>& before, bool& has,
            std::uint64_t& of) noexcept {
    const bool repeated = value == before && !value.isZero(Scalar(0));
    before = value;
    if (repeated) return;
    of = time_us / period_us_;
    if (of == number_) has = true;
  }

  void weigh(std::uint64_t now_us, Scalar step_s, const State<Scalar>& state,
             const Commands<Scalar>& commands) noexcept {
    if (!rotors_.follow(now_us, step_s, commands)) now_.whole = false;
    const Scalar t = Scalar(1e-6) * static_cast<Scalar>(now_us - number_ * period_us_);
    now_.rising.add(t * step_s, state, rotors_.then());
    now_.falling.add((period_s_ - t) * step_s, state, rotors_.then());
  }

  PINNQUAD_NOINLINE bool finish() noexcept {
    if (!(before_.has_velocity && before_.has_rates && now_.has_velocity && now_.has_rates)) return false;
    Accelerations<Scalar> measured;
    const Vector3<Scalar> world_m_s2 = (now_.velocity() - before_.velocity()) / period_s_;
    measured.angular_rad_s2 = (now_.rates() - before_.rates()) / period_s_;
    const Weighted &a = before_.rising, &b = now_.falling;
    const Quaternion<Scalar>&p = a.attitude, &q = b.attitude;
    const Scalar turn = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z < Scalar(0) ? Scalar(-1) : Scalar(1);
    const Quaternion<Scalar> both{p.w + turn * q.w, p.x + turn * q.x, p.y + turn * q.y, p.z + turn * q.z};
    const Scalar weight = a.weight + b.weight, length = squared_norm(both);
    if (!(weight > Scalar(0) && length > Scalar(0))) return false;
    State<Scalar> mean;
    mean.velocity_m_s = (a.velocity + b.velocity) / weight;
    mean.body_rates_rad_s = (a.rates + b.rates) / weight;
    mean.attitude = normalized(both);
    Commands<Scalar> flown{};
    for (std::size_t i = 0; i < flown.size(); ++i) flown[i] = (a.commands[i] + b.commands[i]) / weight;
    measured.linear_m_s2 = body_derivative<Scalar>(mean, world_m_s2);
    if (!(all_finite(mean) && all_finite(measured.linear_m_s2) && all_finite(measured.angular_rad_s2))) return false;
    if (!all_finite(flown)) return false;
    motion_ = motion_inputs(mean, measured);
    mean_velocity_m_s_ = mean.velocity_m_s;
    flown_ = flown;
    return true;
  }

  std::uint32_t period_us_;
  Scalar period_s_;
  std::uint64_t settles_us_;
  std::uint64_t before_us_ = 0;
  std::uint64_t number_ = 0;  ///< of the period
  std::uint64_t velocity_of_ = 0, rates_of_ = 0;
  Period before_, now_;
  Rotors rotors_;
  Vector3<Scalar> velocity_m_s_ = Vector3<Scalar>::Zero(), rates_rad_s_ = Vector3<Scalar>::Zero();  ///< came last
  MotionInputs<Scalar> motion_{};
  Vector3<Scalar> mean_velocity_m_s_ = Vector3<Scalar>::Zero();
  Commands<Scalar> flown_{};
};

}  // namespace pinnquad
