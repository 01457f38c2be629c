// SPDX-License-Identifier: MIT
// Parts of a PX4 module, in our own words: a clock, a work queue of one item, the shell's start and stop,
// parameters.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "messages.hpp"
#include "parameter_names.hpp"  // types of module.yaml's, by CMakeLists.txt
#include "uorb.hpp"

#define PX4_OK 0
#define PX4_ERROR (-1)
#define PX4_STORAGEDIR "."
#define MODULE_NAME "pinnquad_control"
#define __EXPORT
#define PX4_INFO(...) static_cast<void>(0)
#define PX4_WARN(...) static_cast<void>(0)
#define PX4_ERR(...) px4::complain(__VA_ARGS__)
#define PRINT_MODULE_DESCRIPTION(text) static_cast<void>(text)
#define PRINT_MODULE_USAGE_NAME(name, category) static_cast<void>(0)
#define PRINT_MODULE_USAGE_COMMAND(name) static_cast<void>(0)
#define PRINT_MODULE_USAGE_COMMAND_DESCR(name, text) static_cast<void>(0)
#define PRINT_MODULE_USAGE_DEFAULT_COMMANDS() static_cast<void>(0)

/// The world's: time goes on while a shell command sleeps.
struct World {
  static inline uint64_t now_us = 0;
  static inline std::function<void(int)> sleep_ms;
};
inline uint64_t hrt_absolute_time() { return World::now_us; }

namespace px4 {

/// Text of PX4_ERR and of messages to the ground station, line by line.
inline std::vector<std::string>& complaints() {
  static std::vector<std::string> all;
  return all;
}
template <class... Values>
void complain(const char* format, Values... values) {
  if constexpr (sizeof...(Values) == 0) {
    complaints().emplace_back(format);
  } else {
    char line[256];
    std::snprintf(line, sizeof line, format, values...);
    complaints().emplace_back(line);
  }
}

/// Those of them that reached the ground station.
inline std::vector<std::string>& ground_station() {
  static std::vector<std::string> all;
  return all;
}

struct wq_config_t {};
namespace wq_configurations {
inline constexpr wq_config_t rate_ctrl{};
}

template <class Value>
class atomic {
 public:
  explicit atomic(Value value) : value_(value) {}
  Value load() const { return value_; }
  void store(Value value) { value_ = value; }

 private:
  Value value_;
};
using atomic_bool = atomic<bool>;

/// One item: run_pending() is what the queue's thread does.
class ScheduledWorkItem {
 public:
  ScheduledWorkItem(const char*, const wq_config_t&) { running() = this; }
  virtual ~ScheduledWorkItem() {
    if (running() == this) running() = nullptr;
  }
  void ScheduleNow() { due_us_ = World::now_us; }
  void ScheduleDelayed(uint32_t delay_us) { due_us_ = World::now_us + delay_us; }
  void ScheduleClear() { due_us_ = never; }
  static void run_pending() {
    ScheduledWorkItem* item = running();
    if (item == nullptr || item->due_us_ > World::now_us) return;
    item->due_us_ = never;
    item->Run();
  }

 protected:
  virtual void Run() = 0;

 private:
  static constexpr uint64_t never = ~uint64_t{0};
  static ScheduledWorkItem*& running() {
    static ScheduledWorkItem* item = nullptr;
    return item;
  }
  uint64_t due_us_ = never;
};

/// Values by name, as module.yaml gives them; a name that is not there is a fault of the module.
inline std::map<std::string, double>& parameter_values() {
  static std::map<std::string, double> all;
  return all;
}

inline std::set<std::string>& whole_parameters() {
  static std::set<std::string> all;
  return all;
}

}  // namespace px4

/// PX4's parameters by name, of either type.
using param_t = const char*;
inline constexpr param_t PARAM_INVALID = nullptr;
inline param_t param_find(const char* name) {
  const auto found = px4::parameter_values().find(name);
  return found == px4::parameter_values().end() ? PARAM_INVALID : found->first.c_str();
}
template <class Value>
int param_get(param_t name, Value* value) {
  *value = static_cast<Value>(px4::parameter_values().at(name));
  return 0;
}

constexpr int PARAM_TYPE_INT32 = 1, PARAM_TYPE_FLOAT = 2;
/// Whole numbers of module.yaml, by their names.
inline int param_type(param_t name) {
  return px4::whole_parameters().count(name) != 0 ? PARAM_TYPE_INT32 : PARAM_TYPE_FLOAT;
}

/// A text for the ground station, cut off as PX4's message is.
using orb_advert_t = void*;
template <class... Values>
void mavlink_log_critical(orb_advert_t* publication, const char* format, Values... values) {
  *publication = publication;
  px4::complain(format, values...);
  px4::ground_station().push_back(px4::complaints().back().substr(0, 126));
}

/// Values are read when they are made, and by updateParams().
class ModuleParams {
 public:
  explicit ModuleParams(ModuleParams*) {}
  virtual ~ModuleParams() = default;

 protected:
  void updateParams() { updateParamsImpl(); }
  virtual void updateParamsImpl() {}
};

template <class Name, class Value>
struct Parameter {
  Value value = read();
  static Value read() { return static_cast<Value>(px4::parameter_values().at(Name::text)); }
  Value get() const { return value; }
  void update() { value = read(); }
};
template <class Name>
using ParamFloat = Parameter<Name, float>;
template <class Name>
using ParamInt = Parameter<Name, int32_t>;

