// SPDX-License-Identifier: MIT
// The settings of a controller as its record has them, and its defaults.
#pragma once

#include <cstdint>
#include <tuple>
#include <type_traits>

#include "pinnquad/aero/drag.hpp"
#include "pinnquad/control/autopilot/core_record.hpp"
#include "pinnquad/control/autopilot/inputs.hpp"
#include "pinnquad/control/bias_estimate.hpp"
#include "pinnquad/control/flight_controller.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad::autopilot {

/// The aerodynamic effects of the analytic inverse's vehicle, for a record: four bits of `code` for each effect, the
/// first in the lowest, 0 at the end; and the coefficients of effects that have some.
struct FlownEffects {
  static constexpr std::uint32_t quadratic_drag = 1, linear_damping = 2, another = 15;

  std::uint32_t code{0};
  float drag_N_s_m{0};          ///< of LinearDamping
  float rate_damping_N_m_s{0};  ///< of LinearDamping
};

/// From the eighth effect on the code is `another`.
template <class... Effects>
FlownEffects flown_effects(const Quadrotor<float, Effects...>& vehicle) noexcept {
  FlownEffects flown;
  unsigned place = 0;
  const auto add = [&](const auto& effect) noexcept {
    using Effect = std::decay_t<decltype(effect)>;
    std::uint32_t code = FlownEffects::another;
    if constexpr (std::is_same_v<Effect, QuadraticDrag>) code = FlownEffects::quadratic_drag;
    if constexpr (std::is_same_v<Effect, LinearDamping>) {
      code =
          flown.drag_N_s_m > 0 || flown.rate_damping_N_m_s > 0 ? FlownEffects::another : FlownEffects::linear_damping;
      flown.drag_N_s_m = static_cast<float>(effect.drag_N_s_m);
      flown.rate_damping_N_m_s = static_cast<float>(effect.rate_damping_N_m_s);
    }
    flown.code |= (place < 8 ? code << (4 * place) : FlownEffects::another << 28);
    ++place;
  };
  static_cast<void>(add);
  std::apply([&add](const auto&... effect) noexcept { (add(effect), ...); }, vehicle.effects());
  return flown;
}

/// All settings of a controller, with its defaults.
struct ControllerSettings {
  AgeLimits ages{};
  OutputLimits outputs{};
  FlightGains<float> gains{};
  SpeedLimits speeds{};
  BiasSettings<float> bias{};
};

/// The settings as a record has them.
inline CoreSettings core_settings(const ControllerSettings& from, const FlownEffects& effects) noexcept {
  const auto us = [](std::uint64_t time_us) noexcept { return static_cast<std::uint32_t>(time_us); };
  CoreSettings to;
  to.body_rates_us = us(from.ages.body_rates_us);
  to.attitude_us = us(from.ages.attitude_us);
  to.local_us = us(from.ages.local_us);
  to.set_point_us = us(from.ages.set_point_us);
  to.keep_us = us(from.ages.keep_us);
  to.level_us = us(from.ages.level_us);
  to.lowest_command = from.outputs.lower;
  to.highest_command = from.outputs.upper;
  to.position_1_s = from.gains.position_1_s;
  to.velocity_1_s = from.gains.velocity_1_s;
  to.tilt_1_s = from.gains.tilt_1_s;
  to.yaw_1_s = from.gains.yaw_1_s;
  to.roll_pitch_rate_1_s = from.gains.roll_pitch_rate_1_s;
  to.yaw_rate_1_s = from.gains.yaw_rate_1_s;
  to.horizontal_speed_m_s = from.speeds.horizontal_m_s;
  to.climb_m_s = from.speeds.climb_m_s;
  to.descent_m_s = from.speeds.descent_m_s;
  to.take_off_s = from.speeds.take_off_s;
  to.bias_bandwidth_1_s = from.bias.bandwidth_1_s;
  to.most_bias_m_s2 = from.bias.max_bias_m_s2;
  to.effects = effects.code;
  to.drag_n_s_m = effects.drag_N_s_m;
  to.rate_damping_n_m_s = effects.rate_damping_N_m_s;
  return to;
}

/// The settings that a record says.
inline ControllerSettings controller_settings(const CoreSettings& s) noexcept {
  return {{s.body_rates_us, s.attitude_us, s.local_us, s.set_point_us, s.keep_us, s.level_us},
          {s.lowest_command, s.highest_command},
          {s.position_1_s, s.velocity_1_s, s.tilt_1_s, s.yaw_1_s, s.roll_pitch_rate_1_s, s.yaw_rate_1_s},
          {s.horizontal_speed_m_s, s.climb_m_s, s.descent_m_s, s.take_off_s},
          {s.bias_bandwidth_1_s, s.most_bias_m_s2}};
}

/// Limits of the outer loop, of the vehicle and of the speeds that its stack allows.
inline FlightLimits<float> flown_limits(const Airframe<float>& airframe, const FlightGains<float>& gains,
                                        const SpeedLimits& speeds) noexcept {
  FlightLimits<float> limits = flight_limits(airframe, 1.0f, gains);
  limits.max_horizontal_speed_m_s = speeds.horizontal_m_s;
  limits.max_climb_m_s = speeds.climb_m_s;
  limits.max_descent_m_s = speeds.descent_m_s;
  return limits;
}

/// Commands that neither rotor nor sound network asks for: the analytic inverse is asked instead.
struct AbsurdCommands {
  static constexpr double lower = -0.5;
  static constexpr double upper = 1.5;
};

}  // namespace pinnquad::autopilot
