// SPDX-License-Identifier: MIT
// The glue between PX4 and neural_control_core.hpp; see pinnquad_control.hpp.
#include "pinnquad_control.hpp"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "record_messages.hpp"

namespace {

constexpr const char* mode_name = "Pinnquad";
constexpr const char* default_model = PX4_STORAGEDIR "/etc/pinnquad/model.block";
constexpr uint64_t request_head = 0x70696e6eull << 32;  // ours among the replies; below it, which of ours
constexpr uint32_t fallback_interval_us = 10'000;
constexpr uint64_t register_again_us = 500'000;
[[maybe_unused]] constexpr uint64_t configure_again_us = 1'000'000;  // of v1.16 alone
constexpr uint64_t ask_again_us = 10'000;
constexpr uint64_t warm_us = 20'000;  // between steps while another mode is selected
constexpr uint64_t settings_again_us = 1'000'000;
constexpr uint64_t known_after_us = 2'000'000;  // by then vehicle_status has the mode, or PX4 has dropped it

px4::atomic_bool in_command{false};  // selected and armed: what `stop` asks

uint64_t clock_us() { return hrt_absolute_time(); }

/// Of PX4's own parameters; `otherwise` where this build has none of that name.
template <class Value>
Value px4_parameter(const char* name, Value otherwise) {
  Value value = otherwise;
  const param_t handle = param_find(name);
  if (handle != PARAM_INVALID) param_get(handle, &value);
  return value;
}

/// Of either type.
float own_parameter(const char* name) {
  const param_t handle = param_find(name);
  if (handle == PARAM_INVALID) return NAN;
  if (param_type(handle) == PARAM_TYPE_INT32) {
    int32_t value = 0;
    param_get(handle, &value);
    return static_cast<float>(value);
  }
  float value = NAN;
  param_get(handle, &value);
  return value;
}

float ca_rotor(unsigned rotor, const char* what) {
  char name[] = "CA_ROTOR0_??";
  name[8] = static_cast<char>('0' + rotor);
  name[10] = what[0];
  name[11] = what[1];
  return px4_parameter(name, 0.0f);
}

}  // namespace

PinnquadControl::PinnquadControl()
    : ModuleParams(nullptr),
      ScheduledWorkItem(MODULE_NAME, px4::wq_configurations::rate_ctrl),
      _propulsion(_param_air_density.get(), _param_curve.get(), px4_parameter("THR_MDL_FAC", 0.0f)),
      _core(&clock_us, controller_settings()),
      _source(stick_speeds()) {
  _core.propulsion(_propulsion);
}

pinnquad::autopilot::CoreSettings PinnquadControl::controller_settings() const {
  const auto us = [](int32_t time_ms) { return static_cast<uint32_t>(time_ms) * 1000; };
  pinnquad::autopilot::CoreSettings settings;
  settings.body_rates_us = us(_param_age_rates.get());
  settings.attitude_us = us(_param_age_attitude.get());
  settings.local_us = us(_param_age_position.get());
  settings.set_point_us = us(_param_age_setpoint.get());
  settings.lowest_command = _propulsion.thrust(_param_out_min.get());
  settings.highest_command = _propulsion.thrust(1.0f);
  settings.position_1_s = _param_gain_position.get();
  settings.velocity_1_s = _param_gain_velocity.get();
  settings.tilt_1_s = _param_gain_tilt.get();
  settings.yaw_1_s = _param_gain_yaw.get();
  settings.roll_pitch_rate_1_s = _param_gain_rate.get();
  settings.yaw_rate_1_s = _param_gain_yaw_rate.get();
  settings.horizontal_speed_m_s = _param_speed_horizontal.get();
  settings.climb_m_s = _param_speed_up.get();
  settings.descent_m_s = _param_speed_down.get();
  settings.take_off_s = _param_take_off.get();
  for (size_t k = 0; k < 4; ++k) {  // the commands' sum; roll, pitch and yaw, whose sums are a quarter as great
    settings.bias_time_constants_s[k] = k == 0 ? _param_bias_thrust.get() : _param_bias_rotation.get();
    settings.most_bias[k] = k == 0 ? _param_bias_most.get() : _param_bias_most.get() / 4;
  }
  settings.most_across_m_s2 = _param_bias_across.get();
  settings.state_delay_s = _param_bias_delay.get();
  return settings;
}

