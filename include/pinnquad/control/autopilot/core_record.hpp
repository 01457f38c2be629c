// SPDX-License-Identifier: MIT
// The record of a tick: the controller's inputs and its answer as plain numbers. A module logs it; `pinnquad replay`
// runs it through the same controller on the ground (docs/replay_log.md). each_number() is the format: numbers, order,
// names and units of PX4's message (px4_module/msg), of a Crazyflie's event and of a CSV. A field keeps its name, and
// one that is added is as a record is made where a log lacks it, so that earlier logs replay. NED, FRD, SI units,
// commands in the airframe's rotor order.
#pragma once

#include <array>
#include <cstdint>

#include "pinnquad/control/flight_controller.hpp"
#include "pinnquad/control/motion_bias.hpp"

namespace pinnquad::autopilot {

/// One tick. Inputs are those that came last, refused ones too; of one input one sample per tick at most.
struct CoreRecord {
  static constexpr const char* topic = "pinnquad_record";
  /// Fields that earlier logs lack.
  static constexpr std::array<const char*, 8> added = {"voltage_us",
                                                       "battery_voltage",
                                                       "bias_noise",
                                                       "analytic_bias_noise",
                                                       "bias_across_noise_m_s2",
                                                       "bias_across_rate_m_s3",
                                                       "learning",
                                                       "learnt"};
  /// Bits of `learnt`: a sum that was learnt flies (its number from 0), and the learner has seen flight.
  static constexpr std::uint8_t learnt_sums = 15, seen_flight = 16;
  /// A field of the cores before, whose bias was an acceleration: this one does not answer as they did.
  static constexpr const char* removed = "bias_m_s2";

  std::uint64_t timestamp{0};  ///< of the tick, on the clock of the samples
  std::uint64_t body_rates_us{0};
  std::uint64_t attitude_us{0};
  std::uint64_t local_us{0};
  std::uint64_t set_point_us{0};
  std::uint64_t voltage_us{0};
  std::uint32_t tick{0};   ///< counts from 1; a number that is missing was not logged
  std::uint32_t model{0};  ///< checksum of the model block that flew; 0: none was accepted yet
  std::uint32_t refused_samples{0};
  float body_rates_rad_s[3]{};
  float attitude[4]{1, 0, 0, 0};  ///< w, x, y, z; body -> world
  float position_m[3]{};
  float velocity_m_s[3]{};       ///< world
  float wanted_position_m[3]{};  ///< of the set point, as all that follows; NaN: not asked for
  float wanted_velocity_m_s[3]{};
  float wanted_acceleration_m_s2[3]{};
  float wanted_jerk_m_s3[3]{};
  float wanted_yaw_rad{0};
  float wanted_yaw_rate_rad_s{0};
  float battery_voltage{0};          ///< V; of a model that asks for it
  float bias_sums[4]{};              ///< of the network (while it answers, of the learner): MotionBias::sums(), as the
                                     ///< tick reckoned with, as all of these
  float analytic_bias_sums[4]{};     ///< of the analytic inverse
  float bias_across_m_s2[3]{};       ///< NED, of both
  float bias_across_rate_m_s3[2]{};  ///< its trend, north and east
  float bias_noise{0};               ///< MotionBias::Learnt of roll and pitch, of the network
  float analytic_bias_noise{0};      ///< of the analytic inverse
  float bias_across_noise_m_s2{0};
  float bias_waited_s{0};  ///< time in which nothing could be learnt
  float analytic_bias_waited_s{0};
  float jump_position_m[3]{};  ///< step of the estimator before this tick, NED; 0: none
  float jump_velocity_m_s[3]{};
  float jump_yaw_rad{0};
  float lift{1};              ///< share of the thrust that it used: below 1 at take-off and landing
  float commands[4]{};        ///< NaN where there were none
  float envelope_excess{0};   ///< of the worst feature beyond its range, in half-widths
  float squared_distance{0};  ///< of the features from the training rows; 0 without limits of trust
  float innovation{0};        ///< command residual of the model; 0 without limits of trust
  std::int8_t envelope_feature{-1};
  std::uint8_t came{0};           ///< inputs that came since the tick before, as bits
  std::uint8_t asked{0};          ///< 0: the stack asked nothing of the controller: off, or flown by hand
  std::uint8_t drives_motors{0};  ///< its commands reached the motors
  std::uint8_t landed{0};         ///< the stack said so
  std::uint8_t reaction{0};       ///< Reaction
  std::uint8_t status{0};         ///< Status
  std::uint8_t cause{0};          ///< Status of the network
  std::uint8_t stale_inputs{0};   ///< as bits
  std::uint8_t trusted{1};        ///< by the command residual
  std::uint8_t bias_status{static_cast<std::uint8_t>(Status::warming_up)};           ///< MotionBias::status()
  std::uint8_t analytic_bias_status{static_cast<std::uint8_t>(Status::warming_up)};  ///< the same
  std::uint8_t learning{0};                                                          ///< Learning
  std::uint8_t learnt{0};                                                            ///< as bits

