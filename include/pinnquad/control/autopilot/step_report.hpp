// SPDX-License-Identifier: MIT
// What a step of the controller did, and why.
#pragma once

#include "pinnquad/control/autopilot/inputs.hpp"
#include "pinnquad/core/status.hpp"

namespace pinnquad::autopilot {

/// What a step did, and why.
struct StepReport {
  Reaction reaction{Reaction::gives_up};
  bool body_rates_stale{false};
  bool attitude_stale{false};
  bool local_stale{false};
  bool set_point_stale{false};
  Status status{Status::ok};  ///< of outer loop and inverse; ok where neither was asked
  Status cause{Status::ok};   ///< what the network alone came to
  float worst_excess{0};      ///< how far outside its envelope, in half-widths; 0 inside
  int worst_feature{-1};      ///< which feature, -1 if none
  float squared_distance{0};  ///< from the training rows (JointDistance); 0 where none was measured

  /// As bits: 1 body rates, 2 attitude, 4 position and velocity, 8 set point.
  std::uint8_t stale_inputs() const noexcept {
    return static_cast<std::uint8_t>((body_rates_stale ? 1 : 0) | (attitude_stale ? 2 : 0) | (local_stale ? 4 : 0) |
                                     (set_point_stale ? 8 : 0));
  }
};

}  // namespace pinnquad::autopilot