pinnquad_px4::StickSpeeds PinnquadControl::stick_speeds() const {
  return {_param_stick_horizontal.get(), _param_stick_vertical.get(), _param_stick_vertical.get() / 2,
          _param_stick_yaw.get()};
}

PinnquadControl::Publications* PinnquadControl::publications() {
  static Publications* const all = new Publications;  // the shell starts modules one at a time
  return all;
}

bool PinnquadControl::flies() { return in_command.load(); }

pinnquad::Status PinnquadControl::load_model(const char* path) {
  if (!_core.model_settled()) {  // the block to be written may still be read
    PX4_ERR("%s: the model before is not flown yet: once more in 0.1 s", path);
    return pinnquad::Status::out_of_range;
  }
  const int file = open(path, O_RDONLY);
  if (file < 0) {
    PX4_ERR("no model at %s", path);
    return pinnquad::Status::block_truncated;
  }
  Block& block = _blocks[_next_block];
  size_t length = 0;
  while (length < block_bytes) {
    const ssize_t got = read(file, block.bytes + length, block_bytes - length);
    if (got <= 0) break;
    length += static_cast<size_t>(got);
  }
  close(file);
  const pinnquad::Status status = _core.offer_model(block.bytes, length);
  if (status == pinnquad::Status::ok) _next_block = 1 - _next_block;
  PX4_INFO("%s: %s", path, pinnquad::to_string(status));
  return status;
}

bool PinnquadControl::init() {
  if (load_model(default_model) != pinnquad::Status::ok) return false;
  return _angular_velocity_sub.registerCallback();
}

void PinnquadControl::Run() {
  ScheduleDelayed(fallback_interval_us);  // body rates that stop would else stop the staleness check as well
  read_vehicle();
  if (should_exit() && !flies()) {
    _angular_velocity_sub.unregisterCallback();
    ScheduleClear();
    unregister_mode();
    leaves();
    return;
  }
  check_parameters();
  keep_registered();
  if (_mode_id < 0) return;
  answer_arming_check();
  const uint64_t now_us = hrt_absolute_time();
  if (!_selected && now_us - _ran_us < warm_us) return;
  _ran_us = now_us;
  take_samples();
  const auto learning = static_cast<uint32_t>(_param_onboard.get());
  _core.situation({flies(), _landed, pinnquad::autopilot::learning_of(learning)});
  pinnquad_px4::ActuatorMotors motors;
  pinnquad_px4::PinnquadStatus status;
  _has_commands = _core.run(motors, status);  // selected or not: the status says whether it could fly
  _stale_inputs = status.stale_inputs;
  if (_selected && _has_commands) publish(motors);
  if (_has_commands) _said_no_commands = false;
  if (_selected && !_has_commands && !_armed) {
    publish_stopped();
    say_no_commands();
  }
  if (_selected && (!_has_commands || should_exit() || _takeover.asking())) {
    ask_for_takeover();
  } else {
    _takeover.heard();
  }
  publish(status);
  if (_param_record.get() != 0) {
    publish_record();
    publish_settings();
  }
}