  /// Calls `visit(name, unit, number or array)` for each, in order. It may throw what `visit` throws.
  template <class Self, class Visit>
  static void each_number(Self& self, const Visit& visit) {
    visit("timestamp", "us", self.timestamp);
    visit("body_rates_us", "us", self.body_rates_us);
    visit("attitude_us", "us", self.attitude_us);
    visit("local_us", "us", self.local_us);
    visit("set_point_us", "us", self.set_point_us);
    visit("voltage_us", "us", self.voltage_us);
    visit("tick", "1", self.tick);
    visit("model", "1", self.model);
    visit("refused_samples", "1", self.refused_samples);
    visit("body_rates_rad_s", "rad/s", self.body_rates_rad_s);
    visit("attitude", "1", self.attitude);
    visit("position_m", "m", self.position_m);
    visit("velocity_m_s", "m/s", self.velocity_m_s);
    visit("wanted_position_m", "m", self.wanted_position_m);
    visit("wanted_velocity_m_s", "m/s", self.wanted_velocity_m_s);
    visit("wanted_acceleration_m_s2", "m/s^2", self.wanted_acceleration_m_s2);
    visit("wanted_jerk_m_s3", "m/s^3", self.wanted_jerk_m_s3);
    visit("wanted_yaw_rad", "rad", self.wanted_yaw_rad);
    visit("wanted_yaw_rate_rad_s", "rad/s", self.wanted_yaw_rate_rad_s);
    visit("battery_voltage", "V", self.battery_voltage);
    visit("bias_sums", "1", self.bias_sums);
    visit("analytic_bias_sums", "1", self.analytic_bias_sums);
    visit("bias_across_m_s2", "m/s^2", self.bias_across_m_s2);
    visit("bias_across_rate_m_s3", "m/s^3", self.bias_across_rate_m_s3);
    visit("bias_noise", "1", self.bias_noise);
    visit("analytic_bias_noise", "1", self.analytic_bias_noise);
    visit("bias_across_noise_m_s2", "m/s^2", self.bias_across_noise_m_s2);
    visit("bias_waited_s", "s", self.bias_waited_s);
    visit("analytic_bias_waited_s", "s", self.analytic_bias_waited_s);
    visit("jump_position_m", "m", self.jump_position_m);
    visit("jump_velocity_m_s", "m/s", self.jump_velocity_m_s);
    visit("jump_yaw_rad", "rad", self.jump_yaw_rad);
    visit("lift", "1", self.lift);
    visit("commands", "1", self.commands);
    visit("envelope_excess", "1", self.envelope_excess);
    visit("squared_distance", "1", self.squared_distance);
    visit("innovation", "1", self.innovation);
    visit("envelope_feature", "1", self.envelope_feature);
    visit("came", "bits", self.came);
    visit("asked", "1", self.asked);
    visit("drives_motors", "1", self.drives_motors);
    visit("landed", "1", self.landed);
    visit("reaction", "1", self.reaction);
    visit("status", "1", self.status);
    visit("cause", "1", self.cause);
    visit("stale_inputs", "bits", self.stale_inputs);
    visit("trusted", "1", self.trusted);
    visit("bias_status", "1", self.bias_status);
    visit("analytic_bias_status", "1", self.analytic_bias_status);
    visit("learning", "1", self.learning);
    visit("learnt", "bits", self.learnt);
  }
};

/// The settings of a controller, logged once when it starts. The controller writes the effects and the limits of trust
/// itself.
struct CoreSettings {
  static constexpr const char* topic = "pinnquad_settings";
  /// An effect in `effects`: four bits each, the first effect in the lowest, 0 at the end.
  static constexpr std::uint32_t quadratic_drag = 1, linear_damping = 2, another_effect = 15;

