// SPDX-License-Identifier: MIT
// What a module of PX4 is made of, in our own words: a clock, a work queue of one item, the shell's start and stop, parameters.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>
#include <map>
#include <string>

#include "messages.hpp"
#include "uorb.hpp"

#define PX4_OK 0
#define PX4_ERROR (-1)
#define PX4_STORAGEDIR "."
#define MODULE_NAME "pinnquad_control"
#define __EXPORT
#define PX4_INFO(...) static_cast<void>(0)
#define PX4_WARN(...) static_cast<void>(0)
#define PX4_ERR(...) static_cast<void>(0)
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

}  // namespace px4

class ModuleParams {
 public:
  explicit ModuleParams(ModuleParams*) {}
  virtual ~ModuleParams() = default;
};

template <class Name, class Value>
struct Parameter {
  Value value = static_cast<Value>(px4::parameter_values().at(Name::text));
  Value get() const { return value; }
};
template <class Name>
using ParamFloat = Parameter<Name, float>;
template <class Name>
using ParamInt = Parameter<Name, int32_t>;

#define PINNQUAD_TEST_NAME(NAME)               \
  namespace px4 {                              \
  namespace params {                           \
  struct NAME {                                \
    static constexpr const char* text = #NAME; \
  };                                           \
  }                                            \
  }
#define PINNQUAD_TEST_STRIP(...) __VA_ARGS__
#define PINNQUAD_TEST_MEMBER(declaration) PINNQUAD_TEST_STRIP declaration;
#define PINNQUAD_TEST_EACH1(m, x) m(x)
#define PINNQUAD_TEST_EACH2(m, x, ...) m(x) PINNQUAD_TEST_EACH1(m, __VA_ARGS__)
#define PINNQUAD_TEST_EACH4(m, a, b, ...) m(a) m(b) PINNQUAD_TEST_EACH2(m, __VA_ARGS__)
#define PINNQUAD_TEST_EACH8(m, a, b, c, d, ...) m(a) m(b) m(c) m(d) PINNQUAD_TEST_EACH4(m, __VA_ARGS__)
#define PINNQUAD_TEST_EACH21(m, a, b, c, d, e, f, g, h, i, j, k, l, n, ...) \
  m(a) m(b) m(c) m(d) m(e) m(f) m(g) m(h) m(i) m(j) m(k) m(l) m(n) PINNQUAD_TEST_EACH8(m, __VA_ARGS__)
#define DEFINE_PARAMETERS(...) PINNQUAD_TEST_EACH21(PINNQUAD_TEST_MEMBER, __VA_ARGS__)

PINNQUAD_TEST_NAME(PQ_OUT_MIN)
PINNQUAD_TEST_NAME(PQ_AGE_RATES)
PINNQUAD_TEST_NAME(PQ_AGE_ATT)
PINNQUAD_TEST_NAME(PQ_AGE_POS)
PINNQUAD_TEST_NAME(PQ_AGE_SP)
PINNQUAD_TEST_NAME(PQ_G_POS)
PINNQUAD_TEST_NAME(PQ_G_VEL)
PINNQUAD_TEST_NAME(PQ_G_TILT)
PINNQUAD_TEST_NAME(PQ_G_YAW)
PINNQUAD_TEST_NAME(PQ_G_RATE)
PINNQUAD_TEST_NAME(PQ_G_YAWRATE)
PINNQUAD_TEST_NAME(PQ_V_XY)
PINNQUAD_TEST_NAME(PQ_V_UP)
PINNQUAD_TEST_NAME(PQ_V_DN)
PINNQUAD_TEST_NAME(PQ_TKO_T)
PINNQUAD_TEST_NAME(PQ_BIAS_W)
PINNQUAD_TEST_NAME(PQ_BIAS_MAX)
PINNQUAD_TEST_NAME(PQ_RECORD)
PINNQUAD_TEST_NAME(PQ_STK_XY)
PINNQUAD_TEST_NAME(PQ_STK_Z)
PINNQUAD_TEST_NAME(PQ_STK_YAW)

/// The shell's side of a module: a stop waits 5 s for the module to go by itself, then takes it away.
template <class Module>
class ModuleBase {
 public:
  virtual ~ModuleBase() = default;
  virtual int print_status() { return 0; }

  static int main(int argc, char* argv[]) {
    if (argc < 2) return Module::print_usage();
    if (std::strcmp(argv[1], "start") == 0) {
      return is_running() ? PX4_ERROR : Module::task_spawn(argc - 1, argv + 1);
    }
    if (std::strcmp(argv[1], "stop") == 0) return stop();
    return Module::custom_command(argc - 1, argv + 1);
  }
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
  static int stop() {
    if (!is_running()) return 0;
    _object.load()->request_stop();
    for (int i = 0; is_running(); ++i) {
      if (i > 500) {
        exit_and_cleanup();
        return PX4_ERROR;
      }
      World::sleep_ms(10);
    }
    return 0;
  }
  bool should_exit_ = false;
};
