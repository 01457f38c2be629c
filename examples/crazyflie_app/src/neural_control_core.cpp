// SPDX-License-Identifier: MIT
// The controller behind its C interface: one, in static memory.
#include "neural_control_core.hpp"

#include <cstring>
#include <new>

#include "core_log.h"
#include "pinnquad/control/autopilot/recorded_controller.hpp"

// A model.hpp beside the app, as pinnquad train writes it, takes the place of the one for the Crazyflie 2.1; a
// flown_vehicle.hpp says which effects the analytic inverse knows, a trust.hpp when the model is not to be trusted.
#if __has_include("model.hpp")
#include "model.hpp"
using FlownModel = TrainedQuadModel;
#else
#include "../../models/crazyflie_2_1.hpp"
using FlownModel = CrazyflieModel;
#endif
#if __has_include("flown_vehicle.hpp")
#include "flown_vehicle.hpp"
#else
using FlownVehicle = pinnquad::Quadrotor<float, pinnquad::QuadraticDrag>;
#endif
#if __has_include("model.hpp") && __has_include("trust.hpp")
#include "trust.hpp"
using FlownLimits = TrainedQuadModelTrust;
#else
using FlownLimits = void;  // without limits of trust
#endif

// The vehicle is learnt in flight where the app is built for it (docs/onboard.md): CFLAGS += -DPINNQUAD_ONBOARD.
#ifdef PINNQUAD_ONBOARD
using FlownOnboard = pinnquad::OnboardInverse<float>;
#else
using FlownOnboard = void;
#endif

// A block is opened and tested on the app's task.
#if __has_include("autoconf.h")
#include "autoconf.h"
#endif
#ifdef CONFIG_APP_STACKSIZE
constexpr int past_stack_words = 800;
static_assert(
    !pinnquad::is_windowed<FlownModel::Features> || CONFIG_APP_STACKSIZE >= past_stack_words,
    "pinnquad: a model with a window is tested on more stack: raise CONFIG_APP_STACKSIZE to 800 (app-config)");
#endif

namespace {

using Controller =
    pinnquad::autopilot::Recorded<pinnquad::autopilot::NeuralController<FlownModel, pinnquad::ModelView<FlownModel>,
                                                                        FlownVehicle, FlownLimits, FlownOnboard>>;
using Control = pinnquad_crazyflie::NeuralControl<FlownModel, Controller>;

alignas(Control) unsigned char memory[sizeof(Control)];
Control* made = nullptr;

/// Made by the first call, which must have returned before another thread calls; the firmware may run no constructors.
Control& controller(float most_command = 1.0f) noexcept {
  if (made == nullptr) {
    pinnquad::autopilot::CoreSettings settings;
    if (most_command < settings.highest_command && most_command > settings.lowest_command) {
      settings.highest_command = most_command;
    }
    made = new (memory) Control(settings);
  }
  return *made;
}

// As core_log.h packs a record: no number of it need be aligned.
#define PINNQUAD_COPY_ONE(type, name) std::memcpy(&to->name, &from.name, sizeof to->name);
#define PINNQUAD_COPY_MANY(count, type, name) PINNQUAD_COPY_ONE(type, name)
#define PINNQUAD_COPY_TIME(of, name) to->name = static_cast<std::uint32_t>(from.of / 1000);

}  // namespace

extern "C" {

void pinnquad_flight_record(CrazyflieCoreRecord* to) {
  const pinnquad::autopilot::CoreRecord& from = controller().controller().record();
  PINNQUAD_RECORD_LIST(PINNQUAD_COPY_ONE, PINNQUAD_COPY_MANY, PINNQUAD_COPY_TIME)
}

void pinnquad_flight_settings(uint32_t now_ms, CrazyflieCoreSettings* to) {
  pinnquad::autopilot::CoreSettings from = controller().controller().settings();
  from.timestamp = std::uint64_t{now_ms} * 1000;
  PINNQUAD_SETTINGS_LIST(PINNQUAD_COPY_ONE, PINNQUAD_COPY_MANY, PINNQUAD_COPY_TIME)
}

uint8_t pinnquad_flight_offer_model(const void* block, size_t length) {
  return static_cast<uint8_t>(controller().offer_model(block, length));
}

float pinnquad_flight_start(float most_thrust_N) {
  const float rotor_N = pinnquad::airframe_value<FlownModel::Vehicle, float>().max_rotor_thrust_N();
  if (!(most_thrust_N > 0.0f)) return 1.0f;
  static_cast<void>(controller(most_thrust_N / rotor_N));
  return rotor_N / most_thrust_N;
}

bool pinnquad_flight_ready(void) { return controller().ready(); }

bool pinnquad_flight_step(uint32_t now_ms, const CrazyflieState* state, const CrazyflieSetpoint* setpoint,
                          float forces[4], CrazyflieReport* report) {
  return controller().step(now_ms, *state, *setpoint, forces, *report);
}

}  // extern "C"
