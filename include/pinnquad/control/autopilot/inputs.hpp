// SPDX-License-Identifier: MIT
// The inputs of the controller, a flight stack's samples and its situation, and the report of a step. A bad sample
// counts as one that did not come: the last good one stays and ages, so that silence and NaN meet the same limits.
#pragma once

#include <cstdint>

#include "pinnquad/control/trajectory.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/status.hpp"
#include "pinnquad/dynamics/state.hpp"

namespace pinnquad::autopilot {

/// An input's bit, in reports and records.
inline constexpr std::uint8_t body_rates_bit = 1, attitude_bit = 2, local_bit = 4, set_point_bit = 8, voltage_bit = 16;

/// The greatest age of a battery voltage: it changes slowly, and stacks say it as seldom as once a second. Without one
/// the analytic inverse flies in place of a model that asks for it.
inline constexpr std::uint64_t voltage_limit_us = 2'000'000;

/// A tick's reaction, from good to bad.
enum class Reaction : std::uint8_t {
  flies,           ///< to the set point
  holds_position,  ///< no set point: stays where it was when the last one went stale
  levels,          ///< no position: level attitude, hover thrust
  keeps_commands,  ///< no attitude or body rates, or network and analytic inverse decline: the last commands again
  gives_up,        ///< no commands: the flight stack must take over
};

/// In words.
constexpr const char* to_string(Reaction reaction) noexcept {
  switch (reaction) {
    case Reaction::flies: return "flies";
    case Reaction::holds_position: return "holds position";
    case Reaction::levels: return "levels";
    case Reaction::keeps_commands: return "keeps commands";
    case Reaction::gives_up: return "gives up";
  }
  return "unknown reaction";
}

/// A step's reaction, and the reasons.
struct StepReport {
  Reaction reaction{Reaction::gives_up};
  std::uint8_t stale_inputs{0};  ///< as bits
  Status status{Status::ok};     ///< of outer loop and inverse; ok where none was asked
  Status cause{Status::ok};      ///< the network's own
  float worst_excess{0};         ///< of a feature beyond its envelope, in half-widths; 0 inside
  int worst_feature{-1};         ///< that feature, -1 if none
  float squared_distance{0};     ///< from the training rows (JointDistance); 0: none was measured

  constexpr bool stale(std::uint8_t bits) const noexcept { return (stale_inputs & bits) != 0; }
};

/// Use of a vehicle that is learnt in flight (docs/onboard.md), by a controller that has such a learner.
enum class Learning : std::uint8_t {
  off = 0,      ///< the model answers, and nothing is learnt
  learns = 1,   ///< the learner answers, with faint sines while a sum is unknown
  excites = 2,  ///< and with gentle sines for the next ten seconds of flight
  frozen = 3,   ///< the learner answers, and swaps no sum any more
};

/// A stack's number; off for one that is none.
constexpr Learning learning_of(std::uint32_t number) noexcept {
  return number <= static_cast<std::uint32_t>(Learning::frozen) ? static_cast<Learning>(number) : Learning::off;
}

/// The stack's own state, and what it asks of the learner.
struct Situation {
  bool drives_motors{false};  ///< this controller's commands reach them
  bool landed{false};
  Learning learning{Learning::off};

  /// The bias is estimated in flight alone.
  bool in_flight() const noexcept { return drives_motors && !landed; }
};

/// Position and velocity, NED.
struct LocalState {
  Vector3<float> position_m = Vector3<float>::Zero();
  Vector3<float> velocity_m_s = Vector3<float>::Zero();
};

/// A sample beyond it is refused: later sums would overflow.
inline constexpr float most_plausible = 1e6f;

namespace detail {

/// `not_finite`, or `out_of_range` beyond most_plausible.
inline Status check_sample(const Vector3<float>& v) noexcept {
  if (!all_finite(v)) return Status::not_finite;
  for (int i = 0; i < 3; ++i) {
    if (v[i] > most_plausible || v[i] < -most_plausible) return Status::out_of_range;
  }
  return Status::ok;
}

/// A number that is not finite is not asked for. `not_finite` if no position, velocity or acceleration is.
/// `out_of_range` where a number is beyond most_plausible.
inline Status check_set_point(const TrajectoryPoint<float>& wanted) noexcept {
  const auto beyond = [](float value) noexcept {
    return is_finite(value) && (value > most_plausible || value < -most_plausible);
  };
  if (beyond(wanted.yaw_rad) || beyond(wanted.yaw_rate_rad_s)) return Status::out_of_range;
  Status checked = Status::not_finite;
  for (const auto* v : {&wanted.position_m, &wanted.velocity_m_s, &wanted.acceleration_m_s2, &wanted.jerk_m_s3}) {
    for (int i = 0; i < 3; ++i) {
      if (!is_finite((*v)[i])) continue;
      if (beyond((*v)[i])) return Status::out_of_range;
      if (v != &wanted.jerk_m_s3) checked = Status::ok;
    }
  }
  return checked;
}

/// The set point; where it asks for nothing, the vehicle's own motion.
inline TrajectoryPoint<float> completed(const TrajectoryPoint<float>& wanted, const State<float>& now,
                                        float yaw_rad) noexcept {
  const auto or_else = [](float value, float otherwise) noexcept { return is_finite(value) ? value : otherwise; };
  TrajectoryPoint<float> point;
  for (int i = 0; i < 3; ++i) {
    const bool place = is_finite(wanted.position_m[i]);
    point.position_m[i] = place ? wanted.position_m[i] : now.position_m[i];
    point.velocity_m_s[i] = or_else(wanted.velocity_m_s[i], place ? 0.0f : now.velocity_m_s[i]);
    point.acceleration_m_s2[i] = or_else(wanted.acceleration_m_s2[i], 0.0f);
    point.jerk_m_s3[i] = or_else(wanted.jerk_m_s3[i], 0.0f);
  }
  point.yaw_rad = or_else(wanted.yaw_rad, yaw_rad);
  point.yaw_rate_rad_s = or_else(wanted.yaw_rate_rad_s, 0.0f);
  return point;
}

/// The last good sample of an input.
template <class Value>
class Input {
 public:
  /// Takes the sample if `checked` is ok; what was there before stays otherwise.
  Status accept(std::uint64_t time_us, const Value& value, Status checked) noexcept {
    if (checked != Status::ok) {
      ++refused_;
      return checked;
    }
    value_ = value;
    time_us_ = time_us;
    came_ = true;
    return checked;
  }

  /// A time stamp of the future is as stale as one long past.
  bool fresh(std::uint64_t now_us, std::uint64_t limit_us) const noexcept {
    return came_ && now_us - time_us_ <= limit_us;
  }
  const Value& value() const noexcept { return value_; }
  /// Its age stays.
  void replace(const Value& value) noexcept { value_ = value; }
  std::uint32_t refused() const noexcept { return refused_; }

 private:
  Value value_{};
  std::uint64_t time_us_ = 0;
  std::uint32_t refused_ = 0;
  bool came_ = false;
};

}  // namespace detail

}  // namespace pinnquad::autopilot
