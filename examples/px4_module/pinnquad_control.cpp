// SPDX-License-Identifier: MIT
// The glue between PX4 and neural_control_core.hpp. Not built in this repository; see README.md.
#include "pinnquad_control.hpp"

#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

namespace {

constexpr const char* mode_name = "Pinnquad";
constexpr const char* default_model = PX4_STORAGEDIR "/etc/pinnquad/model.block";
constexpr uint64_t request_id = 0x70696e6e;  // ours among the replies
constexpr uint32_t fallback_interval_us = 10'000;

uint64_t clock_us() { return hrt_absolute_time(); }

}  // namespace

PinnquadControl::PinnquadControl()
    : ModuleParams(nullptr),
      ScheduledWorkItem(MODULE_NAME, px4::wq_configurations::rate_ctrl),
      _core(&clock_us,
            {static_cast<uint64_t>(_param_age_rates.get()) * 1000,
             static_cast<uint64_t>(_param_age_attitude.get()) * 1000,
             static_cast<uint64_t>(_param_age_position.get()) * 1000,
             static_cast<uint64_t>(_param_age_setpoint.get()) * 1000},
            {_param_out_min.get(), 1.0f}) {}

pinnquad::Status PinnquadControl::load_model(const char* path) {
  if (!_core.model_settled()) return pinnquad::Status::out_of_range;  // the block to be written may still be read
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
  if (should_exit()) {
    _angular_velocity_sub.unregisterCallback();
    ScheduleClear();
    unregister_mode();
    exit_and_cleanup();
    return;
  }
  ScheduleDelayed(fallback_interval_us);  // body rates that stop would else stop the staleness check as well
  if (!_asked_to_register) {
    register_mode();
    return;
  }
  if (_mode_id < 0) {
    read_registration();
    return;
  }
  answer_arming_check();

  vehicle_status_s vehicle_status;
  if (_vehicle_status_sub.update(&vehicle_status)) _selected = vehicle_status.nav_state == _mode_id;

  take_samples();
  pinnquad_px4::ActuatorMotors motors;
  pinnquad_px4::PinnquadStatus status;
  const bool had_commands = _has_commands;
  _has_commands = _core.run(motors, status);  // selected or not: the status says whether it could fly
  if (_selected && _has_commands) publish(motors);
  if (_selected && had_commands && !_has_commands) ask_for_hold();
  publish(status);
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
    static_cast<void>(_core.take(sample));
  }
  trajectory_setpoint_s wanted;
  if (_trajectory_setpoint_sub.update(&wanted)) {
    pinnquad_px4::TrajectorySetpoint sample;
    sample.timestamp = wanted.timestamp;
    memcpy(sample.position, wanted.position, sizeof sample.position);
    memcpy(sample.velocity, wanted.velocity, sizeof sample.velocity);
    memcpy(sample.acceleration, wanted.acceleration, sizeof sample.acceleration);
    memcpy(sample.jerk, wanted.jerk, sizeof sample.jerk);
    sample.yaw = wanted.yaw;
    sample.yawspeed = wanted.yawspeed;
    static_cast<void>(_core.take(sample));
  }
}

void PinnquadControl::publish(const pinnquad_px4::ActuatorMotors& motors) {
  actuator_motors_s message{};
  message.timestamp = motors.timestamp;
  message.timestamp_sample = motors.timestamp_sample;
  for (float& control : message.control) control = NAN;
  for (int i = 0; i < 4; ++i) message.control[i] = motors.control[i];
  _actuator_motors_pub.publish(message);
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
  _status_pub.publish(message);
}

void PinnquadControl::register_mode() {
  register_ext_component_request_s request{};
  request.timestamp = hrt_absolute_time();
  request.request_id = request_id;
  strncpy(request.name, mode_name, sizeof request.name - 1);
  request.px4_ros2_api_version = register_ext_component_request_s::LATEST_PX4_ROS2_API_VERSION;
  request.register_arming_check = true;
  request.register_mode = true;
  _register_pub.publish(request);
  _asked_to_register = true;
}

void PinnquadControl::read_registration() {
  register_ext_component_reply_s reply;
  while (_register_reply_sub.update(&reply)) {
    if (reply.request_id != request_id || !reply.success) continue;
    _arming_check_id = reply.arming_check_id;
    _mode_id = reply.mode_id;
    vehicle_control_mode_s config{};  // nothing of PX4's cascade runs: the module writes to the motors
    config.timestamp = hrt_absolute_time();
    config.source_id = static_cast<uint8_t>(_mode_id);
    config.flag_control_termination_enabled = true;
    _config_control_setpoints_pub.publish(config);
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
  reply.can_arm_and_run = _core.ready() && _has_commands;
  reply.mode_req_angular_velocity = true;
  reply.mode_req_attitude = true;
  reply.mode_req_local_alt = true;
  reply.mode_req_local_position = true;
  _arming_check_reply_pub.publish(reply);
}

/// Sooner than the next arming check: without commands every tick counts. PX4 itself goes on from there.
void PinnquadControl::ask_for_hold() {
  vehicle_command_s command{};
  command.timestamp = hrt_absolute_time();
  command.command = vehicle_command_s::VEHICLE_CMD_SET_NAV_STATE;
  command.param1 = vehicle_status_s::NAVIGATION_STATE_AUTO_LOITER;
  command.source_component = static_cast<uint16_t>(vehicle_command_s::COMPONENT_MODE_EXECUTOR_START);
  _vehicle_command_pub.publish(command);
}

void PinnquadControl::unregister_mode() {
  if (_mode_id < 0) return;
  unregister_ext_component_s message{};
  message.timestamp = hrt_absolute_time();
  strncpy(message.name, mode_name, sizeof message.name - 1);
  message.arming_check_id = _arming_check_id;
  message.mode_id = _mode_id;
  _unregister_pub.publish(message);
}

int PinnquadControl::task_spawn(int /*argc*/, char* /*argv*/[]) {
  auto* instance = new PinnquadControl();  // the only allocation, at start
  if (instance != nullptr) {
    _object.store(instance);
    _task_id = task_id_is_work_queue;
    if (instance->init()) return PX4_OK;
    PX4_ERR("model refused: the mode is not registered");
  }
  delete instance;
  _object.store(nullptr);
  _task_id = -1;
  return PX4_ERROR;
}

int PinnquadControl::custom_command(int argc, char* argv[]) {
  if (argc == 2 && strcmp(argv[0], "model") == 0) {
    if (!is_running()) return print_usage("not running");
    return get_instance()->load_model(argv[1]) == pinnquad::Status::ok ? PX4_OK : PX4_ERROR;
  }
  return print_usage("unknown command");
}

int PinnquadControl::print_status() {
  PX4_INFO("mode %d, %s, %s", _mode_id, _selected ? "selected" : "not selected",
           _has_commands ? "has commands" : "has no commands");
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

extern "C" __EXPORT int pinnquad_control_main(int argc, char* argv[]) { return PinnquadControl::main(argc, argv); }
