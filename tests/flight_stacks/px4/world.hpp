// SPDX-License-Identifier: MIT
// PX4 around its module, in steps of 1 ms: estimators, a commander that registers, unregisters, checks and changes
// modes, the allocator that has the motors in PX4's own modes.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <model.hpp>  // the one that the module is built with
#include "land_detector.hpp"
#include "model_blocks.hpp"
#include "px4.hpp"
#include "px4_module/px4_version.hpp"

extern "C" int pinnquad_control_main(int argc, char* argv[]);

namespace pinnquad::autopilot::test {

/// By name, as module.yaml has them.
inline std::map<std::string, double>& parameter_bounds(const char* which) {
  static std::map<std::string, std::map<std::string, double>> all;
  return all[which];
}

/// Name, type, default and range of each parameter of module.yaml.
inline void read_parameters() {
  std::ifstream file(std::string(PINNQUAD_PX4_MODULE) + "/module.yaml");
  REQUIRE(file.good());
  std::string name;
  px4::parameter_values().clear();
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key.rfind("PQ_", 0) == 0 && key.back() == ':') name = key.substr(0, key.size() - 1);
    double value = 0;
    std::string type;
    if (key == "type:" && words >> type && type != "float") px4::whole_parameters().insert(name);
    if (key == "default:" && words >> value) px4::parameter_values()[name] = value;
    if (key == "reboot_required:") parameter_bounds(key.c_str())[name] = 1;
    if ((key == "min:" || key == "max:") && words >> value) parameter_bounds(key.c_str())[name] = value;
  }
}

/// CA_ROTOR* of an airframe, scaled as many of PX4's own are; its propulsion as the model's.
inline void set_px4_airframe(const pinnquad::Airframe<double>& airframe, double scale = 1) {
  auto& values = px4::parameter_values();
  values["CA_ROTOR_COUNT"] = 4;
  values["THR_MDL_FAC"] = 0;
  for (std::size_t i = 0; i < airframe.rotors.size(); ++i) {
    const std::string rotor = "CA_ROTOR" + std::to_string(i);
    values[rotor + "_PX"] = scale * airframe.rotors[i].x_m;
    values[rotor + "_PY"] = scale * airframe.rotors[i].y_m;
    values[rotor + "_KM"] = airframe.rotors[i].spin == pinnquad::Spin::counter_clockwise ? 0.05 : -0.05;
  }
}

inline int shell(const char* command) {
  std::string text = command;
  char name[] = "pinnquad_control";
  char* arguments[] = {name, text.data()};
  return pinnquad_control_main(2, arguments);
}

/// PX4 around the module, in steps of 1 ms.
class Px4World {
 public:
  static constexpr uint8_t hold = vehicle_status_s::NAVIGATION_STATE_AUTO_LOITER,
                           altitude = vehicle_status_s::NAVIGATION_STATE_ALTCTL,
                           descend = vehicle_status_s::NAVIGATION_STATE_DESCEND;

  Px4World() {
    uORB::forget_messages();
    World::now_us = 5'000'000;
    World::sleep_ms = [this](int ms) { run(ms); };
    read_parameters();
    set_px4_airframe(pinnquad::airframe_value<TrainedQuadModel::Vehicle, double>());
    px4::complaints().clear();
    px4::ground_station().clear();
    const Block block = sound_block<TrainedQuadModel>();
    REQUIRE(std::system("mkdir -p etc/pinnquad") == 0);
    std::ofstream("etc/pinnquad/model.block", std::ios::binary)
        .write(reinterpret_cast<const char*>(block.data()), static_cast<std::streamsize>(block.size()));
    local.xy_valid = local.z_valid = local.v_xy_valid = local.v_z_valid = true;
    set_point.yaw = std::numeric_limits<float>::quiet_NaN();
    flags.mode_req_local_position = 1u << hold | 1u << vehicle_status_s::NAVIGATION_STATE_POSCTL;
    flags.mode_req_local_alt = flags.mode_req_local_position | 1u << altitude;
    flags.mode_req_attitude = flags.mode_req_local_alt | 1u << descend;
    flags.mode_req_manual_control = 1u << altitude | 1u << vehicle_status_s::NAVIGATION_STATE_POSCTL;
  }
  ~Px4World() {
    armed = false;
    nav_state = hold;
    run(100);
    static_cast<void>(shell("stop"));
    World::sleep_ms = nullptr;
  }

