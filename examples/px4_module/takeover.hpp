// SPDX-License-Identifier: MIT
// The mode that a module asks PX4 for when it gives up: the best mode whose needs are met, and the next one where PX4
// does not follow. Pure C++17; the glue fills what PX4 says (failsafe_flags).
#pragma once

#include <cstdint>

namespace pinnquad_px4 {

/// Of PX4's failsafe_flags: which modes need what, as bits by nav_state, and what is missing.
struct FailsafeFlags {
  std::uint32_t mode_req_angular_velocity{0};
  std::uint32_t mode_req_attitude{0};
  std::uint32_t mode_req_local_alt{0};
  std::uint32_t mode_req_local_position{0};
  std::uint32_t mode_req_local_position_relaxed{0};
  std::uint32_t mode_req_global_position{0};
  std::uint32_t mode_req_manual_control{0};
  bool angular_velocity_invalid{false};
  bool attitude_invalid{false};
  bool local_altitude_invalid{false};
  bool local_position_invalid{false};
  bool local_position_invalid_relaxed{false};
  bool global_position_invalid{false};
  bool manual_control_signal_lost{false};
};

/// Asks until it is heard: each mode for a while, from the best on, Descend again and again.
class Takeover {
 public:
  static constexpr std::uint8_t hold = 4, position = 2, altitude = 1, descend = 12;  ///< PX4's nav_state
  static constexpr std::uint8_t order[] = {hold, position, altitude, descend};
  static constexpr std::uint64_t patience_us = 60'000;  ///< with one mode

  /// The nav_state to ask for now. `position_stale`: the module itself had no position, whatever PX4 still says.
  std::uint8_t ask(std::uint64_t now_us, const FailsafeFlags& flags, bool position_stale) noexcept {
    if (!asking_) {
      asking_ = true;
      place_ = 0;
      since_us_ = now_us;
    } else if (now_us - since_us_ > patience_us && place_ + 1 < count) {
      ++place_;
      since_us_ = now_us;
    }
    while (place_ + 1 < count && !granted(order[place_], flags, position_stale)) {
      ++place_;
      since_us_ = now_us;
    }
    return order[place_];
  }
  void heard() noexcept { asking_ = false; }
  bool asking() const noexcept { return asking_; }

  static bool granted(std::uint8_t mode, const FailsafeFlags& f, bool position_stale) noexcept {
    const std::uint32_t bit = std::uint32_t{1} << mode;
    const bool missing = ((f.mode_req_angular_velocity & bit) != 0 && f.angular_velocity_invalid) ||
                         ((f.mode_req_attitude & bit) != 0 && f.attitude_invalid) ||
                         ((f.mode_req_local_alt & bit) != 0 && f.local_altitude_invalid) ||
                         ((f.mode_req_local_position & bit) != 0 && f.local_position_invalid) ||
                         ((f.mode_req_local_position_relaxed & bit) != 0 && f.local_position_invalid_relaxed) ||
                         ((f.mode_req_global_position & bit) != 0 && f.global_position_invalid) ||
                         ((f.mode_req_manual_control & bit) != 0 && f.manual_control_signal_lost);
    const bool needs_position = mode == hold || mode == position;
    return !missing && !(needs_position && position_stale);
  }

 private:
  static constexpr int count = sizeof order / sizeof order[0];

  bool asking_ = false;
  int place_ = 0;
  std::uint64_t since_us_ = 0;
};

}  // namespace pinnquad_px4
