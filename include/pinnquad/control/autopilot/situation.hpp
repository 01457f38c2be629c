// SPDX-License-Identifier: MIT
// What a flight stack says besides its samples: the limits to fly within, who has the motors, whether the vehicle stands, and
// that its estimator has moved.
#pragma once

#include "pinnquad/core/types.hpp"

namespace pinnquad::autopilot {

struct OutputLimits {
  float lower = 0.02f;  ///< rotors keep turning
  float upper = 1.0f;
};

/// How fast it flies to a place, and how long its thrust takes to come when it leaves the ground.
struct SpeedLimits {
  float horizontal_m_s = 12;
  float climb_m_s = 5;
  float descent_m_s = 3;
  float take_off_s = 1;
};

/// What the stack knows and the inputs don't say.
struct Situation {
  bool drives_motors{false};  ///< this controller's commands reach them
  bool landed{false};

  /// The bias is estimated then alone.
  bool in_flight() const noexcept { return drives_motors && !landed; }
};

/// By how much an estimator moved its own estimate, NED: a reset.
struct EstimateJump {
  Vector3<float> position_m = Vector3<float>::Zero();
  Vector3<float> velocity_m_s = Vector3<float>::Zero();
  float yaw_rad{0};
};

}  // namespace pinnquad::autopilot
