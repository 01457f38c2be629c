// SPDX-License-Identifier: MIT
// The time between the ticks of a loop.
#pragma once

#include <cstdint>

namespace pinnquad::detail {

/// Counts on a clock of microseconds.
template <class Scalar>
class TickClock {
 public:
  /// Since the tick before, s; 0 for the first one, and where the clock does not rise.
  Scalar step_s(std::uint64_t now_us) noexcept {
    const bool rises = before_us_ != 0 && now_us > before_us_;
    const Scalar step = rises ? Scalar(1e-6) * static_cast<Scalar>(now_us - before_us_) : Scalar(0);
    before_us_ = now_us;
    return step;
  }

 private:
  std::uint64_t before_us_ = 0;
};

}  // namespace pinnquad::detail
