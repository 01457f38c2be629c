// SPDX-License-Identifier: MIT
// The glue between PX4 and neural_control_core.hpp: topics, parameters, mode registration, the model's file. Compiled
// and run here against a small uORB of ours (tests/flight_stacks/px4); see README.md.
#pragma once

#include <drivers/drv_hrt.h>
#include <parameters/param.h>
#include <px4_platform_common/log.h>
#include <px4_platform_common/module_params.h>
#include <systemlib/mavlink_log.h>
#include <px4_platform_common/px4_work_queue/ScheduledWorkItem.hpp>

#include <uORB/topics/actuator_motors.h>
#include <uORB/topics/arming_check_reply.h>
#include <uORB/topics/arming_check_request.h>
#include <uORB/topics/battery_status.h>
#include <uORB/topics/failsafe_flags.h>
#include <uORB/topics/goto_setpoint.h>
#include <uORB/topics/manual_control_setpoint.h>
#include <uORB/topics/parameter_update.h>
#include <uORB/topics/pinnquad_record.h>
#include <uORB/topics/pinnquad_settings.h>
#include <uORB/topics/pinnquad_status.h>
#include <uORB/topics/register_ext_component_reply.h>
#include <uORB/topics/register_ext_component_request.h>
#include <uORB/topics/trajectory_setpoint.h>
#include <uORB/topics/unregister_ext_component.h>
#include <uORB/topics/vehicle_angular_velocity.h>
#include <uORB/topics/vehicle_attitude.h>
#include <uORB/topics/vehicle_command.h>
#include <uORB/topics/vehicle_land_detected.h>
#include <uORB/topics/vehicle_local_position.h>
#include <uORB/topics/vehicle_status.h>
#include <uORB/topics/vehicle_thrust_setpoint.h>
#include <uORB/topics/vehicle_torque_setpoint.h>
#include <uORB/Publication.hpp>
#include <uORB/Subscription.hpp>
#include <uORB/SubscriptionCallback.hpp>

#include "model.hpp"  // the exported header: what pinnquad train wrote
#include "neural_control_core.hpp"
#include "parameter_ranges.hpp"
#include "pinnquad/control/autopilot/recorded_controller.hpp"
#include "px4_version.hpp"
#include "rotor_geometry.hpp"
#include "set_point_source.hpp"
#include "takeover.hpp"

// Beside model.hpp there may be a header with the analytic inverse's effects: using FlownVehicle =
// pinnquad::Quadrotor<float, ...>. CMakeLists.txt says whether there is: a compiler's cache does not look for files
// that were not there.
#if PINNQUAD_FLOWN_VEHICLE
#include "flown_vehicle.hpp"
#else
using FlownVehicle = pinnquad::Quadrotor<float, pinnquad::QuadraticDrag>;
#endif

// And one that says when the model is not to be trusted, as pinnquad train writes it.
#if PINNQUAD_TRUST
#include "trust.hpp"
using FlownLimits = TrainedQuadModelTrust;
#else
using FlownLimits = void;  // without limits of trust
#endif

