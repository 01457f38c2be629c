// SPDX-License-Identifier: MIT
// The meaning of a motor command. A model flies a vehicle only where both mean the same.
#pragma once

#include <cstdint>

#include "pinnquad/dynamics/airframe.hpp"

namespace pinnquad {

/// The values are those of a model block (exported/model_block.hpp).
enum class CommandMeaning : std::uint8_t {
  thrust = 0,       ///< u = (n / n_max)^2, the thrust over that at full command
  pulse_width = 1,  ///< the share of a speed controller's pulse range: thrust between a share and its square
  speed = 2,        ///< u = n / n_max
};

/// Number of meanings; values from here on are none.
inline constexpr unsigned command_meaning_count = 3;

/// By an airframe's curves (thrust_fraction(), dynamics/actuator.hpp): all straight, all squares, or between.
template <class Scalar>
constexpr CommandMeaning command_meaning_of(const Airframe<Scalar>& airframe) noexcept {
  bool thrust = true, speed = true;
  for (const RotorMount<Scalar>& rotor : airframe.rotors) {
    thrust = thrust && detail::equal(rotor.thrust_curve, Scalar(0));
    speed = speed && detail::equal(rotor.thrust_curve, Scalar(1));
  }
  return thrust ? CommandMeaning::thrust : (speed ? CommandMeaning::speed : CommandMeaning::pulse_width);
}

/// The enumerator as C++ text.
constexpr const char* to_string(CommandMeaning meaning) noexcept {
  switch (meaning) {
    case CommandMeaning::thrust: return "thrust";
    case CommandMeaning::pulse_width: return "pulse_width";
    case CommandMeaning::speed: return "speed";
  }
  return "unknown";
}

}  // namespace pinnquad