void PinnquadControl::read_vehicle() {
  vehicle_status_s vehicle_status;
  if (_vehicle_status_sub.update(&vehicle_status)) {
    const bool selected = _mode_id >= 0 && vehicle_status.nav_state == static_cast<uint8_t>(_mode_id);
    if (selected && !_selected && !_fits) _refusal_to_say = true;
    _selected = selected;
    _armed = vehicle_status.arming_state == vehicle_status_s::ARMING_STATE_ARMED;
    _valid_modes = vehicle_status.valid_nav_states_mask;
    in_command.store(_selected && _armed);
  }
  if (!_selected) _configured = false;
  vehicle_land_detected_s land_detected;
  if (_land_detected_sub.update(&land_detected)) _landed = land_detected.landed;
  failsafe_flags_s flags;
  if (_failsafe_flags_sub.update(&flags)) {
    _failsafe_flags.mode_req_angular_velocity = flags.mode_req_angular_velocity;
    _failsafe_flags.mode_req_attitude = flags.mode_req_attitude;
    _failsafe_flags.mode_req_local_alt = flags.mode_req_local_alt;
    _failsafe_flags.mode_req_local_position = flags.mode_req_local_position;
    _failsafe_flags.mode_req_local_position_relaxed = flags.mode_req_local_position_relaxed;
    _failsafe_flags.mode_req_global_position = flags.mode_req_global_position;
    _failsafe_flags.mode_req_manual_control = flags.mode_req_manual_control;
    _failsafe_flags.angular_velocity_invalid = flags.angular_velocity_invalid;
    _failsafe_flags.attitude_invalid = flags.attitude_invalid;
    _failsafe_flags.local_altitude_invalid = flags.local_altitude_invalid;
    _failsafe_flags.local_position_invalid = flags.local_position_invalid;
    _failsafe_flags.local_position_invalid_relaxed = flags.local_position_invalid_relaxed;
    _failsafe_flags.global_position_invalid = flags.global_position_invalid;
    _failsafe_flags.manual_control_signal_lost = flags.manual_control_signal_lost;
  }
}

void PinnquadControl::take_samples() {
  vehicle_angular_velocity_s rates;
  if (_angular_velocity_sub.update(&rates)) {
    pinnquad_px4::VehicleAngularVelocity sample;
    sample.timestamp_sample = rates.timestamp_sample;
    memcpy(sample.xyz, rates.xyz, sizeof sample.xyz);
    static_cast<void>(_core.take(sample));  // a refused sample is counted in the status
  }
  vehicle_attitude_s attitude;
  if (_attitude_sub.update(&attitude)) {
    pinnquad_px4::VehicleAttitude sample;
    sample.timestamp_sample = attitude.timestamp_sample;
    memcpy(sample.q, attitude.q, sizeof sample.q);
    _heading = pinnquad::heading(pinnquad::Quaternion<float>{sample.q[0], sample.q[1], sample.q[2], sample.q[3]});
    static_cast<void>(_core.take(sample));
  }
  vehicle_local_position_s local;
  if (_local_position_sub.update(&local)) {
    pinnquad_px4::VehicleLocalPosition sample;
    sample.timestamp_sample = local.timestamp_sample;
    sample.xy_valid = local.xy_valid, sample.z_valid = local.z_valid;
    sample.v_xy_valid = local.v_xy_valid, sample.v_z_valid = local.v_z_valid;
    sample.x = local.x, sample.y = local.y, sample.z = local.z;
    sample.vx = local.vx, sample.vy = local.vy, sample.vz = local.vz;
    sample.xy_reset_counter = local.xy_reset_counter, sample.z_reset_counter = local.z_reset_counter;
    sample.vxy_reset_counter = local.vxy_reset_counter, sample.vz_reset_counter = local.vz_reset_counter;
    sample.heading_reset_counter = local.heading_reset_counter;
    memcpy(sample.delta_xy, local.delta_xy, sizeof sample.delta_xy);
    memcpy(sample.delta_vxy, local.delta_vxy, sizeof sample.delta_vxy);
    sample.delta_z = local.delta_z, sample.delta_vz = local.delta_vz, sample.delta_heading = local.delta_heading;
    static_cast<void>(_core.take(sample));
    _velocity_m_s[0] = local.vx, _velocity_m_s[1] = local.vy, _velocity_m_s[2] = local.vz;
  }
  battery_status_s battery;
  if (_battery_sub.update(&battery)) {
    const bool scales = _param_battery_scale.get() != 0 && battery.connected;
    _core.battery_scale(scales ? battery.scale : 1.0f);
    pinnquad_px4::BatteryStatus sample;
    sample.timestamp = battery.timestamp;
    sample.connected = battery.connected;
    sample.voltage_v = battery.voltage_v;
    static_cast<void>(_core.take(sample));
  }
  take_set_point();
}

