// SPDX-License-Identifier: MIT
// Faults that prediction code must not have: functions of the standard library that an unoptimised build emits out of
// line. The gate has to name them, and the program that mixes instruction sets has to die of the square root.
#include <array>
#include <cmath>

extern "C" void PREDICT(const float* x, float* y) {
  const std::array<float, 1> root{std::sqrt(x[15])};
  y[0] = root[0];
}
