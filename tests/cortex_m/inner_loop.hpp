// SPDX-License-Identifier: MIT
// An inner loop as firmware runs it, behind C functions: inner_loop.cpp, called from measure_inner_loop.cpp.
#pragma once

#include <cstddef>
#include <cstdint>

/// The inputs of a tick. NED, FRD, SI units.
struct LoopSample {
  float position_m[3], velocity_m_s[3], body_rates_rad_s[3], attitude[4];  ///< w, x, y, z
  float wanted_position_m[3], wanted_velocity_m_s[3], wanted_acceleration_m_s2[3];
};

extern "C" {

/// Once. A block of the model, which must stay; a loop that has its weights compiled in asks for none. The Status.
unsigned char pinnquad_loop_start(const void* block, std::size_t length);

/// One tick, in flight, its commands those of the tick before: samples in, motor commands out. The Status of the
/// inverse.
unsigned char pinnquad_loop_tick(std::uint32_t now_us, const LoopSample* sample, float* commands);

/// The Status of the network's bias, and its signed sums.
unsigned char pinnquad_loop_bias(float* sums);

}  // extern "C"
