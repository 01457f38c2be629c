// SPDX-License-Identifier: MIT
// Of PX4's messages (v1.16; setpoint_config of later branches), the fields that the module uses, under their names;
// queue lengths and numbers are PX4's.
#pragma once

#include <cstdint>

struct vehicle_angular_velocity_s {
  uint64_t timestamp, timestamp_sample;
  float xyz[3];
};
struct vehicle_attitude_s {
  uint64_t timestamp, timestamp_sample;
  float q[4];
  uint8_t quat_reset_counter;
};
struct vehicle_local_position_s {
  uint64_t timestamp, timestamp_sample;
  float x, y, z, vx, vy, vz;
  float delta_xy[2], delta_z, delta_vxy[2], delta_vz, delta_heading;
  uint8_t xy_reset_counter, z_reset_counter, vxy_reset_counter, vz_reset_counter, heading_reset_counter;
  bool xy_valid, z_valid, v_xy_valid, v_z_valid;
};
struct trajectory_setpoint_s {
  uint64_t timestamp;
  float position[3], velocity[3], acceleration[3], jerk[3], yaw, yawspeed;
};
struct battery_status_s {
  uint64_t timestamp;
  bool connected;
  float scale;      ///< from 1 on; -1: not known
  float voltage_v;  ///< 0: not known
};
struct goto_setpoint_s {
  uint64_t timestamp;
  float position[3];
  bool flag_control_heading;
  float heading;
};
struct manual_control_setpoint_s {
  uint64_t timestamp, timestamp_sample;
  bool valid;
  float roll, pitch, yaw, throttle;
};
struct vehicle_thrust_setpoint_s {
  uint64_t timestamp, timestamp_sample;
  float xyz[3];
};
struct vehicle_torque_setpoint_s {
  uint64_t timestamp, timestamp_sample;
  float xyz[3];
};
struct vehicle_land_detected_s {
  uint64_t timestamp;
  bool landed;
};
struct vehicle_status_s {
  static constexpr uint8_t ARMING_STATE_DISARMED = 1, ARMING_STATE_ARMED = 2;
  static constexpr uint8_t NAVIGATION_STATE_ALTCTL = 1, NAVIGATION_STATE_POSCTL = 2, NAVIGATION_STATE_AUTO_LOITER = 4,
                           NAVIGATION_STATE_DESCEND = 12, NAVIGATION_STATE_EXTERNAL1 = 23;
  uint64_t timestamp;
  uint32_t valid_nav_states_mask;
  uint8_t arming_state, nav_state;
};
struct failsafe_flags_s {
  uint64_t timestamp;
  uint32_t mode_req_angular_velocity, mode_req_attitude, mode_req_local_alt, mode_req_local_position,
      mode_req_local_position_relaxed, mode_req_global_position, mode_req_manual_control;
  bool angular_velocity_invalid, attitude_invalid, local_altitude_invalid, local_position_invalid,
      local_position_invalid_relaxed, global_position_invalid, manual_control_signal_lost;
};
struct actuator_motors_s {
  uint64_t timestamp, timestamp_sample;
  float control[12];
};
struct arming_check_request_s {
  uint64_t timestamp;
  uint8_t request_id;
};
struct arming_check_reply_s {
  static constexpr uint8_t HEALTH_COMPONENT_INDEX_NONE = 0;
  static constexpr uint8_t ORB_QUEUE_LENGTH = 4;
  uint64_t timestamp;
  uint8_t request_id, registration_id, health_component_index;
  bool can_arm_and_run, mode_req_angular_velocity, mode_req_attitude, mode_req_local_alt, mode_req_local_position;
};
struct register_ext_component_request_s {
  static constexpr uint16_t LATEST_PX4_ROS2_API_VERSION = 1;
  static constexpr uint8_t ORB_QUEUE_LENGTH = 2;
  uint64_t timestamp, request_id;
  char name[25];
  uint16_t px4_ros2_api_version;
  bool register_arming_check, register_mode;
};
struct register_ext_component_reply_s {
  static constexpr uint8_t ORB_QUEUE_LENGTH = 2;
  uint64_t timestamp, request_id;
  char name[25];
  bool success;
  int8_t arming_check_id, mode_id;
};
struct unregister_ext_component_s {
  uint64_t timestamp;
  char name[25];
  int8_t arming_check_id, mode_id, mode_executor_id;
};
struct vehicle_control_mode_s {
  uint64_t timestamp;
  uint8_t source_id;
  bool flag_control_termination_enabled, flag_control_allocation_enabled;
};
struct setpoint_config_s {
  static constexpr uint16_t TYPE_INVALID = 0, TYPE_DIRECT_ACTUATORS = 1, TYPE_TRAJECTORY = 4;
  uint64_t timestamp;
  uint16_t type;
  uint8_t source_id;
  bool should_apply;
  uint16_t timeout_ms;
};
struct setpoint_config_reply_s {
  static constexpr uint8_t RESULT_SUCCESS = 0, RESULT_FAILURE_OTHER = 1;
  uint64_t timestamp;
  uint16_t type;
  uint8_t source_id, result;
};
struct parameter_update_s {
  uint64_t timestamp;
  uint32_t instance;
};
struct vehicle_command_s {
  static constexpr uint32_t VEHICLE_CMD_SET_NAV_STATE = 100001;
  static constexpr uint16_t COMPONENT_MODE_EXECUTOR_START = 1000;
  static constexpr uint8_t ORB_QUEUE_LENGTH = 8;
  uint64_t timestamp;
  float param1;
  uint32_t command;
  uint16_t source_component;
};
struct pinnquad_record_s {
  uint64_t timestamp;
  uint64_t body_rates_us;
  uint64_t attitude_us;
  uint64_t local_us;
  uint64_t set_point_us;
  uint64_t voltage_us;
  uint32_t tick;
  uint32_t model;
  uint32_t refused_samples;
  float body_rates_rad_s[3];
  float attitude[4];
  float position_m[3];
  float velocity_m_s[3];
  float wanted_position_m[3];
  float wanted_velocity_m_s[3];
  float wanted_acceleration_m_s2[3];
  float wanted_jerk_m_s3[3];
  float wanted_yaw_rad;
  float wanted_yaw_rate_rad_s;
  float battery_voltage;
  float bias_sums[4];
  float analytic_bias_sums[4];
  float bias_across_m_s2[3];
  float bias_across_rate_m_s3[2];
  float bias_noise, analytic_bias_noise, bias_across_noise_m_s2;
  float bias_waited_s, analytic_bias_waited_s;
  float jump_position_m[3];
  float jump_velocity_m_s[3];
  float jump_yaw_rad;
  float lift;
  float commands[4];
  float envelope_excess, squared_distance, innovation;
  int8_t envelope_feature;
  uint8_t came;
  uint8_t asked;
  uint8_t drives_motors;
  uint8_t landed;
  uint8_t reaction;
  uint8_t status;
  uint8_t cause;
  uint8_t stale_inputs;
  uint8_t trusted;
  uint8_t bias_status, analytic_bias_status, learning, learnt;
};
struct pinnquad_settings_s {
  uint64_t timestamp;
  uint32_t body_rates_us;
  uint32_t attitude_us;
  uint32_t local_us;
  uint32_t set_point_us;
  uint32_t keep_us;
  uint32_t level_us;
  float lowest_command;
  float highest_command;
  float position_1_s;
  float velocity_1_s;
  float tilt_1_s;
  float yaw_1_s;
  float roll_pitch_rate_1_s;
  float yaw_rate_1_s;
  float horizontal_speed_m_s;
  float climb_m_s;
  float descent_m_s;
  float take_off_s;
  float bias_time_constants_s[4];
  float most_bias[4];
  float across_time_constant_s, most_across_m_s2, bias_hold_s, bias_fade_s, state_delay_s;
  uint32_t effects;
  float drag_n_s_m, rate_damping_n_m_s, distance_limit, innovation_limit;
};
struct pinnquad_status_s {
  uint64_t timestamp;
  uint32_t inference_time_us, asked, refused_samples;
  float fallback_share, envelope_excess;
  int8_t envelope_feature;
  uint8_t reaction, status, cause, stale_inputs, bias_status;
};
