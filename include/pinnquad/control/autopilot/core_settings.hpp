// SPDX-License-Identifier: MIT
// The settings of a controller as its record has them, and its defaults.
#pragma once

#include <cstdint>
#include <tuple>
#include <type_traits>

#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/linear_damping.hpp"
#include "pinnquad/control/autopilot/core_record.hpp"
#include "pinnquad/control/autopilot/inputs.hpp"
#include "pinnquad/control/autopilot/take_off.hpp"
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

inline CoreSettings core_settings(const AgeLimits& ages, const OutputLimits& outputs,
                                  const FlightController<float>& outer_loop, const TakeOff& take_off,
                                  const BiasEstimate<float>& bias) noexcept {
  const auto us = [](std::uint64_t time_us) noexcept { return static_cast<std::uint32_t>(time_us); };
  const FlightGains<float>& gains = outer_loop.gains();
  CoreSettings all;
  all.body_rates_us = us(ages.body_rates_us);
  all.attitude_us = us(ages.attitude_us);
  all.local_us = us(ages.local_us);
  all.set_point_us = us(ages.set_point_us);
  all.keep_us = us(ages.keep_us);
  all.level_us = us(ages.level_us);
  all.lowest_command = outputs.lower;
  all.highest_command = outputs.upper;
  all.position_1_s = gains.position_1_s;
  all.velocity_1_s = gains.velocity_1_s;
  all.tilt_1_s = gains.tilt_1_s;
  all.yaw_1_s = gains.yaw_1_s;
  all.roll_pitch_rate_1_s = gains.roll_pitch_rate_1_s;
  all.yaw_rate_1_s = gains.yaw_rate_1_s;
  all.horizontal_speed_m_s = outer_loop.limits().max_horizontal_speed_m_s;
  all.climb_m_s = outer_loop.limits().max_climb_m_s;
  all.descent_m_s = outer_loop.limits().max_descent_m_s;
  all.take_off_s = take_off.duration_s();
  all.bias_bandwidth_1_s = bias.settings().bandwidth_1_s;
  all.most_bias_m_s2 = bias.settings().max_bias_m_s2;
  return all;
}

inline void add_effects(const FlownEffects& effects, CoreSettings& to) noexcept {
  to.effects = effects.code;
  to.drag_n_s_m = effects.drag_N_s_m;
  to.rate_damping_n_m_s = effects.rate_damping_N_m_s;
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