void PinnquadControl::take_set_point() {
  trajectory_setpoint_s trajectory;
  if (_trajectory_setpoint_sub.update(&trajectory)) {
    pinnquad_px4::TrajectorySetpoint sample;
    sample.timestamp = trajectory.timestamp;
    memcpy(sample.position, trajectory.position, sizeof sample.position);
    memcpy(sample.velocity, trajectory.velocity, sizeof sample.velocity);
    memcpy(sample.acceleration, trajectory.acceleration, sizeof sample.acceleration);
    memcpy(sample.jerk, trajectory.jerk, sizeof sample.jerk);
    sample.yaw = trajectory.yaw;
    sample.yawspeed = trajectory.yawspeed;
    _source.take(sample);
  }
  goto_setpoint_s place;
  if (_goto_setpoint_sub.update(&place)) {
    pinnquad_px4::GotoSetpoint sample;
    sample.timestamp = place.timestamp;
    memcpy(sample.position, place.position, sizeof sample.position);
    sample.flag_control_heading = place.flag_control_heading;
    sample.heading = place.heading;
    _source.take(sample);
  }
  manual_control_setpoint_s sticks;
  if (_manual_control_sub.update(&sticks)) {
    _source.take(pinnquad_px4::ManualControlSetpoint{sticks.timestamp, sticks.valid, sticks.roll, sticks.pitch,
                                                     sticks.yaw, sticks.throttle});
  }
  pinnquad_px4::TrajectorySetpoint wanted;
  if (_source.choose(hrt_absolute_time(), _heading, _velocity_m_s, wanted)) static_cast<void>(_core.take(wanted));
}

void PinnquadControl::publish(const pinnquad_px4::ActuatorMotors& motors) {
  actuator_motors_s message{};
  message.timestamp = motors.timestamp;
  message.timestamp_sample = motors.timestamp_sample;
  for (float& control : message.control) control = NAN;
  for (int i = 0; i < 4; ++i) message.control[i] = motors.control[i];
  _publications.actuator_motors.publish(message);
  const auto& airframe = _core.controller().vehicle().airframe();
  const pinnquad_px4::BodySetpoints wanted = pinnquad_px4::body_setpoints(motors, airframe);
  vehicle_thrust_setpoint_s thrust{};
  thrust.timestamp = motors.timestamp;
  thrust.timestamp_sample = motors.timestamp_sample;
  memcpy(thrust.xyz, wanted.thrust, sizeof thrust.xyz);
  _publications.thrust.publish(thrust);
  vehicle_torque_setpoint_s torque{};
  torque.timestamp = motors.timestamp;
  torque.timestamp_sample = motors.timestamp_sample;
  memcpy(torque.xyz, wanted.torque, sizeof torque.xyz);
  _publications.torque.publish(torque);
}

/// Before arming nothing else writes this topic: PX4's simulated outputs follow it alone, and a simulator in lockstep
/// that waits for them would stand still, so that the inputs that are missing never come.
void PinnquadControl::publish_stopped() {
  actuator_motors_s message{};
  message.timestamp = message.timestamp_sample = hrt_absolute_time();
  for (float& control : message.control) control = NAN;
  _publications.actuator_motors.publish(message);
}

void PinnquadControl::publish(const pinnquad_px4::PinnquadStatus& status) {
  pinnquad_status_s message{};
  message.timestamp = status.timestamp;
  message.inference_time_us = status.inference_time_us;
  message.asked = status.asked;
  message.refused_samples = status.refused_samples;
  message.fallback_share = status.fallback_share;
  message.envelope_excess = status.envelope_excess;
  message.envelope_feature = status.envelope_feature;
  message.reaction = status.reaction;
  message.status = status.status;
  message.cause = status.cause;
  message.stale_inputs = status.stale_inputs;
  message.bias_status = status.bias_status;
  _publications.status.publish(message);
}

