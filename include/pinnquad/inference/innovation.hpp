// SPDX-License-Identifier: MIT
// The innovation: how wrong a model has lately been about what was flown. A payload, wind or a bent rotor shows in it,
// where no feature does.
//   e = mean over the rotors of |command predicted for the measured motion - command flown|,  m <- m + factor (e - m)
#pragma once

#include <type_traits>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/core/status.hpp"
#include "pinnquad/core/types.hpp"

namespace pinnquad {

namespace detail {

/// False of limits that a program reads while it runs, in static members that are no constants.
template <class Trust, class = void>
struct IsConstantTrust : std::false_type {};
template <class Trust>
struct IsConstantTrust<Trust, std::void_t<std::bool_constant<(Trust::innovation_limit > 0)>>> : std::true_type {};

template <class Trust>
constexpr bool require_innovation() noexcept {
  if constexpr (IsConstantTrust<Trust>::value) {
    static_assert(Trust::innovation_factor > 0 && Trust::innovation_factor <= 1,
                  "pinnquad: the factor of an innovation's mean lies in (0, 1]");
    static_assert(is_finite_constant(double(Trust::innovation_limit)) && Trust::innovation_limit > 0,
                  "pinnquad: the limit of an innovation must be a positive number");
    static_assert(Trust::innovation_limit < 1,
                  "pinnquad: the limit of an innovation lies below 1: commands are 0 to 1, and no mean error of theirs "
                  "would exceed it (docs/trust.md)");
    static_assert(Trust::innovation_cleared > 0 && Trust::innovation_cleared <= Trust::innovation_limit,
                  "pinnquad: an innovation is cleared above 0 and not above its limit");
  }
  return true;
}

}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// An alarm with hysteresis on m. `Trust`, constants: double innovation_factor, in (0, 1]; innovation_limit, the mean
/// above which the model is distrusted; innovation_cleared, not above the limit, below which it is trusted again. They
/// hold for updates as often as those that they were fitted on (training/structured/trust_limits.hpp). As a
/// JointDistance's they may be read while a program on the ground runs.
template <class Trust, class Scalar = float>
class InnovationMonitor {
  static_assert(detail::require_innovation<Trust>());

 public:
  /// Of the same instant, the commands that the rotors follow then (behind their lag as the training rows have it).
  /// `not_finite` for a command that is no number, and then nothing changes. `periods`: how many updates the two are means of.
  Status update(const Commands<Scalar>& predicted, const Commands<Scalar>& flown, int periods = 1) noexcept {
    Scalar error(0);
    for (std::size_t i = 0; i < rotor_count; ++i) {
      const Scalar difference = predicted[i] < flown[i] ? flown[i] - predicted[i] : predicted[i] - flown[i];
      error += difference;
    }
    error /= Scalar(rotor_count);
    Scalar mean = mean_;
    for (int i = 0; i < periods; ++i) mean += Scalar(Trust::innovation_factor) * (error - mean);
    // each command by itself, as -ffast-math may lose a NaN in a sum; and the sum, which may overflow
    if (!all_finite(predicted) || !all_finite(flown) || !is_finite(mean)) return Status::not_finite;
    mean_ = mean;
    if (mean_ > Scalar(Trust::innovation_limit)) {
      trusted_ = false;
    } else if (mean_ < Scalar(Trust::innovation_cleared)) {
      trusted_ = true;
    }
    return Status::ok;
  }

  /// False from the update that takes the mean over the limit to the one that takes it below where it is cleared.
  bool trusted() const noexcept { return trusted_; }
  /// m, in the unit of the commands; 0 before the first update.
  Scalar mean() const noexcept { return mean_; }
  /// Forgets: a vehicle that was on the ground, another model.
  void reset() noexcept { *this = InnovationMonitor(); }
  /// Goes on from what was written down.
  void resume(Scalar mean, bool trusted) noexcept {
    if (!is_finite(mean)) return;
    mean_ = mean;
    trusted_ = trusted;
  }

 private:
  Scalar mean_{0};
  bool trusted_{true};
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
