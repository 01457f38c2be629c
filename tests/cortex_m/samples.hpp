// SPDX-License-Identifier: MIT
// Inputs of the measurements, the same on host and target: integer arithmetic and exact float operations only.
#pragma once

#include <cstdint>

namespace samples {

/// Numbers in [-1, 1), 24 bits each (a linear congruential generator; its high bits).
class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : state_(seed) {}
  float next() {
    state_ = state_ * 1664525u + 1013904223u;
    return static_cast<float>(static_cast<std::int32_t>(state_ >> 8) - 0x800000) / 8388608.0F;
  }

 private:
  std::uint32_t state_;
};

/// A kind of standardised input vector that might take another path through a kernel.
struct Kind {
  const char* name;
  float scale;    ///< of random numbers
  float offset;   ///< added to each
  float planted;  ///< value of one entry in the middle
};

inline constexpr Kind kinds[] = {
    {"ordinary", 1.0F, 0.0F, 0.5F},
    {"zero", 0.0F, 0.0F, 0.0F},
    {"negative_zero", 0.0F, -0.0F, -0.0F},
    {"negative", 0.5F, -2.0F, -1.0F},
    {"denormal", 1e-39F, 0.0F, 1e-45F},
    {"huge", 1e30F, 0.0F, 1e38F},
    {"infinite", 1.0F, 0.0F, __builtin_inff()},
    {"not_a_number", 1.0F, 0.0F, __builtin_nanf("")},
};

template <int Size>
void fill(const Kind& kind, std::uint32_t seed, float (&x)[Size]) {
  Numbers numbers(seed);
  for (float& v : x) {
    const float scaled = kind.scale * numbers.next();
    v = kind.offset == 0.0F ? scaled : scaled + kind.offset;
  }
  x[Size / 2] = kind.planted;
}

/// Raw inputs of predict(): accelerations, velocity, rates inside the envelope of write_model.cpp, and a unit
/// quaternion.
inline void fill_raw(std::uint32_t seed, float (&raw)[16]) {
  Numbers numbers(seed);
  constexpr float scale[4] = {8.0F, 20.0F, 6.0F, 3.0F};
  for (int i = 0; i < 12; ++i) raw[i] = scale[i / 3] * numbers.next();
  float sum = 0.0F;
  for (int i = 12; i < 16; ++i) {
    raw[i] = numbers.next();
    const float square = raw[i] * raw[i];
    sum += square;
  }
  const float norm = __builtin_sqrtf(sum);
  for (int i = 12; i < 16; ++i) raw[i] /= norm;
}

/// The same, gently and near upright: inside the envelope of a model that was trained on flights.
inline void fill_gentle_raw(std::uint32_t seed, float (&raw)[16]) {
  Numbers numbers(seed);
  for (int i = 0; i < 12; ++i) raw[i] = 0.1F * numbers.next();
  float sum = 0.0F;
  for (int i = 12; i < 16; ++i) {
    raw[i] = i == 12 ? 1.0F : 0.004F * numbers.next();
    const float square = raw[i] * raw[i];
    sum += square;
  }
  const float norm = __builtin_sqrtf(sum);
  for (int i = 12; i < 16; ++i) raw[i] /= norm;
}

}  // namespace samples