  float height_m() const { return -local.z + drift_m; }
  static constexpr uint64_t disarm_after_us = 2'000'000;  ///< COM_DISARM_LAND

  /// Registered, selected, armed, in the air.
  void fly() {
    run(1500);
    REQUIRE(mode_id >= 0);
    nav_state = static_cast<uint8_t>(mode_id);
    armed = true;
    run(200);
    REQUIRE(by_module > 100);
  }

  void start_and_fly() {
    REQUIRE(shell("start") == PX4_OK);
    fly();
  }

  /// A parameter, and that it changed.
  void set(const char* name, double value) {
    px4::parameter_values()[name] = value;
    update_pub.publish(parameter_update_s{});
  }
  /// The record of the last step that the module published.
  pinnquad_record_s record() {
    pinnquad_record_s last_record{};
    REQUIRE(record_sub.copy(&last_record));
    return last_record;
  }

  void run(int ms) {
    for (int i = 0; i < ms; ++i) {
      World::now_us += 1000;
      const uint64_t now = World::now_us;
      if (sends_sticks && now % 10'000 == 0) {
        sticks.timestamp = now;
        sticks_pub.publish(sticks);
      }
      if (moves) move();
      if (!attitude_stops && now % 4000 == 0) {
        vehicle_attitude_s m{};
        m.timestamp = m.timestamp_sample = now - 1000;
        m.q[0] = std::cos(yaw / 2), m.q[3] = std::sin(yaw / 2);
        attitude_pub.publish(m);
      }
      if (!local_stops && now % 10'000 == 0) {
        local.timestamp = local.timestamp_sample = now - 1000;
        local_pub.publish(local);
      }
      if (detects) {
        landed = detector_.update(now, armed, local, range_finder ? height_m() : -1);
        disarm_us_ = armed && landed && was_up_ ? disarm_us_ : now;
        if (now - disarm_us_ >= disarm_after_us) armed = false;
        was_up_ = armed && (was_up_ || !landed);
      }
      if (now % 20'000 == 0) {
        set_point.timestamp = now;
        if (sends_set_points) set_point_pub.publish(set_point);
        vehicle_land_detected_s land{};
        land.landed = landed;
        land_pub.publish(land);
        flags.timestamp = now;
        flags_pub.publish(flags);
      }
      if (now % 10'000 == 0) commander();
      vehicle_angular_velocity_s rates{};
      rates.timestamp = now;
      rates.timestamp_sample = gyro_sample_us = now - 300;
      rates_pub.publish(rates);
      px4::ScheduledWorkItem::run_pending();
      if (allocates()) allocator_pub.publish(actuator_motors_s{});
      actuator_motors_s motors;
      while (motors_sub.update(&motors)) {
        const uint64_t gap = now - motors_us;
        if (armed && gap > longest_gap_us) longest_gap_us = gap;
        motors_us = now;
        if (motors.timestamp == 0) {
          if (nav_state >= vehicle_status_s::NAVIGATION_STATE_EXTERNAL1) ++by_others;
        } else {
          last = motors, ++by_module;
        }
        lasting_ = motors;
      }
    }
  }

  // what the world is like
  bool armed = false, landed = false, deaf = false, refuses = false, attitude_stops = false, local_stops = false,
       sends_set_points = true;
  uint8_t nav_state = hold;
  float yaw = 0;
  vehicle_local_position_s local{};
  trajectory_setpoint_s set_point{};
  failsafe_flags_s flags{};
  manual_control_setpoint_s sticks{};
  bool sends_sticks = false;
  bool moves = false;         ///< up and down, as the motors say, over a ground
  bool detects = false;       ///< PX4's land detector says what is landed, its commander disarms after
  bool range_finder = false;  ///< that sees the height
  double stronger = 1;        ///< the motors' thrust over what the model's airframe says
  float drift_m = 0;          ///< height above what the estimate says
  // what came of it
  int mode_id = -1, registrations = 0, unregistrations = 0, by_module = 0;
  int by_others = 0;  ///< motor commands of PX4 while the module's mode is selected
  std::vector<uint8_t> asked_for;
  actuator_motors_s last{};
  uint64_t longest_gap_us = 0, motors_us = 0, gyro_sample_us = 0;
  bool can_arm = false;
  bool configured = false;  ///< the mode, so that nothing of PX4 writes to the motors while it is selected

 private:
  /// One millisecond of a point mass over its four rotors, which lag by 50 ms.
  void move() {
    const auto airframe = pinnquad::airframe_value<TrainedQuadModel::Vehicle, double>();
    constexpr double step_s = 1e-3, lag_s = 0.05, gravity = 9.80665;
    double thrust = 0;
    for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
      const double wanted = armed && lasting_.timestamp != 0 ? static_cast<double>(lasting_.control[i]) : 0;
      turning_[i] += step_s / lag_s * (wanted - turning_[i]);
      thrust += stronger * turning_[i] * airframe.rotors[i].thrust_scale * airframe.max_rotor_thrust_N();
    }
    double fall = gravity - thrust / airframe.mass_kg;
    if (height_m() <= 0 && fall > 0) fall = 0, sink_m_s_ = sink_m_s_ > 0 ? 0 : sink_m_s_;
    sink_m_s_ += step_s * fall;
    local.z += static_cast<float>(step_s * sink_m_s_);
    local.vz = static_cast<float>(sink_m_s_);
  }

