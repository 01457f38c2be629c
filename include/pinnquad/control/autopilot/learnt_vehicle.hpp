// SPDX-License-Identifier: MIT
// The vehicle that an autopilot's core learns (control/onboard/), beside its model.
#pragma once

#include <cstdint>

#include "pinnquad/control/autopilot/core_record.hpp"
#include "pinnquad/control/autopilot/inputs.hpp"
#include "pinnquad/control/onboard/onboard_inverse.hpp"

namespace pinnquad::autopilot::detail {

/// `Onboard`: OnboardInverse<float>.
template <class Onboard>
class LearntVehicle {
 public:
  LearntVehicle(const Airframe<float>& start, const CoreSettings& settings) noexcept
      : onboard_(start, onboard_settings(settings)) {}

  const Onboard& onboard() const noexcept { return onboard_; }
  Onboard& onboard() noexcept { return onboard_; }
  /// CoreRecord::learnt.
  unsigned bits() const noexcept {
    unsigned bits = seen_flight_ ? CoreRecord::seen_flight : 0u;
    for (std::size_t k = 0; k < 4; ++k) bits |= onboard_.certificate()[k].proven ? 1u << k : 0u;
    return bits;
  }

  /// A tick. True where the model answers again.
  bool hands_back(std::uint64_t now_us, Learning use) noexcept {
    step_us_ = now_us - learnt_us_;
    learnt_us_ = now_us;
    const bool learns = use != Learning::off, before = learnt_before_;
    learnt_before_ = learns;
    return before && !learns;
  }
  /// The same tick, where it is used. Sines last for ten seconds of flight.
  void learn(std::uint64_t now_us, Learning use, bool known, const State<float>& state,
             const Commands<float>& commands) noexcept {
    constexpr std::uint64_t longest_us = 100'000, excited_for_us = 10'000'000;
    if (use != Learning::excites) {
      excited_us_ = 0;
    } else if (known) {
      excited_us_ += step_us_ < longest_us ? step_us_ : longest_us;
    }
    onboard_.excite(use == Learning::excites && excited_us_ < excited_for_us);
    onboard_.freeze(use == Learning::frozen);
    onboard_.learn(now_us, known, state, commands);
    seen_flight_ = seen_flight_ || known;
  }
  /// True once for each row more, and for each change of use: the limits of what flies are others.
  bool another_vehicle(bool learns) noexcept {
    const std::uint32_t rows = learns ? onboard_.rows() + 1 : 0;
    const bool another = rows != limits_rows_;
    limits_rows_ = rows;
    return another;
  }

 private:
  static OnboardSettings<float> onboard_settings(const CoreSettings& settings) noexcept {
    OnboardSettings<float> onboard;
    if (settings.state_delay_s > 0) onboard.delay_s = settings.state_delay_s;
    return onboard;
  }

  Onboard onboard_;
  std::uint64_t learnt_us_ = 0, step_us_ = 0, excited_us_ = 0;
  std::uint32_t limits_rows_ = 0;  ///< the limits are those after one row less; 0: of the airframe
  bool learnt_before_ = false, seen_flight_ = false;
};

/// None: a controller that pays nothing for it.
template <>
class LearntVehicle<void> {
 public:
  LearntVehicle(const Airframe<float>&, const CoreSettings&) noexcept {}
  unsigned bits() const noexcept { return 0; }
};

}  // namespace pinnquad::autopilot::detail
