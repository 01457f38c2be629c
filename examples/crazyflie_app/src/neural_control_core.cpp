// SPDX-License-Identifier: MIT
// The controller behind its C interface: one, in static memory.
#include "neural_control_core.hpp"

#include <new>

#include "models/crazyflie_2_1.hpp"

namespace {

using Control = pinnquad_crazyflie::NeuralControl<CrazyflieModel>;

alignas(Control) unsigned char memory[sizeof(Control)];
Control* made = nullptr;

/// Made by the first call, which must have returned before another thread calls; the firmware may run no constructors.
Control& controller(float most_command = 1.0f) noexcept {
  if (made == nullptr) {
    flight_stacks::OutputLimits outputs;
    if (most_command < outputs.upper && most_command > outputs.lower) outputs.upper = most_command;
    made = new (memory) Control(flight_stacks::AgeLimits{}, outputs);
  }
  return *made;
}

}  // namespace

extern "C" {

uint8_t pinnquad_flight_offer_model(const void* block, size_t length) {
  return static_cast<uint8_t>(controller().offer_model(block, length));
}

float pinnquad_flight_start(float most_thrust_N) {
  const float rotor_N = pinnquad::airframe_value<CrazyflieModel::Vehicle, float>().max_rotor_thrust_N();
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
