// SPDX-License-Identifier: MIT
// The share of its thrust that a controller uses at take-off and landing. On the ground the rotors idle until a set
// point asks to climb; then thrust comes over a while. It goes again only where the ground bears the vehicle, whatever
// a stack says of having landed. A vehicle that is taken over in the air has all of it.
#pragma once

#include "pinnquad/control/autopilot/inputs.hpp"

namespace pinnquad::autopilot::detail {

/// A tick's demand along the vertical, and the vehicle's motion.
struct VerticalMotion {
  bool asks_to_climb{false};
  float asked_sink_m_s{0};      ///< by the set point; positive down, as all here
  float sink_m_s{0};            ///< of the vehicle
  float along_m_s{0};           ///< of the vehicle, along the ground
  float expected_fall_m_s2{0};  ///< that the last commands were to make
};

class TakeOff {
 public:
  /// Asked to sink by least_sink, expected to fall by least_fall and at rest for rests_us: the ground bears it. If it
  /// sinks by falls_m_s while its thrust goes, nothing does. Along the ground an estimate may wander by rests_along: a
  /// vehicle that is faster flies.
  static constexpr float least_sink_m_s = 0.3f, least_fall_m_s2 = 1.0f, rests_m_s = 0.25f, rests_along_m_s = 1.0f,
                         falls_m_s = 0.5f;
  static constexpr std::uint64_t rests_us = 500'000;

  explicit TakeOff(float duration_s) noexcept : duration_s_(duration_s) {}

  /// 0 to 1.
  float lift() const noexcept { return lift_; }
  /// True where the ground may bear it, or bears it.
  bool may_stand() const noexcept { return phase_ != Phase::air || rests_since_us_ != 0; }
  /// Goes on from a logged lift: 0 on the ground, more on the way up.
  void resume(float lift) noexcept {
    if (lift_ > lift || lift_ < lift) phase_ = lift > 0 ? Phase::air : Phase::ground;
    lift_ = lift;
  }
  /// A tick in which the controller is not asked: time does not count.
  void skip(const Situation& situation) noexcept {
    before_us_ = 0;
    wait(situation);
  }

  void update(std::uint64_t now_us, const Situation& situation, const VerticalMotion& motion) noexcept {
    constexpr std::uint64_t longest_us = 100'000;
    const std::uint64_t since_us = before_us_ == 0 ? 0 : now_us - before_us_;
    before_us_ = now_us;
    if (!situation.drives_motors) {
      wait(situation);
      return;
    }
    choose_phase(now_us, situation, motion);
    const float step_s = 1e-6f * static_cast<float>(since_us < longest_us ? since_us : longest_us);
    if (phase_ == Phase::air) {
      lift_ = duration_s_ * (1.0f - lift_) > step_s ? lift_ + step_s / duration_s_ : 1.0f;
    } else if (phase_ == Phase::touches_down) {
      lift_ = duration_s_ * lift_ > step_s ? lift_ - step_s / duration_s_ : 0.0f;
    } else {
      lift_ = 0;
    }
  }

 private:
  enum class Phase : std::uint8_t { ground, air, touches_down };

  /// Others have the motors: landed or in the air, as the stack says.
  void wait(const Situation& situation) noexcept {
    phase_ = situation.landed ? Phase::ground : Phase::air;
    lift_ = situation.landed ? 0.0f : 1.0f;
    rests_since_us_ = 0;
  }

  void choose_phase(std::uint64_t now_us, const Situation& situation, const VerticalMotion& motion) noexcept {
    if (phase_ == Phase::air) {
      const bool rests = motion.asked_sink_m_s >= least_sink_m_s && motion.expected_fall_m_s2 >= least_fall_m_s2 &&
                         motion.sink_m_s < rests_m_s && motion.sink_m_s > -rests_m_s &&
                         motion.along_m_s < rests_along_m_s;
      if (!rests) {
        rests_since_us_ = 0;
      } else if (rests_since_us_ == 0) {
        rests_since_us_ = now_us;
      } else if (now_us - rests_since_us_ >= rests_us) {
        phase_ = Phase::touches_down;
      }
      return;
    }
    rests_since_us_ = 0;
    if (motion.asks_to_climb) {
      phase_ = Phase::air;
    } else if (phase_ == Phase::touches_down) {
      if (motion.sink_m_s > falls_m_s) {
        phase_ = Phase::air;
        lift_ = 1;
      } else if (situation.landed && !(lift_ > 0)) {
        phase_ = Phase::ground;
      }
    }
  }

  float duration_s_;
  float lift_ = 1;
  Phase phase_ = Phase::air;
  std::uint64_t before_us_ = 0;
  std::uint64_t rests_since_us_ = 0;  ///< 0: it does not rest
};

}  // namespace pinnquad::autopilot::detail
