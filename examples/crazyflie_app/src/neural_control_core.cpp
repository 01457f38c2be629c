// SPDX-License-Identifier: MIT
// The controller behind its C interface: one, in static memory.
#include "neural_control_core.hpp"

#include <new>

#include "models/crazyflie_2_1.hpp"

namespace {

/// Made by the first call, which must have returned before another thread calls; the firmware may run no constructors.
pinnquad_crazyflie::NeuralControl<CrazyflieModel>& controller() noexcept {
  using Controller = pinnquad_crazyflie::NeuralControl<CrazyflieModel>;
  alignas(Controller) static unsigned char memory[sizeof(Controller)];
  static Controller* made = nullptr;
  if (made == nullptr) made = new (memory) Controller();
  return *made;
}

}  // namespace

extern "C" {

uint8_t pinnquad_flight_offer_model(const void* block, size_t length) {
  return static_cast<uint8_t>(controller().offer_model(block, length));
}

bool pinnquad_flight_ready(void) { return controller().ready(); }

bool pinnquad_flight_step(uint32_t now_ms, const CrazyflieState* state, const CrazyflieSetpoint* setpoint,
                          float forces[4], CrazyflieReport* report) {
  float result[4] = {};
  if (!controller().step(now_ms, *state, *setpoint, result, *report)) return false;
  for (int motor = 0; motor < 4; ++motor) forces[motor] = result[motor];
  return true;
}

}  // extern "C"
