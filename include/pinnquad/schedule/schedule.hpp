// SPDX-License-Identifier: MIT
// Schedules and learning-rate policies. Their contracts, each one function that is const and noexcept:
//   double weight(int epoch, int epochs)   schedule: the weight of a loss term; epochs count from 0
//   double factor(double done)             rate: a factor of the optimiser's learning rate
// `done` is the share of all training steps already taken, from 0 in the first to just below 1 in the last.
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/schedule/settings.hpp"

namespace pinnquad {

/// The epoch that is being trained.
struct Progress {
  int epoch = 0;  ///< from 0
  int epochs = 1;
};

namespace detail {
template <class T>
using WeightOf = std::enable_if_t<noexcept(std::declval<const T&>().weight(0, 1)) &&
                                  std::is_convertible_v<decltype(std::declval<const T&>().weight(0, 1)), double>>;
template <class T>
using FactorOf = std::enable_if_t<noexcept(std::declval<const T&>().factor(0.5)) &&
                                  std::is_convertible_v<decltype(std::declval<const T&>().factor(0.5)), double>>;
}  // namespace detail

/// True for a type that fulfils the schedule's contract at the head of this file.
template <class T>
inline constexpr bool is_schedule = is_detected<detail::WeightOf, T>;

/// True for a type that fulfils the rate's contract at the head of this file.
template <class T>
inline constexpr bool is_rate = is_detected<detail::FactorOf, T>;

/// Schedule: the same weight in every epoch.
struct Constant {
  double value = 0.1;  ///< the paper's lambda_max

  constexpr double weight(int /*epoch*/, int /*epochs*/) const noexcept { return value; }

  /// Throws std::invalid_argument unless the weight is a finite number from 0.
  constexpr void check() const { detail::expect_from_zero("Constant::value", value); }
};

/// Schedule of Eq. (6): the weight is held, then falls linearly, and starts anew each cycle (Fig. 3).
/// beta = mod(k, P) / P with P = ceil(T / M): lambda_max while beta <= R, then (1 - beta) / (1 - R) lambda_max.
/// k is the epoch from 0, T the epochs. It never reaches 0: a cycle's last epoch has lambda_max / (P (1 - R)). R = 1
/// means constant; the last cycle may be cut short (docs/paper.md, deviation 11). Fewer than one cycle give NaN;
/// check() refuses them.
struct CyclicalAnnealing {
  double maximum = 0.1;  ///< lambda_max
  int cycles = 5;        ///< M
  double hold = 0.5;     ///< R, the share of a cycle at lambda_max

  constexpr double weight(int epoch, int epochs) const noexcept {
    if (cycles < 1) return std::numeric_limits<double>::quiet_NaN();
    if (epochs < 1) return maximum;
    const int period = (epochs - 1) / cycles + 1;
    const double beta = static_cast<double>(epoch % period) / period;
    return beta <= hold ? maximum : (1.0 - beta) / (1.0 - hold) * maximum;
  }

  /// Throws std::invalid_argument unless the maximum is a finite number from 0, cycles >= 1 and 0 <= hold <= 1.
  constexpr void check() const {
    detail::expect_from_zero("CyclicalAnnealing::maximum", maximum);
    if (cycles < 1) detail::refuse_setting("CyclicalAnnealing::cycles", "a number from 1", cycles);
    if (!(hold >= 0.0 && hold <= 1.0)) {
      detail::refuse_setting("CyclicalAnnealing::hold", "a share from 0 to 1", hold);
    }
  }
};

/// Rate: half a cosine from the full learning rate to 0 (Loshchilov and Hutter 2017, without restarts).
/// (1 + cos(pi t / T)) / 2 in step t of T, from 0: PyTorch's CosineAnnealingLR with T_max = T, stepped once per batch.
struct CosineDecay {
  double factor(double done) const noexcept { return 0.5 * (1.0 + std::cos(pi * done)); }
};

}  // namespace pinnquad