  LandDetector detector_;
  bool was_up_ = false;
  uint64_t disarm_us_ = 0;
  actuator_motors_s lasting_{};
  double turning_[4]{}, sink_m_s_ = 0;

#if PINNQUAD_PX4_SETPOINT_CONFIG
  /// Holds for the mode that is selected, and is gone with it.
  void take_configuration() {
    if (nav_state != mode_id) configured = false;
    setpoint_config_s wanted;
    while (config_sub.update(&wanted)) {
      if (wanted.source_id != mode_id) continue;
      setpoint_config_reply_s answer{};
      answer.timestamp = World::now_us;
      answer.type = wanted.type;
      answer.source_id = wanted.source_id;
      answer.result = setpoint_config_reply_s::RESULT_SUCCESS;
      if (wanted.should_apply && nav_state == mode_id) {
        configured = wanted.type == setpoint_config_s::TYPE_DIRECT_ACTUATORS;
      }
      config_reply_pub.publish(answer);
    }
  }
  uORB::Publication<setpoint_config_reply_s> config_reply_pub{ORB_ID(setpoint_config_reply)};
  uORB::Subscription config_sub{ORB_ID(setpoint_config)};
#else
  /// Kept for each mode, selected or not.
  void take_configuration() {
    vehicle_control_mode_s wanted;
    while (config_sub.update(&wanted)) {
      if (wanted.source_id == mode_id) {
        configured = wanted.flag_control_termination_enabled && !wanted.flag_control_allocation_enabled;
      }
    }
  }
  uORB::Subscription config_sub{ORB_ID(config_control_setpoints)};
#endif
  bool allocates() const { return nav_state < vehicle_status_s::NAVIGATION_STATE_EXTERNAL1 || !configured; }

