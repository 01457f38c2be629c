// SPDX-License-Identifier: MIT
// The report of one step of the controller.
#pragma once

#include "pinnquad/control/autopilot/inputs.hpp"
#include "pinnquad/core/status.hpp"

namespace pinnquad::autopilot {

/// A step's reaction, and the reasons.
struct StepReport {
  Reaction reaction{Reaction::gives_up};
  bool body_rates_stale{false};
  bool attitude_stale{false};
  bool local_stale{false};
  bool set_point_stale{false};
  Status status{Status::ok};  ///< of outer loop and inverse; ok where none was asked
  Status cause{Status::ok};   ///< the network's own
  float worst_excess{0};      ///< of a feature beyond its envelope, in half-widths; 0 inside
  int worst_feature{-1};      ///< that feature, -1 if none
  float squared_distance{0};  ///< from the training rows (JointDistance); 0: none was measured

  /// As bits: 1 body rates, 2 attitude, 4 position and velocity, 8 set point.
  std::uint8_t stale_inputs() const noexcept {
    return static_cast<std::uint8_t>((body_rates_stale ? 1 : 0) | (attitude_stale ? 2 : 0) | (local_stale ? 4 : 0) |
                                     (set_point_stale ? 8 : 0));
  }
};

}  // namespace pinnquad::autopilot