  std::uint64_t timestamp{0};
  // the greatest age of each input, counted from its time stamp
  std::uint32_t body_rates_us{10'000};  ///< older: keeps its commands
  std::uint32_t attitude_us{20'000};    ///< older: keeps its commands
  std::uint32_t local_us{100'000};      ///< position and velocity; older: levels
  std::uint32_t set_point_us{500'000};  ///< older: holds its place
  std::uint32_t keep_us{40'000};        ///< commands are kept this long; then it gives up
  std::uint32_t level_us{1'000'000};    ///< it levels this long without a position; then it gives up
  // range of the motor commands, thrust over greatest thrust
  float lowest_command{0.02f};  ///< rotors keep turning
  float highest_command{1};
  // FlightGains
  float position_1_s{FlightGains<float>{}.position_1_s};
  float velocity_1_s{FlightGains<float>{}.velocity_1_s};
  float tilt_1_s{FlightGains<float>{}.tilt_1_s};
  float yaw_1_s{FlightGains<float>{}.yaw_1_s};
  float roll_pitch_rate_1_s{FlightGains<float>{}.roll_pitch_rate_1_s};
  float yaw_rate_1_s{FlightGains<float>{}.yaw_rate_1_s};
  // greatest speeds towards a set point
  float horizontal_speed_m_s{12};
  float climb_m_s{5};
  float descent_m_s{3};
  float take_off_s{1};  ///< time that thrust takes to come at take-off
  // BiasSettings, of the network's bias and the analytic inverse's; and the delay of a FlownMotion
  float bias_time_constants_s[4]{};  ///< 0: what the model's block says, or the usual one; see state_delay_s
  float most_bias[4]{BiasSettings<float>{}.most[0], BiasSettings<float>{}.most[1], BiasSettings<float>{}.most[2],
                     BiasSettings<float>{}.most[3]};
  float across_time_constant_s{BiasSettings<float>{}.across_time_constant_s};
  float most_across_m_s2{BiasSettings<float>{}.most_across_m_s2};
  float bias_hold_s{BiasSettings<float>{}.hold_s};
  float bias_fade_s{BiasSettings<float>{}.fade_s};
  /// By which a state comes late beside the commands. 0: unknown, and the biases are slow; above 0 they are
  /// quick_where_told().
  float state_delay_s{0};
  // effects of the analytic inverse's vehicle
  std::uint32_t effects{0};
  float drag_n_s_m{0};          ///< of LinearDamping
  float rate_damping_n_m_s{0};  ///< of LinearDamping
  // limits of trust; 0: none
  float distance_limit{0};    ///< of the squared distance
  float innovation_limit{0};  ///< of the command residual

  /// As CoreRecord's.
  template <class Self, class Visit>
  static void each_number(Self& self, const Visit& visit) {
    visit("timestamp", "us", self.timestamp);
    visit("body_rates_us", "us", self.body_rates_us);
    visit("attitude_us", "us", self.attitude_us);
    visit("local_us", "us", self.local_us);
    visit("set_point_us", "us", self.set_point_us);
    visit("keep_us", "us", self.keep_us);
    visit("level_us", "us", self.level_us);
    visit("lowest_command", "1", self.lowest_command);
    visit("highest_command", "1", self.highest_command);
    visit("position_1_s", "1/s", self.position_1_s);
    visit("velocity_1_s", "1/s", self.velocity_1_s);
    visit("tilt_1_s", "1/s", self.tilt_1_s);
    visit("yaw_1_s", "1/s", self.yaw_1_s);
    visit("roll_pitch_rate_1_s", "1/s", self.roll_pitch_rate_1_s);
    visit("yaw_rate_1_s", "1/s", self.yaw_rate_1_s);
    visit("horizontal_speed_m_s", "m/s", self.horizontal_speed_m_s);
    visit("climb_m_s", "m/s", self.climb_m_s);
    visit("descent_m_s", "m/s", self.descent_m_s);
    visit("take_off_s", "s", self.take_off_s);
    visit("bias_time_constants_s", "s", self.bias_time_constants_s);
    visit("most_bias", "1", self.most_bias);
    visit("across_time_constant_s", "s", self.across_time_constant_s);
    visit("most_across_m_s2", "m/s^2", self.most_across_m_s2);
    visit("bias_hold_s", "s", self.bias_hold_s);
    visit("bias_fade_s", "s", self.bias_fade_s);
    visit("state_delay_s", "s", self.state_delay_s);
    visit("effects", "1", self.effects);
    visit("drag_n_s_m", "N s/m", self.drag_n_s_m);
    visit("rate_damping_n_m_s", "N m s", self.rate_damping_n_m_s);
    visit("distance_limit", "1", self.distance_limit);
    visit("innovation_limit", "1", self.innovation_limit);
  }
};

}  // namespace pinnquad::autopilot
