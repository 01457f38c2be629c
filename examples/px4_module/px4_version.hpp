// SPDX-License-Identifier: MIT
// Where PX4's branches differ. v1.16: ModuleBase is a template of the module, a mode is configured by a
// vehicle_control_mode on config_control_setpoints. Later: ModuleBase is a class with a descriptor of each module, a
// mode asks for a kind of set point by setpoint_config.
#pragma once

#include <px4_platform_common/module.h>

#if __has_include(<uORB/topics/setpoint_config.h>)
#define PINNQUAD_PX4_SETPOINT_CONFIG 1
#include <uORB/topics/setpoint_config.h>
#include <uORB/topics/setpoint_config_reply.h>
#else
#define PINNQUAD_PX4_SETPOINT_CONFIG 0
#include <uORB/topics/vehicle_control_mode.h>
#endif

// CMakeLists.txt looks into PX4's module.h.
#ifndef PINNQUAD_PX4_MODULE_DESCRIPTOR
#define PINNQUAD_PX4_MODULE_DESCRIPTOR 0
#endif

namespace pinnquad_px4 {

/// The shell's view of a module, under one set of names. `Module` has the static functions task_spawn, custom_command
/// and print_usage.
#if PINNQUAD_PX4_MODULE_DESCRIPTOR
template <class Module>
class ShellModule : public ModuleBase {
 public:
  static int shell(int argc, char* argv[]) { return ModuleBase::main(descriptor(), argc, argv); }
  static bool runs() { return ModuleBase::is_running(descriptor()); }

 protected:
  static Module* instance() { return ModuleBase::get_instance<Module>(descriptor()); }
  static void starts(Module* module) {
    descriptor().object.store(module);
    descriptor().task_id = module != nullptr ? task_id_is_work_queue : -1;
  }
  static void leaves() { ModuleBase::exit_and_cleanup(descriptor()); }

 private:
  static ModuleBase::Descriptor& descriptor() {
    static ModuleBase::Descriptor one{Module::task_spawn, Module::custom_command, Module::print_usage};
    return one;
  }
};
#else
template <class Module>
class ShellModule : public ModuleBase<Module> {
  using Base = ModuleBase<Module>;

 public:
  static int shell(int argc, char* argv[]) { return Base::main(argc, argv); }
  static bool runs() { return Base::is_running(); }

 protected:
  static Module* instance() { return Base::get_instance(); }
  static void starts(Module* module) {
    Base::_object.store(module);
    Base::_task_id = module != nullptr ? Base::task_id_is_work_queue : -1;
  }
  static void leaves() { Base::exit_and_cleanup(); }
};
#endif

}  // namespace pinnquad_px4
