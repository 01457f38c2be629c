// SPDX-License-Identifier: MIT
// The parts of a controller, from its settings; and the effects of its vehicle, as settings name them.
#pragma once

#include <cstdint>
#include <tuple>
#include <type_traits>

#include "pinnquad/aero/drag.hpp"
#include "pinnquad/control/autopilot/core_record.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad::autopilot::detail {

/// The outer loop of a vehicle: the gains and speeds of the settings, the limits of the airframe.
inline FlightController<float> outer_loop(const CoreSettings& settings, const Airframe<float>& airframe,
                                          float gravity_m_s2) noexcept {
  const FlightGains<float> gains{settings.position_1_s, settings.velocity_1_s,        settings.tilt_1_s,
                                 settings.yaw_1_s,      settings.roll_pitch_rate_1_s, settings.yaw_rate_1_s};
  FlightLimits<float> limits = flight_limits(airframe, 1.0f, gains);
  limits.max_horizontal_speed_m_s = settings.horizontal_speed_m_s;
  limits.max_climb_m_s = settings.climb_m_s;
  limits.max_descent_m_s = settings.descent_m_s;
  return FlightController<float>(gains, limits, gravity_m_s2);
}

/// The time constants of both biases: those of the settings, and where they say 0 the model's own, quick ones where the
/// settings tell the delay of the states.
inline SignedSums<float> bias_time_constants_s(const CoreSettings& settings,
                                               const BiasSettings<float>& own = {}) noexcept {
  SignedSums<float> times_s = (settings.state_delay_s > 0 ? quick_where_told(own) : own).time_constants_s;
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    if (settings.bias_time_constants_s[k] > 0) times_s[k] = settings.bias_time_constants_s[k];
  }
  return times_s;
}

/// The settings of both biases until a model says time constants of its own.
inline BiasSettings<float> bias_settings(const CoreSettings& settings) noexcept {
  BiasSettings<float> result;
  if (settings.state_delay_s > 0) result = quick_where_told(result);
  result.time_constants_s = bias_time_constants_s(settings);
  for (std::size_t k = 0; k < result.most.size(); ++k) result.most[k] = settings.most_bias[k];
  result.across_time_constant_s = settings.across_time_constant_s;
  result.most_across_m_s2 = settings.most_across_m_s2;
  result.hold_s = settings.bias_hold_s;
  result.fade_s = settings.bias_fade_s;
  return result;
}

/// The settings with the effects of a vehicle. From the eighth effect on the code is `another_effect`.
template <class... Effects>
CoreSettings with_effects(CoreSettings settings, const Quadrotor<float, Effects...>& vehicle) noexcept {
  settings.effects = 0;
  settings.drag_n_s_m = settings.rate_damping_n_m_s = 0;
  unsigned place = 0;
  const auto add = [&](const auto& effect) noexcept {
    using Effect = std::decay_t<decltype(effect)>;
    std::uint32_t code = CoreSettings::another_effect;
    if constexpr (std::is_same_v<Effect, QuadraticDrag>) code = CoreSettings::quadratic_drag;
    if constexpr (std::is_same_v<Effect, LinearDamping>) {
      const bool second = settings.drag_n_s_m > 0 || settings.rate_damping_n_m_s > 0;
      code = second ? CoreSettings::another_effect : CoreSettings::linear_damping;
      settings.drag_n_s_m = static_cast<float>(effect.drag_N_s_m);
      settings.rate_damping_n_m_s = static_cast<float>(effect.rate_damping_N_m_s);
    }
    settings.effects |= (place < 8 ? code << (4 * place) : CoreSettings::another_effect << 28);
    ++place;
  };
  static_cast<void>(add);
  std::apply([&add](const auto&... effect) noexcept { (add(effect), ...); }, vehicle.effects());
  return settings;
}

/// The biases of a logged tick.
template <class Learner>
void resume_biases(const CoreRecord& logged, Learner& learner) noexcept {
  const auto resume = [&](auto& bias, const float(&b)[4], float noise, float waited_s, std::uint8_t status) noexcept {
    bias.resume({{b[0], b[1], b[2], b[3]},
                 Vector3<float>(logged.bias_across_m_s2),
                 {logged.bias_across_rate_m_s3[0], logged.bias_across_rate_m_s3[1], 0},
                 noise,
                 logged.bias_across_noise_m_s2,
                 waited_s,
                 static_cast<Status>(status)});
  };
  if (logged.learning != 0) {  // it is the learner's that was logged
    learner.own().reset();
  } else {
    resume(learner.own(), logged.bias_sums, logged.bias_noise, logged.bias_waited_s, logged.bias_status);
  }
  resume(learner.last(), logged.analytic_bias_sums, logged.analytic_bias_noise, logged.analytic_bias_waited_s,
         logged.analytic_bias_status);
}

/// Commands that neither rotor nor sound network asks for: the analytic inverse is asked instead.
struct AbsurdCommands {
  static constexpr double lower = -0.5, upper = 1.5;
};

}  // namespace pinnquad::autopilot::detail
