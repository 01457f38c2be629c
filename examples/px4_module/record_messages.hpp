// SPDX-License-Identifier: MIT
// A core's record (pinnquad/control/autopilot/core_record.hpp) as messages of PX4: same names, same order, other types.
#pragma once

#include <string.h>

#include "pinnquad/control/autopilot/core_record.hpp"

namespace pinnquad_px4 {

/// `Message`: pinnquad_record_s.
template <class Message>
void copy_record(const pinnquad::autopilot::CoreRecord& from, Message& to) {
  to.timestamp = from.timestamp;
  to.body_rates_us = from.body_rates_us;
  to.attitude_us = from.attitude_us;
  to.local_us = from.local_us;
  to.set_point_us = from.set_point_us;
  to.voltage_us = from.voltage_us;
  to.tick = from.tick;
  to.model = from.model;
  to.refused_samples = from.refused_samples;
  memcpy(to.body_rates_rad_s, from.body_rates_rad_s, sizeof to.body_rates_rad_s);
  memcpy(to.attitude, from.attitude, sizeof to.attitude);
  memcpy(to.position_m, from.position_m, sizeof to.position_m);
  memcpy(to.velocity_m_s, from.velocity_m_s, sizeof to.velocity_m_s);
  memcpy(to.wanted_position_m, from.wanted_position_m, sizeof to.wanted_position_m);
  memcpy(to.wanted_velocity_m_s, from.wanted_velocity_m_s, sizeof to.wanted_velocity_m_s);
  memcpy(to.wanted_acceleration_m_s2, from.wanted_acceleration_m_s2, sizeof to.wanted_acceleration_m_s2);
  memcpy(to.wanted_jerk_m_s3, from.wanted_jerk_m_s3, sizeof to.wanted_jerk_m_s3);
  to.wanted_yaw_rad = from.wanted_yaw_rad;
  to.wanted_yaw_rate_rad_s = from.wanted_yaw_rate_rad_s;
  to.battery_voltage = from.battery_voltage;
  memcpy(to.bias_sums, from.bias_sums, sizeof to.bias_sums);
  memcpy(to.analytic_bias_sums, from.analytic_bias_sums, sizeof to.analytic_bias_sums);
  memcpy(to.bias_across_m_s2, from.bias_across_m_s2, sizeof to.bias_across_m_s2);
  memcpy(to.bias_across_rate_m_s3, from.bias_across_rate_m_s3, sizeof to.bias_across_rate_m_s3);
  to.bias_noise = from.bias_noise;
  to.analytic_bias_noise = from.analytic_bias_noise;
  to.bias_across_noise_m_s2 = from.bias_across_noise_m_s2;
  to.bias_waited_s = from.bias_waited_s;
  to.analytic_bias_waited_s = from.analytic_bias_waited_s;
  memcpy(to.jump_position_m, from.jump_position_m, sizeof to.jump_position_m);
  memcpy(to.jump_velocity_m_s, from.jump_velocity_m_s, sizeof to.jump_velocity_m_s);
  to.jump_yaw_rad = from.jump_yaw_rad;
  to.lift = from.lift;
  memcpy(to.commands, from.commands, sizeof to.commands);
  to.envelope_excess = from.envelope_excess;
  to.squared_distance = from.squared_distance;
  to.innovation = from.innovation;
  to.envelope_feature = from.envelope_feature;
  to.came = from.came;
  to.asked = from.asked;
  to.drives_motors = from.drives_motors;
  to.landed = from.landed;
  to.reaction = from.reaction;
  to.status = from.status;
  to.cause = from.cause;
  to.stale_inputs = from.stale_inputs;
  to.trusted = from.trusted;
  to.bias_status = from.bias_status;
  to.analytic_bias_status = from.analytic_bias_status;
  to.learning = from.learning;
  to.learnt = from.learnt;
}

/// `Message`: pinnquad_settings_s.
template <class Message>
void copy_settings(const pinnquad::autopilot::CoreSettings& from, Message& to) {
  to.timestamp = from.timestamp;
  to.body_rates_us = from.body_rates_us;
  to.attitude_us = from.attitude_us;
  to.local_us = from.local_us;
  to.set_point_us = from.set_point_us;
  to.keep_us = from.keep_us;
  to.level_us = from.level_us;
  to.lowest_command = from.lowest_command;
  to.highest_command = from.highest_command;
  to.position_1_s = from.position_1_s;
  to.velocity_1_s = from.velocity_1_s;
  to.tilt_1_s = from.tilt_1_s;
  to.yaw_1_s = from.yaw_1_s;
  to.roll_pitch_rate_1_s = from.roll_pitch_rate_1_s;
  to.yaw_rate_1_s = from.yaw_rate_1_s;
  to.horizontal_speed_m_s = from.horizontal_speed_m_s;
  to.climb_m_s = from.climb_m_s;
  to.descent_m_s = from.descent_m_s;
  to.take_off_s = from.take_off_s;
  memcpy(to.bias_time_constants_s, from.bias_time_constants_s, sizeof to.bias_time_constants_s);
  memcpy(to.most_bias, from.most_bias, sizeof to.most_bias);
  to.across_time_constant_s = from.across_time_constant_s;
  to.most_across_m_s2 = from.most_across_m_s2;
  to.bias_hold_s = from.bias_hold_s;
  to.bias_fade_s = from.bias_fade_s;
  to.state_delay_s = from.state_delay_s;
  to.effects = from.effects;
  to.drag_n_s_m = from.drag_n_s_m;
  to.rate_damping_n_m_s = from.rate_damping_n_m_s;
  to.distance_limit = from.distance_limit;
  to.innovation_limit = from.innovation_limit;
}

}  // namespace pinnquad_px4
