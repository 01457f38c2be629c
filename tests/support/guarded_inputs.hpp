// SPDX-License-Identifier: MIT
// Common to the tests of predictions: motions of a chosen size, their features, inputs that are no numbers, and
// commands that show whether they were touched; a fallback of one answer.
#pragma once

#include <array>
#include <cstring>
#include <limits>

#include "pinnquad/core/status.hpp"
#include "pinnquad/features/features.hpp"
#include "support/random_states.hpp"

namespace pinnquad::test {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Bits that no prediction gives: "untouched" can be seen.
template <class Scalar = float>
Commands<Scalar> marked() {
  return {Scalar(-1.25), Scalar(-0.0), std::numeric_limits<Scalar>::quiet_NaN(), Scalar(1e30)};
}

template <class Scalar>
bool same_bits(const Commands<Scalar>& a, const Commands<Scalar>& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Near hover where `size` is 0, up to the small model's envelope where it is 1, beyond it where it is well above 1.
inline MotionInputs<float> inputs_of(RandomStates& random, double size) {
  MotionInputs<float> inputs;
  inputs.linear_acceleration_m_s2 = random.vector<float>(9.0 * size);
  inputs.angular_acceleration_rad_s2 = random.vector<float>(5.0 * size);
  inputs.velocity_m_s = random.vector<float>(6.0 * size);
  inputs.body_rates_rad_s = random.vector<float>(3.0 * size);
  inputs.attitude = from_euler(EulerAngles<float>{random.scalar<float>(-0.7, 0.7), random.scalar<float>(-0.7, 0.7),
                                                  random.scalar<float>(-3.1, 3.1)});
  return inputs;
}

inline std::array<float, 16> features(const MotionInputs<float>& inputs) {
  std::array<float, 16> x{};
  PaperFeatures::extract(inputs, x.data());
  return x;
}

/// Answers anything with one command, or as told.
struct FixedFallback {
  float command = 0.5F;
  Status status = Status::ok;
  Status operator()(const MotionInputs<float>&, Commands<float>& commands) const noexcept {
    if (has_output(status)) commands = {command, command, command, command};
    return status;
  }
};

}  // namespace pinnquad::test
