// SPDX-License-Identifier: MIT
// Signed sums of the thrust fractions that rotors of six lags would follow, with the weights of a FlownMotion: each
// lag is a guess, and the rows of all six are regressed, until the flight says which one it is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pinnquad/control/motion_bias.hpp"
#include "pinnquad/control/rotor_follower.hpp"

namespace pinnquad::detail {

inline constexpr std::size_t lag_count = 6;
/// Where one lag does for all: the middle of the bank.
inline constexpr std::size_t reference_lag = 2;

/// Time constants, s, of the thinnest rotor to the slowest one with a state that comes late.
template <class Scalar>
inline constexpr std::array<Scalar, lag_count> lag_bank_s{Scalar(0.008), Scalar(0.014), Scalar(0.025),
                                                          Scalar(0.044), Scalar(0.075), Scalar(0.13)};

/// A lag between two of the bank: `beside` of the way from the lower one to the next.
template <class Scalar>
struct LagPlace {
  std::uint8_t lower{0};  ///< 0 to lag_count - 2
  Scalar beside{0};       ///< 0 to 1

  Scalar seconds() const noexcept { return of(lag_bank_s<Scalar>[lower], lag_bank_s<Scalar>[lower + 1u]); }
  /// Between the values of the two.
  Scalar of(Scalar at_lower, Scalar at_next) const noexcept { return at_lower + beside * (at_next - at_lower); }
};

/// The place of a lag, or the end of the bank that is nearest.
template <class Scalar>
constexpr LagPlace<Scalar> lag_place(Scalar lag_s) noexcept {
  LagPlace<Scalar> place{};
  while (place.lower + 2u < lag_count && lag_s > lag_bank_s<Scalar>[place.lower + 1u]) ++place.lower;
  const Scalar low = lag_bank_s<Scalar>[place.lower], next = lag_bank_s<Scalar>[place.lower + 1u];
  const Scalar beside = (lag_s - low) / (next - low);
  place.beside = beside < Scalar(0) ? Scalar(0) : (beside > Scalar(1) ? Scalar(1) : beside);
  return place;
}

/// A signed sum that the rotors followed.
template <class Scalar>
struct Followed {
  Scalar sum{0}, rise_1_s{0};
};

/// Means of the sums over the two periods of a FlownMotion, of each lag. It has each tick behind the motion.
template <class Scalar>
class LagBank {
 public:
  using Sums = std::array<SignedSums<Scalar>, lag_count>;

  LagBank(std::uint32_t period_us, Scalar delay_s) noexcept
      : period_us_(period_us), period_s_(Scalar(1e-6) * static_cast<Scalar>(period_us)), delayed_(Scalar(0), delay_s) {}

  /// Rotors that have settled.
  void restart(const Commands<Scalar>& fractions, const SignedMix<Scalar>& mix) noexcept {
    delayed_.restart(fractions);
    following_.fill(sums_of(fractions, mix));
    now_ = before_ = {};
  }

  /// The motion has ended a window: at() is of it until the next tick(). False where nothing was followed in it.
  bool finish() noexcept {
    const Scalar weight = before_.rising_weight + now_.falling_weight;
    if (!(weight > Scalar(0))) return false;
    const Scalar inverse = Scalar(1) / weight;
    for (std::size_t lag = 0; lag < lag_count; ++lag) {
      for (std::size_t k = 0; k < 4; ++k) {
        const Scalar rise_1_s = (now_.mean(lag, k) - before_.mean(lag, k)) / period_s_;
        means()[lag][k] = inverse * (before_.rising[lag][k] + now_.falling[lag][k]);
        rises_1_s()[lag][k] = rise_1_s;
      }
    }
    return true;
  }

  /// One tick after the motion's: the thrust fractions in force since the tick before, of `step_s`.
  void tick(std::uint64_t now_us, Scalar step_s, const Commands<Scalar>& fractions,
            const SignedMix<Scalar>& mix) noexcept {
    const std::uint64_t number = now_us / period_us_;
    if (number != number_) {
      before_ = now_;
      now_ = {};
      number_ = number;
    }
    static_cast<void>(delayed_.follow(now_us, step_s, fractions));
    const SignedSums<Scalar> sums = sums_of(delayed_.then(), mix);
    const Scalar t_s = Scalar(1e-6) * static_cast<Scalar>(now_us - number * period_us_);
    const Scalar rising = t_s * step_s, falling = (period_s_ - t_s) * step_s;
    now_.rising_weight += rising;
    now_.falling_weight += falling;
    for (std::size_t lag = 0; lag < lag_count; ++lag) {
      const Scalar share = step_s / (lag_bank_s<Scalar>[lag] + step_s);
      for (std::size_t k = 0; k < sums.size(); ++k) {
        Scalar& follows = following_[lag][k];
        follows += share * (sums[k] - follows);
        now_.rising[lag][k] += rising * follows;
        now_.falling[lag][k] += falling * follows;
      }
    }
  }

  /// The sum that rotors of a lag would follow, and how fast it rises, 1/s.
  Followed<Scalar> at(std::size_t k, std::size_t lag) const noexcept {
    return {before_.rising[lag][k], before_.falling[lag][k]};
  }
  /// The same of a lag between two of the bank.
  Followed<Scalar> at(std::size_t k, const LagPlace<Scalar>& lag) const noexcept {
    const Followed<Scalar> low = at(k, lag.lower), next = at(k, lag.lower + 1u);
    return {lag.of(low.sum, next.sum), lag.of(low.rise_1_s, next.rise_1_s)};
  }

  static SignedSums<Scalar> sums_of(const Commands<Scalar>& fractions, const SignedMix<Scalar>& mix) noexcept {
    SignedSums<Scalar> sums{};
    for (std::size_t k = 0; k < sums.size(); ++k) {
      for (std::size_t i = 0; i < fractions.size(); ++i) sums[k] += mix.signs[k][i] * fractions[i];
    }
    return sums;
  }

 private:
  struct Period {
    Scalar rising_weight{0}, falling_weight{0};
    Sums rising{}, falling{};

    Scalar mean(std::size_t lag, std::size_t k) const noexcept {
      return (rising[lag][k] + falling[lag][k]) / (rising_weight + falling_weight);
    }
  };

  /// A window that has ended is in place of its first period, which nobody asks for any more.
  Sums& means() noexcept { return before_.rising; }
  Sums& rises_1_s() noexcept { return before_.falling; }

  std::uint32_t period_us_;
  Scalar period_s_;
  std::uint64_t number_ = 0;  ///< of the period
  RotorFollower<Scalar, 12> delayed_;
  Sums following_{};
  Period now_, before_;
};

}  // namespace pinnquad::detail