void PinnquadControl::publish_record() {
  pinnquad_record_s message{};
  pinnquad_px4::copy_record(_core.controller().record(), message);
  _publications.record.publish(message);
}

void PinnquadControl::publish_settings() {
  const uint64_t now_us = hrt_absolute_time();
  if (_settings_us != 0 && now_us - _settings_us < settings_again_us) return;
  _settings_us = now_us;
  pinnquad_settings_s message{};
  pinnquad_px4::copy_settings(_core.controller().settings(), message);
  message.timestamp = now_us;
  _publications.settings.publish(message);
}

void PinnquadControl::keep_registered() {
  const uint64_t now_us = hrt_absolute_time();
  read_registration();
  if (_mode_id >= 0) {
    const bool dropped = (_valid_modes & (uint32_t{1} << _mode_id)) == 0;
    if (_selected || !dropped || now_us - _registered_us < known_after_us) {
      keep_configured(now_us);
      return;
    }
    _mode_id = _arming_check_id = -1;
    _asked_to_register_us = 0;
  }
  const bool asked = _asked_to_register_us != 0 && now_us - _asked_to_register_us < register_again_us;
  if (_armed || asked) return;  // PX4 registers nobody while it is armed
  _asked_to_register_us = now_us;
  register_ext_component_request_s request{};
  request.timestamp = now_us;
  _request_id = request_head | (now_us & 0xffffffffu);  // the reply to an earlier one may still be there to be read
  request.request_id = _request_id;
  strncpy(request.name, mode_name, sizeof request.name - 1);
  request.px4_ros2_api_version = register_ext_component_request_s::LATEST_PX4_ROS2_API_VERSION;
  request.register_arming_check = true;
  request.register_mode = true;
  _publications.register_mode.publish(request);
}

void PinnquadControl::read_registration() {
  register_ext_component_reply_s reply;
  while (_register_reply_sub.update(&reply)) {
    if (reply.request_id != _request_id || strncmp(reply.name, mode_name, sizeof reply.name) != 0) continue;
    if (!reply.success || _mode_id >= 0)
      continue;  // refused: asked again later; a second yes is for a request sent twice
    _arming_check_id = reply.arming_check_id;
    _mode_id = reply.mode_id;
    _registered_us = hrt_absolute_time();
    configure_mode();
  }
}

/// Nothing of PX4's cascade runs in this mode: the module writes to the motors.
void PinnquadControl::configure_mode() {
  _configured_us = hrt_absolute_time();
#if PINNQUAD_PX4_SETPOINT_CONFIG
  setpoint_config_s config{};
  config.type = setpoint_config_s::TYPE_DIRECT_ACTUATORS;
  config.should_apply = _selected;  // of a mode that is not, PX4 only says whether it could
#else
  vehicle_control_mode_s config{};
  config.flag_control_termination_enabled = true;
#endif
  config.timestamp = _configured_us;
  config.source_id = static_cast<uint8_t>(_mode_id);
  _publications.configure.publish(config);
}

/// Again and again: both are topics without a queue.
void PinnquadControl::keep_configured(uint64_t now_us) {
#if PINNQUAD_PX4_SETPOINT_CONFIG
  setpoint_config_reply_s reply;
  while (_configured_sub.update(&reply)) {
    if (reply.source_id == static_cast<uint8_t>(_mode_id) && reply.timestamp >= _configured_us && _selected) {
      _configured = reply.result == setpoint_config_reply_s::RESULT_SUCCESS;
    }
  }
  if (_selected && !_configured && now_us - _configured_us > ask_again_us) configure_mode();
#else
  if (!_armed && now_us - _configured_us > configure_again_us) configure_mode();
#endif
}

bool PinnquadControl::parameters_fit() {
  const pinnquad_px4::OutOfRange wrong = pinnquad_px4::out_of_range(own_parameter);
  if (wrong.range == nullptr) return true;
  PX4_ERR("%s is %.3f: it must be within %.3f to %.3f", wrong.range->name, static_cast<double>(wrong.value),
          static_cast<double>(wrong.range->least), static_cast<double>(wrong.range->most));
  return false;
}