  /// As PX4's: nobody is registered or unregistered while it is armed, and no mode is entered whose needs are not met.
  void commander() {
    if (!deaf) {
      register_ext_component_request_s request;
      while (request_sub.update(&request)) {
        register_ext_component_reply_s reply{};
        std::memcpy(reply.name, request.name, sizeof reply.name);
        reply.request_id = request.request_id;
        reply.success = !armed && !refuses;
        reply.mode_id = reply.arming_check_id = -1;
        if (reply.success) {
          ++registrations;
          mode_id = vehicle_status_s::NAVIGATION_STATE_EXTERNAL1;
          reply.mode_id = static_cast<int8_t>(mode_id);
          reply.arming_check_id = 1;
        }
        reply_pub.publish(reply);
      }
      unregister_ext_component_s gone;
      while (!armed && unregister_sub.update(&gone)) {
        ++unregistrations;
        if (gone.mode_id == nav_state) nav_state = hold;
        if (gone.mode_id == mode_id) mode_id = -1;
      }
      vehicle_command_s command;
      while (command_sub.update(&command)) {
        const auto wanted = static_cast<uint8_t>(command.param1);
        asked_for.push_back(wanted);
        const auto needs = [wanted](uint32_t mask) { return (mask >> wanted & 1u) != 0; };
        const bool missing = (needs(flags.mode_req_local_position) && (flags.local_position_invalid || lies)) ||
                             (needs(flags.mode_req_local_alt) && flags.local_altitude_invalid) ||
                             (needs(flags.mode_req_manual_control) && flags.manual_control_signal_lost);
        if (!missing) nav_state = wanted;
      }
      take_configuration();
      arming_check_reply_s check;
      while (check_sub.update(&check)) can_arm = check.can_arm_and_run;
      if (World::now_us % 300'000 == 0) check_pub.publish(arming_check_request_s{});
    }
    vehicle_status_s status{};
    status.timestamp = World::now_us;
    status.nav_state = nav_state;
    status.arming_state = armed ? vehicle_status_s::ARMING_STATE_ARMED : vehicle_status_s::ARMING_STATE_DISARMED;
    status.valid_nav_states_mask = mode_id >= 0 ? 1u << mode_id : 0u;
    status_pub.publish(status);
  }

 public:
  bool lies = false;  ///< PX4's flags say that there is a position, its commander knows better

 private:
  uORB::Publication<vehicle_angular_velocity_s> rates_pub{ORB_ID(vehicle_angular_velocity)};
  uORB::Publication<vehicle_attitude_s> attitude_pub{ORB_ID(vehicle_attitude)};
  uORB::Publication<vehicle_local_position_s> local_pub{ORB_ID(vehicle_local_position)};
  uORB::Publication<trajectory_setpoint_s> set_point_pub{ORB_ID(trajectory_setpoint)};
  uORB::Publication<vehicle_land_detected_s> land_pub{ORB_ID(vehicle_land_detected)};
  uORB::Publication<parameter_update_s> update_pub{ORB_ID(parameter_update)};
  uORB::Publication<manual_control_setpoint_s> sticks_pub{ORB_ID(manual_control_setpoint)};
  uORB::Subscription record_sub{ORB_ID(pinnquad_record)};
  uORB::Publication<failsafe_flags_s> flags_pub{ORB_ID(failsafe_flags)};
  uORB::Publication<vehicle_status_s> status_pub{ORB_ID(vehicle_status)};
  uORB::Publication<register_ext_component_reply_s> reply_pub{ORB_ID(register_ext_component_reply)};
  uORB::Publication<arming_check_request_s> check_pub{ORB_ID(arming_check_request)};
  uORB::Publication<actuator_motors_s> allocator_pub{ORB_ID(actuator_motors)};
  uORB::Subscription request_sub{ORB_ID(register_ext_component_request)},
      unregister_sub{ORB_ID(unregister_ext_component)}, command_sub{ORB_ID(vehicle_command)},
      check_sub{ORB_ID(arming_check_reply)}, motors_sub{ORB_ID(actuator_motors)};
};

}  // namespace pinnquad::autopilot::test
