// SPDX-License-Identifier: MIT
// PX4's land detector for multicopters by its rules of v1.16, in our own words: three states, each after a while of its
// conditions. It reads the thrust set point that came last, however old, and never the motors.
#pragma once

#include <cmath>
#include <cstdint>

#include "px4.hpp"

namespace pinnquad::autopilot::test {

/// True once what it is told has been true for `after_us`; false at once.
class Lasting {
 public:
  bool update(bool now_true, uint64_t now_us, uint64_t after_us) {
    if (!now_true) since_us_ = now_us;
    return state_ = now_true && now_us - since_us_ >= after_us;
  }
  bool state() const { return state_; }

 private:
  uint64_t since_us_ = 0;
  bool state_ = true;
};

class LandDetector {
 public:
  // MPC_THR_MIN, MPC_MANTHR_MIN, MPC_THR_HOVER, LNDMC_Z_VEL_MAX, LNDMC_XY_VEL_MAX; LNDMC_TRIG_TIME over three states
  static constexpr float least_thrust = 0.12f, least_manual_thrust = 0.08f, hover_thrust = 0.5f, rests_m_s = 0.25f,
                         stands_m_s = 1.5f, near_m = 1;
  static constexpr uint64_t state_us = 333'333;

  /// In a mode without PX4's climb-rate control, such as this module's. `range_m`: of a range finder, below 0: none.
  bool update(uint64_t now_us, bool armed, const vehicle_local_position_s& local, float range_m) {
    vehicle_thrust_setpoint_s wanted;
    if (thrust_sub_.update(&wanted)) thrust_ = -wanted.xyz[2];
    const bool low = thrust_ <= least_thrust + 0.3f * (hover_thrust - least_thrust);
    const bool rests = std::abs(local.vz) < rests_m_s * (landed() ? 2.5f : 1);
    const bool stands = std::hypot(local.vx, local.vy) < stands_m_s;
    const bool near = range_m < 0 || range_m < near_m;
    contact_.update(!armed || (low && rests && stands && near), now_us, state_us);
    const bool idle = thrust_ <= least_manual_thrust + 0.01f;
    maybe_.update(!armed || (idle && contact_.state()), now_us, state_us);
    return landed_.update(!armed || maybe_.state(), now_us, state_us);
  }
  bool landed() const { return landed_.state(); }

 private:
  uORB::Subscription thrust_sub_{ORB_ID(vehicle_thrust_setpoint)};
  float thrust_ = 0;
  Lasting contact_, maybe_, landed_;
};

}  // namespace pinnquad::autopilot::test