void PinnquadControl::check_parameters() {
  parameter_update_s update;
  if (_parameter_update_sub.update(&update)) {
    _parameters_to_check = true;
    if (pinnquad_px4::out_of_range(own_parameter).range == nullptr) {
      updateParams();  // what is read at start was: the core keeps it
      _source.speeds(stick_speeds());
    }
  }
  if (_parameters_to_check && !_armed) {  // in flight it would lose its mode
    _parameters_to_check = false;
    _fits = true;
    check_ranges();
    if (_fits) check_rotors();
    if (_fits) _refusal[0] = 0;
  }
  if (_refusal_to_say) mavlink_log_critical(&_ground_station, "%s", _refusal);
  _refusal_to_say = false;
}

void PinnquadControl::say_no_commands() {
  if (_said_no_commands) return;
  _said_no_commands = true;
  const auto stale = [this](uint8_t bit, const char* what) { return (_stale_inputs & bit) != 0 ? what : ""; };
  mavlink_log_critical(&_ground_station, "will not arm: no answer to fly by; too old:%s%s%s",
                       stale(pinnquad::autopilot::body_rates_bit, " body rates"),
                       stale(pinnquad::autopilot::attitude_bit, " attitude"),
                       stale(pinnquad::autopilot::local_bit, " position"));
}

void PinnquadControl::check_ranges() {
  const pinnquad_px4::OutOfRange wrong = pinnquad_px4::out_of_range(own_parameter);
  if (wrong.range == nullptr) return;
  refuse("will not arm: %s is %.3f, its range %.3f to %.3f", wrong.range->name, static_cast<double>(wrong.value),
         static_cast<double>(wrong.range->least), static_cast<double>(wrong.range->most));
}

template <class... Values>
void PinnquadControl::refuse(const char* format, Values... values) {
  char reason[sizeof _refusal];
  snprintf(reason, sizeof reason, format, values...);
  if (strcmp(reason, _refusal) != 0) _refusal_to_say = true;
  memcpy(_refusal, reason, sizeof _refusal);
  _fits = false;
}

void PinnquadControl::check_rotors() {
  pinnquad_px4::CaGeometry px4;
  px4.count = px4_parameter("CA_ROTOR_COUNT", int32_t{0});
  for (unsigned i = 0; i < pinnquad::rotor_count; ++i) {
    px4.rotors[i] = {ca_rotor(i, "PX"), ca_rotor(i, "PY"), ca_rotor(i, "KM")};
  }
  const auto& airframe = _core.controller().vehicle().airframe();
  const pinnquad_px4::GeometryCheck check = pinnquad_px4::check_geometry(px4, airframe);
  const unsigned rotor = static_cast<unsigned>(check.rotor);
  const auto& mount = airframe.rotors[check.rotor];
  switch (check.fault) {
    case pinnquad_px4::GeometryFault::count:
      refuse("will not arm: the model's airframe has %d rotors, CA_ROTOR_COUNT says %d",
             static_cast<int>(pinnquad::rotor_count), static_cast<int>(px4.count));
      break;
    case pinnquad_px4::GeometryFault::place:
      refuse("will not arm: CA_ROTOR%u_PX, _PY are %.3f, %.3f; the model's airframe has it at %.3f, %.3f m", rotor,
             static_cast<double>(px4.rotors[rotor].x), static_cast<double>(px4.rotors[rotor].y),
             static_cast<double>(mount.x_m), static_cast<double>(mount.y_m));
      break;
    case pinnquad_px4::GeometryFault::spin:
      refuse("will not arm: CA_ROTOR%u_KM is %.3f; on the model's airframe the rotor turns %sclockwise", rotor,
             static_cast<double>(px4.rotors[rotor].moment),
             mount.spin == pinnquad::Spin::counter_clockwise ? "counter-" : "");
      break;
    case pinnquad_px4::GeometryFault::none: break;
  }
}

