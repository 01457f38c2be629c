// SPDX-License-Identifier: MIT
// The answer of a vehicle to the sines that it was asked for: nothing else moves at their frequencies for long. Least
// squares of rows are sharper, but a hand, the ground, or gusts that feedback answers deceive them; these they do not.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "pinnquad/control/onboard/excitation.hpp"
#include "pinnquad/control/onboard/forward_model.hpp"

namespace pinnquad::detail {

/// A complex number.
template <class Scalar>
struct SineWave {
  Scalar real{0}, imaginary{0};
};

/// A exp(-i w t) of each sum's fast sine, A the amplitude asked for, an acceleration.
template <class Scalar>
using AskedSines = std::array<SineWave<Scalar>, 4>;
/// At `t_s` of the sines.
template <class Scalar>
AskedSines<Scalar> asked_sines(Scalar t_s, const typename OnboardSettings<Scalar>::Excitation& settings,
                               const std::array<Scalar, 4>& amplitudes) noexcept {
  using std::cos;
  using std::sin;
  constexpr Scalar two_pi = Scalar(6.283185307179586);
  AskedSines<Scalar> asked{};
  for (std::size_t k = 0; k < asked.size(); ++k) {
    const Scalar angle = two_pi * settings.sums[k].fast_Hz * t_s;
    asked[k] = {amplitudes[k] * cos(angle), -amplitudes[k] * sin(angle)};
  }
  return asked;
}

/// Fourier sums of each signed sum and of its acceleration at the frequency of its fast sine, weighted by the sine's
/// amplitude, and forgotten as rows are.
template <class Scalar>
class SineAnswer {
 public:
  /// A row and the sines that were asked for in its middle; its thrusts are behind the lag of `reference_lag`.
  void add(const AskedSines<Scalar>& asked, const SumMotion<Scalar>& motion, const LagBank<Scalar>& bank,
           Scalar keep) noexcept {
    for (std::size_t k = 0; k < 4; ++k) {
      const SineWave<Scalar>& by = asked[k];
      energy_[k] = keep * energy_[k] + (by.real * by.real + by.imaginary * by.imaginary) / Scalar(2);
      const Scalar own = bank.at(k, reference_lag).sum, a = motion.accelerations[k];
      sum_[k] = {keep * sum_[k].real + by.real * own, keep * sum_[k].imaginary + by.imaginary * own};
      acceleration_[k] = {keep * acceleration_[k].real + by.real * a,
                          keep * acceleration_[k].imaginary + by.imaginary * a};
    }
  }

  /// True where sines were asked for.
  bool asked(std::size_t k) const noexcept { return energy_[k] > least_energy; }
  /// The vehicle made this share of the acceleration that a sine asked for, against feedback: 0 to about 1.
  Scalar share(std::size_t k) const noexcept {
    using std::sqrt;
    const Wave& a = acceleration_[k];
    const Scalar made = sqrt(a.real * a.real + a.imaginary * a.imaginary);
    return asked(k) ? made / energy_[k] : Scalar(0);
  }

  /// The slope that the sines say, with a sum's lag, rise and damping: Re(a (1 + i d / w) y*) / |y|^2.
  Scalar slope(std::size_t k, const ForwardSum<Scalar>& sum,
               const typename OnboardSettings<Scalar>::Excitation& settings) const noexcept {
    const Scalar w = two_pi * settings.sums[k].fast_Hz;
    const Scalar damping = sum.theta[1];
    const Wave y = times(
        sum_[k], over(Wave{Scalar(1), w * lag_bank_s<Scalar>[reference_lag]}, Wave{Scalar(1), w * sum.lag.seconds()}));
    const Wave own = times(y, {Scalar(1), w * sum.theta[rise_term] / sum.slope()});
    const Wave a = times(acceleration_[k], {Scalar(1), damping / w});
    const Scalar square = own.real * own.real + own.imaginary * own.imaginary;
    return (a.real * own.real + a.imaginary * own.imaginary) / square;
  }

 private:
  using Wave = SineWave<Scalar>;
  static constexpr Scalar two_pi = Scalar(6.283185307179586), least_energy = Scalar(1e-6);

  static constexpr Wave times(const Wave& a, const Wave& b) noexcept {
    return {a.real * b.real - a.imaginary * b.imaginary, a.real * b.imaginary + a.imaginary * b.real};
  }
  static constexpr Wave over(const Wave& a, const Wave& b) noexcept {
    const Scalar square = b.real * b.real + b.imaginary * b.imaginary;
    return times(a, {b.real / square, -b.imaginary / square});
  }

  std::array<Wave, 4> sum_{}, acceleration_{};
  std::array<Scalar, 4> energy_{};
};

}  // namespace pinnquad::detail
