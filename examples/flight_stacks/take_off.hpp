// SPDX-License-Identifier: MIT
// How much of its thrust a controller uses while it leaves the ground. On the ground the rotors idle until a set point asks to go
// up; then thrust comes over a while, in the air too until all of it is there. Who takes over a vehicle in the air has it all.
#pragma once

#include "flight_stacks/situation.hpp"

namespace flight_stacks {

class TakeOff {
 public:
  explicit TakeOff(float duration_s) noexcept : duration_s_(duration_s) {}

  float duration_s() const noexcept { return duration_s_; }
  /// 0 to 1.
  float lift() const noexcept { return lift_; }
  void resume(float lift) noexcept { lift_ = lift; }
  /// Nothing is asked of the controller: time does not count.
  void skip() noexcept { before_us_ = 0; }

  void update(std::uint64_t now_us, const Situation& situation, bool asks_to_climb) noexcept {
    constexpr std::uint64_t longest_us = 100'000;
    const std::uint64_t since_us = before_us_ == 0 ? 0 : now_us - before_us_;
    before_us_ = now_us;
    if (!situation.drives_motors) {
      lift_ = situation.landed ? 0.0f : 1.0f;
    } else if (situation.landed && !asks_to_climb) {
      lift_ = 0;
    } else {
      const float step_s = 1e-6f * static_cast<float>(since_us < longest_us ? since_us : longest_us);
      lift_ = duration_s_ * (1.0f - lift_) > step_s ? lift_ + step_s / duration_s_ : 1.0f;
    }
  }

 private:
  float duration_s_;
  float lift_ = 1;
  std::uint64_t before_us_ = 0;
};

}  // namespace flight_stacks
