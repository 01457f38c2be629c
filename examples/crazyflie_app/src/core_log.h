/* SPDX-License-Identifier: MIT
 * The core's record (pinnquad/control/autopilot/core_record.hpp), packed as the payload of an event trigger, for the
 * firmware's log on a uSD card: at most 255 bytes. Names are the record's; times are in ms, as the core is given them.
 * What a Crazyflie does not say (jerk, resets of the estimator) is left out. Each list has a struct, its variables'
 * types and names, and who fills it. */
#ifndef PINNQUAD_CRAZYFLIE_CORE_LOG_H
#define PINNQUAD_CRAZYFLIE_CORE_LOG_H

#include <stdint.h>

/* ONE(type, name), MANY(count, type, name), TIME(name of the record, name here); types as the firmware calls them. */
#define PINNQUAD_RECORD_LIST(ONE, MANY, TIME) \
  TIME(timestamp, timestamp_ms)               \
  TIME(body_rates_us, body_rates_ms)          \
  TIME(attitude_us, attitude_ms)              \
  TIME(local_us, local_ms)                    \
  TIME(set_point_us, set_point_ms)            \
  TIME(voltage_us, voltage_ms)                \
  ONE(uint32, tick)                           \
  ONE(uint32, model)                          \
  ONE(uint32, refused_samples)                \
  MANY(3, float, body_rates_rad_s)            \
  MANY(4, float, attitude)                    \
  MANY(3, float, position_m)                  \
  MANY(3, float, velocity_m_s)                \
  MANY(3, float, wanted_position_m)           \
  MANY(3, float, wanted_velocity_m_s)         \
  MANY(3, float, wanted_acceleration_m_s2)    \
  ONE(float, wanted_yaw_rad)                  \
  ONE(float, wanted_yaw_rate_rad_s)           \
  ONE(float, battery_voltage)                 \
  MANY(4, float, bias_sums)                   \
  MANY(4, float, analytic_bias_sums)          \
  MANY(3, float, bias_across_m_s2)            \
  MANY(2, float, bias_across_rate_m_s3)       \
  ONE(float, bias_noise)                      \
  ONE(float, analytic_bias_noise)             \
  ONE(float, bias_across_noise_m_s2)          \
  ONE(float, bias_waited_s)                   \
  ONE(float, analytic_bias_waited_s)          \
  ONE(float, lift)                            \
  MANY(4, float, commands)                    \
  ONE(float, envelope_excess)                 \
  ONE(float, squared_distance)                \
  ONE(float, innovation)                      \
  ONE(int8, envelope_feature)                 \
  ONE(uint8, came)                            \
  ONE(uint8, asked)                           \
  ONE(uint8, drives_motors)                   \
  ONE(uint8, landed)                          \
  ONE(uint8, reaction)                        \
  ONE(uint8, status)                          \
  ONE(uint8, cause)                           \
  ONE(uint8, stale_inputs)                    \
  ONE(uint8, trusted)                         \
  ONE(uint8, bias_status)                     \
  ONE(uint8, analytic_bias_status)            \
  ONE(uint8, learning)                        \
  ONE(uint8, learnt)

#define PINNQUAD_SETTINGS_LIST(ONE, MANY, TIME) \
  TIME(timestamp, timestamp_ms)                 \
  ONE(uint32, body_rates_us)                    \
  ONE(uint32, attitude_us)                      \
  ONE(uint32, local_us)                         \
  ONE(uint32, set_point_us)                     \
  ONE(uint32, keep_us)                          \
  ONE(uint32, level_us)                         \
  ONE(float, lowest_command)                    \
  ONE(float, highest_command)                   \
  ONE(float, position_1_s)                      \
  ONE(float, velocity_1_s)                      \
  ONE(float, tilt_1_s)                          \
  ONE(float, yaw_1_s)                           \
  ONE(float, roll_pitch_rate_1_s)               \
  ONE(float, yaw_rate_1_s)                      \
  ONE(float, horizontal_speed_m_s)              \
  ONE(float, climb_m_s)                         \
  ONE(float, descent_m_s)                       \
  ONE(float, take_off_s)                        \
  MANY(4, float, bias_time_constants_s)         \
  MANY(4, float, most_bias)                     \
  ONE(float, across_time_constant_s)            \
  ONE(float, most_across_m_s2)                  \
  ONE(float, bias_hold_s)                       \
  ONE(float, bias_fade_s)                       \
  ONE(float, state_delay_s)                     \
  ONE(uint32, effects)                          \
  ONE(float, drag_n_s_m)                        \
  ONE(float, rate_damping_n_m_s)                \
  ONE(float, distance_limit)                    \
  ONE(float, innovation_limit)

typedef float pinnquad_float_t;
typedef uint32_t pinnquad_uint32_t;
typedef uint8_t pinnquad_uint8_t;
typedef int8_t pinnquad_int8_t;

#define PINNQUAD_MEMBER_ONE(type, name) pinnquad_##type##_t name;
#define PINNQUAD_MEMBER_MANY(count, type, name) pinnquad_##type##_t name[count];
#define PINNQUAD_MEMBER_TIME(of, name) uint32_t name;

struct __attribute__((packed)) CrazyflieCoreRecord {
  PINNQUAD_RECORD_LIST(PINNQUAD_MEMBER_ONE, PINNQUAD_MEMBER_MANY, PINNQUAD_MEMBER_TIME)
};
struct __attribute__((packed)) CrazyflieCoreSettings {
  PINNQUAD_SETTINGS_LIST(PINNQUAD_MEMBER_ONE, PINNQUAD_MEMBER_MANY, PINNQUAD_MEMBER_TIME)
};

/* Entries of an eventtriggerPayloadDesc[]. */
#define PINNQUAD_EVENT_ONE(kind, label) {.type = eventtriggerType_##kind, .name = #label},
#define PINNQUAD_EVENT_2(kind, label) \
  {.type = eventtriggerType_##kind, .name = #label "[0]"}, {.type = eventtriggerType_##kind, .name = #label "[1]"},
#define PINNQUAD_EVENT_3(kind, label) \
  PINNQUAD_EVENT_2(kind, label){.type = eventtriggerType_##kind, .name = #label "[2]"},
#define PINNQUAD_EVENT_4(kind, label) \
  PINNQUAD_EVENT_3(kind, label){.type = eventtriggerType_##kind, .name = #label "[3]"},
#define PINNQUAD_EVENT_MANY(count, kind, label) PINNQUAD_EVENT_##count(kind, label)
#define PINNQUAD_EVENT_TIME(of, label) PINNQUAD_EVENT_ONE(uint32, label)

#ifdef __cplusplus
extern "C" {
#endif

/* Of the last pinnquad_flight_step(). */
void pinnquad_flight_record(struct CrazyflieCoreRecord* record);
/* The controller's settings. */
void pinnquad_flight_settings(uint32_t now_ms, struct CrazyflieCoreSettings* settings);

#ifdef __cplusplus
}
#endif

#endif
