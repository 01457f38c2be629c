// SPDX-License-Identifier: MIT
// A pilot is a policy: the set points that the flight controller is asked for, tick by tick.
// Contract: `SetPoint<double> operator()(const State<double>& state, double time_s)`, called in time order.
#pragma once

#include <cmath>
#include <type_traits>
#include <utility>

#include "pinnquad/control/flight_controller.hpp"
#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/core/types.hpp"

namespace pinnquad {

namespace detail {
template <class Pilot>
using SetPointOf = std::enable_if_t<
    std::is_same_v<SetPoint<double>, decltype(std::declval<Pilot&>()(std::declval<const State<double>&>(), 0.0))>>;
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class Pilot>
inline constexpr bool is_pilot = is_detected<detail::SetPointOf, Pilot>;

/// Asks for the same all the time; by default for a hover.
struct SteadyPilot {
  SetPoint<double> set_point{};

  SetPoint<double> operator()(const State<double>& /*state*/, double /*time_s*/) const { return set_point; }
};

namespace detail {

/// How the thumbs move.
struct ThumbStyle {
  double frame_s{0.004};                    ///< the sticks arrive in frames, as over a 250 Hz radio link
  double bandwidth_rad_s{14};               ///< of a first-order random process
  double roll_pitch_deviation_rad_s{0.21};  ///< its standard deviation
  double yaw_deviation_rad_s{0.062};
};

/// Stick noise. Per axis s(k+1) = a s(k) + sqrt(1 - a^2) deviation n(k), a = exp(-frame bandwidth), n normal; held
/// between frames. Three draws per frame: roll, pitch, yaw.
class Thumbs {
 public:
  explicit Thumbs(const ThumbStyle& style)
      : frame_s_(style.frame_s),
        memory_(std::exp(-style.frame_s * style.bandwidth_rad_s)),
        drive_(std::sqrt(1 - memory_ * memory_)),
        deviation_rad_s_(style.roll_pitch_deviation_rad_s, style.roll_pitch_deviation_rad_s,
                         style.yaw_deviation_rad_s) {}

  /// Moves the sticks if a frame is due; rad/s about the body axes, FRD. To be called in time order, once per tick;
  /// with a tick longer than a frame one frame per tick arrives.
  template <class Engine>
  void move(Engine& engine, double time_s, Vector3<double>& stick_rad_s) {
    constexpr double early = 1e-6;  // a frame is due on a tick although both times are rounded
    if (time_s < next_frame_s_ - early) return;
    next_frame_s_ += frame_s_;
    for (int i = 0; i < 3; ++i) {
      stick_rad_s[i] = memory_ * stick_rad_s[i] + drive_ * deviation_rad_s_[i] * standard_normal(engine);
    }
  }

 private:
  double frame_s_;
  double memory_;
  double drive_;
  Vector3<double> deviation_rad_s_;
  double next_frame_s_{0};
};

/// The set point of a pilot who flies at random: velocity and yaw rate follow targets with a lag, the thumbs are busy.
struct RandomSticks {
  explicit RandomSticks(const ThumbStyle& style) : thumbs(style) {}

  template <class Engine>
  void choose_yaw_rate(Engine& engine, double most_rad_s) {
    target_yaw_rate_rad_s = uniform(engine, -most_rad_s, most_rad_s);
  }
  /// To be called in time order. Without lag all of the way at once.
  template <class Engine, class Style>
  void follow(Engine& engine, const Style& style, double at_s) {
    const double elapsed_s = at_s - time_s;
    const auto share = [&](double lag_s) { return lag_s == 0 ? 1 : elapsed_s / (lag_s + elapsed_s); };
    wanted.velocity_m_s += (target_velocity_m_s - wanted.velocity_m_s) * share(style.velocity_lag_s);
    wanted.yaw_rate_rad_s += (target_yaw_rate_rad_s - wanted.yaw_rate_rad_s) * share(style.yaw_rate_lag_s);
    thumbs.move(engine, at_s, wanted.stick_rad_s);
    time_s = at_s;
  }

  Thumbs thumbs;
  double time_s{0};  ///< of the last tick
  Vector3<double> target_velocity_m_s = Vector3<double>::Zero();
  double target_yaw_rate_rad_s{0};
  SetPoint<double> wanted{};
};

}  // namespace detail

}  // namespace pinnquad
