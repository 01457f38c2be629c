// SPDX-License-Identifier: MIT
// The commands that rotors follow: behind their lag, and as old as a state that comes late.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pinnquad/core/types.hpp"

namespace pinnquad::detail {

/// First-order lag r' = (u - r) / lag of commands in force from tick to tick, seen a delay later. `most_kept`: commands
/// that are kept beside the delay; 0: there is no delay.
template <class Scalar, std::size_t most_kept = 24>
class RotorFollower {
 public:
  static_assert(most_kept == 0 || most_kept > 3, "pinnquad: a RotorFollower with a delay keeps four commands or more");

  explicit RotorFollower(Scalar lag_s = Scalar(0), Scalar delay_s = Scalar(0)) noexcept
      : lag_s_(lag_s), delay_us_(static_cast<std::uint64_t>(Scalar(1e6) * delay_s)) {}

  /// Rotors that have settled at these commands; nothing is known of the past.
  void restart(const Commands<Scalar>& commands) noexcept {
    rotors_ = commands;
    stored_ = 0;
  }

  /// One tick: the commands in force since the tick before. False while the delay reaches back beyond the restart.
  bool follow(std::uint64_t now_us, Scalar step_s, const Commands<Scalar>& commands) noexcept {
    const Scalar share = step_s / (lag_s_ + step_s);
    for (std::size_t i = 0; i < commands.size(); ++i) rotors_[i] += share * (commands[i] - rotors_[i]);
    if constexpr (most_kept > 0) {
      if (delay_us_ == 0) return true;
      // at most one in each of the clock's intervals, so that a replay of a part of the ticks keeps the same ones
      const std::uint64_t interval_us = delay_us_ / (most_kept - 3) + 1;
      if (stored_ == 0 || now_us / interval_us != kept(stored_ - 1).time_us / interval_us) {
        if (stored_ == most_kept) drop_oldest();
        kept(stored_++) = {now_us, rotors_};
      }
      while (stored_ > 1 && kept(1).time_us + delay_us_ <= now_us) drop_oldest();
      return kept(0).time_us + delay_us_ <= now_us;
    } else {
      return true;
    }
  }

  /// The commands that the rotors followed a delay ago.
  const Commands<Scalar>& then() const noexcept {
    if constexpr (most_kept > 0) return delay_us_ == 0 ? rotors_ : kept_[oldest_].commands;
    return rotors_;
  }

 private:
  struct Kept {
    std::uint64_t time_us;
    Commands<Scalar> commands;
  };

  Kept& kept(std::size_t i) noexcept { return kept_[(oldest_ + i) % most_kept]; }
  void drop_oldest() noexcept {
    oldest_ = (oldest_ + 1) % most_kept;
    --stored_;
  }

  Scalar lag_s_;
  std::uint64_t delay_us_;
  Commands<Scalar> rotors_{};
  std::array<Kept, most_kept> kept_{};  ///< the last `stored_` from `oldest_` on
  std::size_t oldest_ = 0, stored_ = 0;
};

}  // namespace pinnquad::detail