void PinnquadControl::answer_arming_check() {
  arming_check_request_s request;
  if (!_arming_check_request_sub.update(&request)) return;
  arming_check_reply_s reply{};
  reply.timestamp = hrt_absolute_time();
  reply.request_id = request.request_id;
  reply.registration_id = static_cast<uint8_t>(_arming_check_id);
  reply.health_component_index = arming_check_reply_s::HEALTH_COMPONENT_INDEX_NONE;
  reply.can_arm_and_run = _core.ready() && _has_commands && _fits;
  reply.mode_req_angular_velocity = true;
  reply.mode_req_attitude = true;
  reply.mode_req_local_alt = true;
  reply.mode_req_local_position = true;
  _publications.arming_check_reply.publish(reply);
}

/// Sooner than the next arming check: without commands every tick counts. Again until the mode is another one.
void PinnquadControl::ask_for_takeover() {
  const bool position_stale = (_stale_inputs & pinnquad::autopilot::local_bit) != 0;
  vehicle_command_s command{};
  command.timestamp = hrt_absolute_time();
  command.command = vehicle_command_s::VEHICLE_CMD_SET_NAV_STATE;
  command.param1 = _takeover.ask(command.timestamp, _failsafe_flags, position_stale);
  command.source_component = static_cast<uint16_t>(vehicle_command_s::COMPONENT_MODE_EXECUTOR_START);
  if (command.timestamp - _asked_for_takeover_us < ask_again_us) return;
  _asked_for_takeover_us = command.timestamp;
  _publications.vehicle_command.publish(command);
}

void PinnquadControl::unregister_mode() {
  if (_mode_id < 0) return;
  unregister_ext_component_s message{};
  message.timestamp = hrt_absolute_time();
  strncpy(message.name, mode_name, sizeof message.name - 1);
  message.arming_check_id = _arming_check_id;
  message.mode_id = _mode_id;
  message.mode_executor_id = -1;
  _publications.unregister_mode.publish(message);
}

int PinnquadControl::task_spawn(int /*argc*/, char* /*argv*/[]) {
  if (!parameters_fit()) return PX4_ERROR;
  auto* module = new PinnquadControl();  // the only allocation, at start
  if (module != nullptr) {
    starts(module);
    if (module->init()) return PX4_OK;
    PX4_ERR("model refused: the mode is not registered");
  }
  delete module;
  starts(nullptr);
  return PX4_ERROR;
}

int PinnquadControl::custom_command(int argc, char* argv[]) {
  if (argc == 2 && strcmp(argv[0], "model") == 0) {
    if (!runs()) return print_usage("not running");
    return instance()->load_model(argv[1]) == pinnquad::Status::ok ? PX4_OK : PX4_ERROR;
  }
  return print_usage("unknown command");
}

int PinnquadControl::print_status() {
  PX4_INFO("mode %d, %s, %s%s%s", _mode_id, _selected ? "selected" : "not selected",
           _has_commands ? "has commands" : "has no commands", _fits ? "" : "; ", _refusal);
  return 0;
}

int PinnquadControl::print_usage(const char* reason) {
  if (reason != nullptr) PX4_WARN("%s", reason);
  PRINT_MODULE_DESCRIPTION(
      "Flies a quadrotor by a pinnquad model: attitude, body rates, position and set point to motors.");
  PRINT_MODULE_USAGE_NAME("pinnquad_control", "controller");
  PRINT_MODULE_USAGE_COMMAND("start");
  PRINT_MODULE_USAGE_COMMAND_DESCR("model", "Change the model, in flight too; argument: a file");
  PRINT_MODULE_USAGE_DEFAULT_COMMANDS();
  return 0;
}

extern "C" __EXPORT int pinnquad_control_main(int argc, char* argv[]) {
  if (argc > 1 && strcmp(argv[1], "stop") == 0 && PinnquadControl::flies()) {
    PX4_ERR("it has the motors: select another mode first");
    return PX4_ERROR;
  }
  return PinnquadControl::shell(argc, argv);
}