#define PINNQUAD_TEST_STRIP(...) __VA_ARGS__
#define PINNQUAD_TEST_NAME_OF(...)
#define PINNQUAD_TEST_MEMBER(declaration) PINNQUAD_TEST_STRIP declaration;
#define PINNQUAD_TEST_UPDATE(declaration) PINNQUAD_TEST_NAME_OF declaration.update();
#define PINNQUAD_TEST_EACH1(m, x) m(x)
#define PINNQUAD_TEST_EACH2(m, x, ...) m(x) PINNQUAD_TEST_EACH1(m, __VA_ARGS__)
#define PINNQUAD_TEST_EACH4(m, a, b, ...) m(a) m(b) PINNQUAD_TEST_EACH2(m, __VA_ARGS__)
#define PINNQUAD_TEST_EACH8(m, a, b, c, d, ...) m(a) m(b) m(c) m(d) PINNQUAD_TEST_EACH4(m, __VA_ARGS__)
#define PINNQUAD_TEST_EACH21(m, a, b, c, d, e, f, g, h, i, j, k, l, n, ...) \
  m(a) m(b) m(c) m(d) m(e) m(f) m(g) m(h) m(i) m(j) m(k) m(l) m(n) PINNQUAD_TEST_EACH8(m, __VA_ARGS__)
#define PINNQUAD_TEST_EACH24(m, a, b, o, ...) m(a) m(b) m(o) PINNQUAD_TEST_EACH21(m, __VA_ARGS__)
#define PINNQUAD_TEST_EACH28(m, a, b, c, o, ...) m(a) m(b) m(c) m(o) PINNQUAD_TEST_EACH24(m, __VA_ARGS__)
#define DEFINE_PARAMETERS(...)                            \
  PINNQUAD_TEST_EACH28(PINNQUAD_TEST_MEMBER, __VA_ARGS__) \
  void updateParamsImpl() final { PINNQUAD_TEST_EACH28(PINNQUAD_TEST_UPDATE, __VA_ARGS__) }

/// The shell's side of a module: a stop waits 5 s for the module to go by itself, then takes it away. `Shell` says
/// where the module is kept.
template <class Shell>
struct ShellCommands {
  static int run(Shell shell, int argc, char* argv[]) {
    if (argc < 2) return shell.print_usage();
    if (std::strcmp(argv[1], "start") == 0) return shell.is_running() ? PX4_ERROR : shell.spawn(argc - 1, argv + 1);
    if (std::strcmp(argv[1], "stop") == 0) return stop(shell);
    return shell.custom(argc - 1, argv + 1);
  }
  static int stop(Shell shell) {
    if (!shell.is_running()) return 0;
    shell.request_stop();
    for (int i = 0; shell.is_running(); ++i) {
      if (i > 500) {
        shell.take_away();
        return PX4_ERROR;
      }
      World::sleep_ms(10);
    }
    return 0;
  }
};

#if PINNQUAD_PX4_MODULE_DESCRIPTOR

/// After v1.16: a class, with a descriptor of each module.
class ModuleBase {
 public:
  struct Descriptor {
    Descriptor(int (*spawn)(int, char**), int (*custom)(int, char**), int (*usage)(const char*))
        : task_spawn(spawn), custom_command(custom), print_usage(usage) {}
    int (*task_spawn)(int argc, char* argv[]);
    int (*custom_command)(int argc, char* argv[]);
    int (*print_usage)(const char* reason);
    px4::atomic<ModuleBase*> object{nullptr};
    int task_id{-1};
  };
  virtual ~ModuleBase() = default;
  virtual int print_status() { return 0; }
  virtual void request_stop() { should_exit_ = true; }
  bool should_exit() const { return should_exit_; }

  static int main(Descriptor& module, int argc, char* argv[]) {
    return ShellCommands<Shell>::run({&module}, argc, argv);
  }
  static bool is_running(const Descriptor& module) { return module.task_id != -1; }
  static void exit_and_cleanup(Descriptor& module) {
    delete module.object.load();
    module.object.store(nullptr);
    module.task_id = -1;
  }
  template <class Module>
  static Module* get_instance(Descriptor& module) {
    return static_cast<Module*>(module.object.load());
  }
  static constexpr int task_id_is_work_queue = -2;

 private:
  struct Shell {
    Descriptor* module;
    bool is_running() const { return ModuleBase::is_running(*module); }
    void request_stop() const { module->object.load()->request_stop(); }
    void take_away() const { exit_and_cleanup(*module); }
    int spawn(int argc, char* argv[]) const { return module->task_spawn(argc, argv); }
    int custom(int argc, char* argv[]) const { return module->custom_command(argc, argv); }
    int print_usage() const { return module->print_usage(nullptr); }
  };
  bool should_exit_ = false;
};

#else

/// v1.16: a template of the module.
template <class Module>
class ModuleBase {
 public:
  virtual ~ModuleBase() = default;
  virtual int print_status() { return 0; }

  static int main(int argc, char* argv[]) { return ShellCommands<Shell>::run({}, argc, argv); }
  static bool is_running() { return _task_id != -1; }

 protected:
  void request_stop() { should_exit_ = true; }
  bool should_exit() const { return should_exit_; }
  static void exit_and_cleanup() {
    delete _object.load();
    _object.store(nullptr);
    _task_id = -1;
  }
  static Module* get_instance() { return _object.load(); }

  static inline px4::atomic<Module*> _object{nullptr};
  static inline int _task_id = -1;
  static constexpr int task_id_is_work_queue = -2;

 private:
  struct Shell {
    bool is_running() const { return ModuleBase::is_running(); }
    void request_stop() const { static_cast<ModuleBase*>(_object.load())->request_stop(); }
    void take_away() const { exit_and_cleanup(); }
    int spawn(int argc, char* argv[]) const { return Module::task_spawn(argc, argv); }
    int custom(int argc, char* argv[]) const { return Module::custom_command(argc, argv); }
    int print_usage() const { return Module::print_usage(); }
  };
  bool should_exit_ = false;
};

#endif
