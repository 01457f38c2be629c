// SPDX-License-Identifier: MIT
// The command residual: how wrong a model has lately been about what was flown. A payload, wind or a bent rotor shows
// in it, where no feature does.
//   e = mean over the rotors of |command predicted for the measured motion - command flown|,  m <- m + factor (e - m)
#pragma once

#include <type_traits>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/core/status.hpp"
#include "pinnquad/core/types.hpp"

namespace pinnquad {

namespace detail {

/// Not detected of limits that change at run time.
template <class Trust>
using ConstantResidualLimit = std::bool_constant<(Trust::command_residual_limit > 0)>;

template <class Trust>
constexpr bool require_command_residual() noexcept {
  if constexpr (is_detected<ConstantResidualLimit, Trust>) {
    static_assert(Trust::command_residual_factor > 0 && Trust::command_residual_factor <= 1,
                  "pinnquad: the factor of a command residual's mean lies in (0, 1]");
    static_assert(is_finite_constant(double(Trust::command_residual_limit)) && Trust::command_residual_limit > 0,
                  "pinnquad: the limit of a command residual must be a positive number");
    static_assert(Trust::command_residual_limit < 1,
                  "pinnquad: the limit of a command residual lies below 1: commands are 0 to 1, and no mean error of "
                  "theirs would exceed it (docs/trust.md)");
    static_assert(
        Trust::command_residual_cleared > 0 && Trust::command_residual_cleared <= Trust::command_residual_limit,
        "pinnquad: a command residual is cleared above 0 and not above its limit");
  }
  return true;
}

}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// An alarm with hysteresis on m. Contract of `Trust`, a struct of constants that deploy/trust_writer.hpp writes:
///   double command_residual_factor, in (0, 1]
///   double command_residual_limit: the model is distrusted once m is above it
///   double command_residual_cleared, not above the limit: it is trusted again once m is below it
/// The limits hold for updates as often as those that they were fitted on
/// (training/structured/trust_limits.hpp). On the ground they may be static members that change at run time, as a
/// JointDistance's.
template <class Trust, class Scalar = float>
class CommandResidualMonitor {
 public:
  static_assert(detail::require_command_residual<Trust>());

  /// Commands predicted and flown of one instant: those that the rotors follow then, behind their lag as the training
  /// rows have it. `periods`: the number of updates that the two are means of.
  /// `not_finite` for a command that is no number; nothing changes then.
  Status update(const Commands<Scalar>& predicted, const Commands<Scalar>& flown, int periods = 1) noexcept {
    Scalar error(0);
    for (std::size_t i = 0; i < rotor_count; ++i) {
      const Scalar difference = predicted[i] < flown[i] ? flown[i] - predicted[i] : predicted[i] - flown[i];
      error += difference;
    }
    error /= Scalar(rotor_count);
    Scalar mean = mean_;
    for (int i = 0; i < periods; ++i) mean += Scalar(Trust::command_residual_factor) * (error - mean);
    // each command by itself, as -ffast-math may lose a NaN in a sum; and the sum, which may overflow
    if (!all_finite(predicted) || !all_finite(flown) || !is_finite(mean)) return Status::not_finite;
    mean_ = mean;
    if (mean_ > Scalar(Trust::command_residual_limit)) {
      trusted_ = false;
    } else if (mean_ < Scalar(Trust::command_residual_cleared)) {
      trusted_ = true;
    }
    return Status::ok;
  }

  /// False from the update that takes m over its limit to the one that takes it below where it is cleared.
  bool trusted() const noexcept { return trusted_; }
  /// m, in the unit of the commands; 0 before the first update.
  Scalar mean() const noexcept { return mean_; }
  /// Forgets: after time on the ground, for another model.
  void reset() noexcept { *this = CommandResidualMonitor(); }
  /// Goes on from what was logged.
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
