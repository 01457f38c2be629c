// SPDX-License-Identifier: MIT
//
// Everything that must not fly, one offence per function: the symbol gate must reject this file and name each.
#undef NDEBUG
#include <cassert>
#include <cstdlib>
#include <iostream>

namespace {

struct Layer {
  virtual ~Layer() = default;
  virtual float forward(float input) const { return input; }
};

float read_at_start() {
  const char* text = std::getenv("PINNQUAD_GATE");
  return text == nullptr ? 0.0F : static_cast<float>(text[0]);
}

const float initialised_at_run_time = read_at_start();

}  // namespace

extern "C" float pinnquad_flight_asserts(float input) {
  assert(input > 0.0F);
  return input;
}

extern "C" const float* pinnquad_flight_holds_a_static() {
  static const float value = read_at_start() + initialised_at_run_time;
  return &value;
}

extern "C" Layer* pinnquad_flight_news() { return new Layer; }

extern "C" void* pinnquad_flight_mallocs(std::size_t bytes) { return std::malloc(bytes); }

extern "C" void pinnquad_flight_prints(float input) { std::cout << input << '\n'; }

extern "C" float pinnquad_flight_allocas(unsigned count) {
  auto* values = static_cast<volatile float*>(__builtin_alloca(count * sizeof(float)));
  values[count - 1] = 1.0F;
  return values[0];
}