class PinnquadControl : public pinnquad_px4::ShellModule<PinnquadControl>,
                        public ModuleParams,
                        public px4::ScheduledWorkItem {
 public:
  PinnquadControl();
  ~PinnquadControl() override = default;

  static int task_spawn(int argc, char* argv[]);
  static int custom_command(int argc, char* argv[]);
  static int print_usage(const char* reason = nullptr);
  int print_status() override;

  /// False, and nothing is registered, if the model was refused.
  bool init();
  /// False, and one line says which, if a parameter is beyond its range.
  static bool parameters_fit();

  /// True while the motors of an armed vehicle are this module's: it must not be stopped then.
  static bool flies();

 private:
  using Model = TrainedQuadModel;
  using Controller = pinnquad::autopilot::Recorded<pinnquad::autopilot::NeuralController<
      Model, pinnquad::ModelView<Model>, FlownVehicle, FlownLimits, pinnquad::OnboardInverse<float>>>;
  using Core = pinnquad_px4::NeuralControl<Model, Controller>;

  /// Room for one block of this model with the eight golden vectors that `pinnquad train` writes.
  static constexpr size_t block_bytes =
      pinnquad::ModelBlockLayout<Model>::length(8) + pinnquad::ModelBlockLayout<Model>::most_record_bytes();

  void Run() override;
  pinnquad::autopilot::CoreSettings controller_settings() const;
  pinnquad_px4::StickSpeeds stick_speeds() const;
  /// Reads, opens and tests a model; the one that flies stays where it is. Of the shell's thread.
  pinnquad::Status load_model(const char* path);
  /// The motors' owner, the land detector, and the needs of other modes.
  void read_vehicle();
  /// Registers the mode, and again until PX4 says yes; once more if it has dropped it.
  void keep_registered();
  void read_registration();
  void configure_mode();
  void keep_configured(uint64_t now_us);
  /// After each change of a parameter: what may change in flight changes, if all are within their ranges. While it may
  /// not fly, whether they are, and whether PX4's rotors are the model's.
  void check_parameters();
  void check_ranges();
  void check_rotors();
  /// Why it may not be armed: for the log and the ground station, once, and again when the mode is selected.
  template <class... Values>
  void refuse(const char* format, Values... values);
  void say_no_commands();
  void answer_arming_check();
  void take_samples();
  /// The set point of whoever asks for one: a trajectory, a place, the sticks.
  void take_set_point();
  void publish(const pinnquad_px4::ActuatorMotors& motors);
  void publish_stopped();
  void publish(const pinnquad_px4::PinnquadStatus& status);
  /// The record of this tick, for pinnquad replay.
  void publish_record();
  /// The settings, where a log that begins later finds them too.
  void publish_settings();
  void ask_for_takeover();
  void unregister_mode();

  uORB::SubscriptionCallbackWorkItem _angular_velocity_sub{this, ORB_ID(vehicle_angular_velocity)};
  uORB::Subscription _attitude_sub{ORB_ID(vehicle_attitude)};
  uORB::Subscription _local_position_sub{ORB_ID(vehicle_local_position)};
  uORB::Subscription _trajectory_setpoint_sub{ORB_ID(trajectory_setpoint)};
  uORB::Subscription _goto_setpoint_sub{ORB_ID(goto_setpoint)};
  uORB::Subscription _manual_control_sub{ORB_ID(manual_control_setpoint)};
  uORB::Subscription _vehicle_status_sub{ORB_ID(vehicle_status)};
  uORB::Subscription _land_detected_sub{ORB_ID(vehicle_land_detected)};
  uORB::Subscription _failsafe_flags_sub{ORB_ID(failsafe_flags)};
  uORB::Subscription _arming_check_request_sub{ORB_ID(arming_check_request)};
  uORB::Subscription _register_reply_sub{ORB_ID(register_ext_component_reply)};
  uORB::Subscription _battery_sub{ORB_ID(battery_status)};
  uORB::Subscription _parameter_update_sub{ORB_ID(parameter_update)};
#if PINNQUAD_PX4_SETPOINT_CONFIG
  uORB::Subscription _configured_sub{ORB_ID(setpoint_config_reply)};
#endif

  /// Outlive the module and are never destroyed: a destroyed publication takes its topic from under its readers. The
  /// motors' outputs would freeze, and the commander would not hear that the mode is unregistered.
  struct Publications {
    uORB::Publication<actuator_motors_s> actuator_motors{ORB_ID(actuator_motors)};
    uORB::Publication<vehicle_thrust_setpoint_s> thrust{ORB_ID(vehicle_thrust_setpoint)};
    uORB::Publication<vehicle_torque_setpoint_s> torque{ORB_ID(vehicle_torque_setpoint)};
    uORB::Publication<pinnquad_status_s> status{ORB_ID(pinnquad_status)};
    uORB::Publication<pinnquad_record_s> record{ORB_ID(pinnquad_record)};
    uORB::Publication<pinnquad_settings_s> settings{ORB_ID(pinnquad_settings)};
    uORB::Publication<register_ext_component_request_s> register_mode{ORB_ID(register_ext_component_request)};
    uORB::Publication<unregister_ext_component_s> unregister_mode{ORB_ID(unregister_ext_component)};
    uORB::Publication<arming_check_reply_s> arming_check_reply{ORB_ID(arming_check_reply)};
    uORB::Publication<vehicle_command_s> vehicle_command{ORB_ID(vehicle_command)};
#if PINNQUAD_PX4_SETPOINT_CONFIG
    uORB::Publication<setpoint_config_s> configure{ORB_ID(setpoint_config)};
#else
    uORB::Publication<vehicle_control_mode_s> configure{ORB_ID(config_control_setpoints)};
#endif
  };
  static Publications* publications();

  // before the core, which is made of them
  DEFINE_PARAMETERS(
      (ParamFloat<px4::params::PQ_OUT_MIN>)_param_out_min, (ParamInt<px4::params::PQ_AGE_RATES>)_param_age_rates,
      (ParamInt<px4::params::PQ_AGE_ATT>)_param_age_attitude, (ParamInt<px4::params::PQ_AGE_POS>)_param_age_position,
      (ParamInt<px4::params::PQ_AGE_SP>)_param_age_setpoint, (ParamFloat<px4::params::PQ_G_POS>)_param_gain_position,
      (ParamFloat<px4::params::PQ_G_VEL>)_param_gain_velocity, (ParamFloat<px4::params::PQ_G_TILT>)_param_gain_tilt,
      (ParamFloat<px4::params::PQ_G_YAW>)_param_gain_yaw, (ParamFloat<px4::params::PQ_G_RATE>)_param_gain_rate,
      (ParamFloat<px4::params::PQ_G_YAWRATE>)_param_gain_yaw_rate,
      (ParamFloat<px4::params::PQ_V_XY>)_param_speed_horizontal, (ParamFloat<px4::params::PQ_V_UP>)_param_speed_up,
      (ParamFloat<px4::params::PQ_V_DN>)_param_speed_down, (ParamFloat<px4::params::PQ_TKO_T>)_param_take_off,
      (ParamFloat<px4::params::PQ_BIAS_T>)_param_bias_thrust,
      (ParamFloat<px4::params::PQ_BIAS_T_ROT>)_param_bias_rotation,
      (ParamFloat<px4::params::PQ_BIAS_MAX>)_param_bias_most, (ParamFloat<px4::params::PQ_BIAS_ACC>)_param_bias_across,
      (ParamFloat<px4::params::PQ_BIAS_DELAY>)_param_bias_delay, (ParamInt<px4::params::PQ_RECORD>)_param_record,
      (ParamInt<px4::params::PQ_ONBOARD>)_param_onboard, (ParamFloat<px4::params::PQ_STK_XY>)_param_stick_horizontal,
      (ParamFloat<px4::params::PQ_STK_Z>)_param_stick_vertical, (ParamFloat<px4::params::PQ_STK_YAW>)_param_stick_yaw,
      (ParamFloat<px4::params::PQ_AIR_RHO>)_param_air_density, (ParamFloat<px4::params::PQ_THR_CURVE>)_param_curve,
      (ParamInt<px4::params::PQ_BAT_SCALE>)_param_battery_scale)

  const pinnquad_px4::Propulsion _propulsion;

  Core _core;
  struct alignas(pinnquad::model_block_alignment) Block {
    unsigned char bytes[block_bytes];
  };
  Block _blocks[2]{};  ///< the core's model looks into one of them
  int _next_block{0};

  Publications& _publications{*publications()};
  pinnquad_px4::FailsafeFlags _failsafe_flags{};
  pinnquad_px4::Takeover _takeover{};
  pinnquad_px4::SetPointSource _source;
  pinnquad::Heading<float> _heading{};
  float _velocity_m_s[3]{};
  uint64_t _asked_to_register_us{0};
  uint64_t _request_id{0};
  uint64_t _configured_us{0};
  uint64_t _registered_us{0};
  uint64_t _asked_for_takeover_us{0};
  uint64_t _settings_us{0};
  uint64_t _ran_us{0};
  uint8_t _stale_inputs{0};  ///< of the last step, as bits
  uint32_t _valid_modes{0};  ///< as bits by nav_state
  bool _armed{false};
  bool _landed{false};
  bool _selected{false};
  bool _parameters_to_check{true};
  bool _fits{false};     ///< parameters and rotors
  char _refusal[120]{};  ///< why not
  bool _refusal_to_say{false};
  bool _said_no_commands{false};
  orb_advert_t _ground_station{nullptr};
  bool _configured{false};   ///< PX4 has said so since the mode was selected
  bool _has_commands{true};  ///< the next arming check's answer
  int8_t _arming_check_id{-1};
  int8_t _mode_id{-1};
};
