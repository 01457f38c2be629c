// SPDX-License-Identifier: MIT
// The glue between PX4 and neural_control_core.hpp: topics, parameters, mode registration, the model's file.
// Not built in this repository; see README.md.
#pragma once

#include <drivers/drv_hrt.h>
#include <px4_platform_common/log.h>
#include <px4_platform_common/module.h>
#include <px4_platform_common/module_params.h>
#include <px4_platform_common/px4_work_queue/ScheduledWorkItem.hpp>

#include <uORB/topics/actuator_motors.h>
#include <uORB/topics/arming_check_reply.h>
#include <uORB/topics/arming_check_request.h>
#include <uORB/topics/pinnquad_status.h>
#include <uORB/topics/register_ext_component_reply.h>
#include <uORB/topics/register_ext_component_request.h>
#include <uORB/topics/trajectory_setpoint.h>
#include <uORB/topics/unregister_ext_component.h>
#include <uORB/topics/vehicle_angular_velocity.h>
#include <uORB/topics/vehicle_attitude.h>
#include <uORB/topics/vehicle_command.h>
#include <uORB/topics/vehicle_control_mode.h>
#include <uORB/topics/vehicle_local_position.h>
#include <uORB/topics/vehicle_status.h>
#include <uORB/Publication.hpp>
#include <uORB/Subscription.hpp>
#include <uORB/SubscriptionCallback.hpp>

#include "model.hpp"  // the exported header: what pinnquad train wrote
#include "neural_control_core.hpp"

class PinnquadControl : public ModuleBase<PinnquadControl>, public ModuleParams, public px4::ScheduledWorkItem {
 public:
  PinnquadControl();
  ~PinnquadControl() override = default;

  static int task_spawn(int argc, char* argv[]);
  static int custom_command(int argc, char* argv[]);
  static int print_usage(const char* reason = nullptr);
  int print_status() override;

  /// False, and nothing is registered, if the model was refused.
  bool init();

 private:
  using Model = TrainedQuadModel;
  using Core = pinnquad_px4::NeuralControl<Model>;

  /// Room for one block of this model, golden vectors included.
  static constexpr size_t block_bytes = pinnquad::ModelBlockLayout<Model>::length(pinnquad::loaded_golden_vectors) +
                                        pinnquad::ModelBlockLayout<Model>::most_record_bytes();

  void Run() override;
  /// Reads, opens and tests a model; the one that flies stays where it is. Of the shell's thread.
  pinnquad::Status load_model(const char* path);
  void register_mode();
  void read_registration();
  void answer_arming_check();
  void take_samples();
  void publish(const pinnquad_px4::ActuatorMotors& motors);
  void publish(const pinnquad_px4::PinnquadStatus& status);
  void ask_for_hold();
  void unregister_mode();

  uORB::SubscriptionCallbackWorkItem _angular_velocity_sub{this, ORB_ID(vehicle_angular_velocity)};
  uORB::Subscription _attitude_sub{ORB_ID(vehicle_attitude)};
  uORB::Subscription _local_position_sub{ORB_ID(vehicle_local_position)};
  uORB::Subscription _trajectory_setpoint_sub{ORB_ID(trajectory_setpoint)};
  uORB::Subscription _vehicle_status_sub{ORB_ID(vehicle_status)};
  uORB::Subscription _arming_check_request_sub{ORB_ID(arming_check_request)};
  uORB::Subscription _register_reply_sub{ORB_ID(register_ext_component_reply)};

  uORB::Publication<actuator_motors_s> _actuator_motors_pub{ORB_ID(actuator_motors)};
  uORB::Publication<pinnquad_status_s> _status_pub{ORB_ID(pinnquad_status)};
  uORB::Publication<register_ext_component_request_s> _register_pub{ORB_ID(register_ext_component_request)};
  uORB::Publication<unregister_ext_component_s> _unregister_pub{ORB_ID(unregister_ext_component)};
  uORB::Publication<arming_check_reply_s> _arming_check_reply_pub{ORB_ID(arming_check_reply)};
  uORB::Publication<vehicle_command_s> _vehicle_command_pub{ORB_ID(vehicle_command)};
  uORB::Publication<vehicle_control_mode_s> _config_control_setpoints_pub{ORB_ID(config_control_setpoints)};

  // before the core, which is made of them
  DEFINE_PARAMETERS((ParamFloat<px4::params::PQ_OUT_MIN>)_param_out_min,
                    (ParamInt<px4::params::PQ_AGE_RATES>)_param_age_rates,
                    (ParamInt<px4::params::PQ_AGE_ATT>)_param_age_attitude,
                    (ParamInt<px4::params::PQ_AGE_POS>)_param_age_position,
                    (ParamInt<px4::params::PQ_AGE_SP>)_param_age_setpoint)

  Core _core;
  struct alignas(pinnquad::model_block_alignment) Block {
    unsigned char bytes[block_bytes];
  };
  Block _blocks[2]{};  ///< the core's model looks into one of them
  int _next_block{0};

  bool _asked_to_register{false};
  bool _selected{false};
  bool _has_commands{true};  ///< what the next arming check is told
  int8_t _arming_check_id{-1};
  int8_t _mode_id{-1};
};
