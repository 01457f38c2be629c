// SPDX-License-Identifier: MIT
// Sines on the accelerations asked for: what a flight must have seen before an unknown vehicle's slopes can be known.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "pinnquad/control/onboard/onboard_settings.hpp"
#include "pinnquad/dynamics/state.hpp"

namespace pinnquad {

namespace detail {
/// Amplitudes of a sum's sines.
template <class Scalar>
struct SineAmplitudes {
  Scalar slow, fast;
};
/// Within the authority of the sum. `slope`: its acceleration for each unit of it.
template <class Scalar>
SineAmplitudes<Scalar> sine_amplitudes(const typename OnboardSettings<Scalar>::Excitation& settings, std::size_t k,
                                       Scalar slope, Scalar share) noexcept {
  const auto& sines = settings.sums[k];
  const Scalar most = settings.most_of_sum * (slope < Scalar(0) ? -slope : slope);
  return {share * (sines.slow < most ? sines.slow : most), share * (sines.fast < most ? sines.fast : most)};
}

/// Time of the sines, s, after so many microseconds.
template <class Scalar>
Scalar sine_time_s(std::uint64_t since_us) noexcept {
  return Scalar(1e-6) * static_cast<Scalar>(since_us % 10'000'000);
}
}  // namespace detail

/// The accelerations to add at a time after the first: along z, m/s^2, and angular, rad/s^2. `slopes`: of the sums.
template <class Scalar>
Accelerations<Scalar> excitation(const typename OnboardSettings<Scalar>::Excitation& settings, std::uint64_t since_us,
                                 const std::array<Scalar, 4>& slopes, const std::array<Scalar, 4>& shares) noexcept {
  using std::sin;
  constexpr Scalar two_pi = Scalar(6.283185307179586);
  const Scalar t_s = detail::sine_time_s<Scalar>(since_us);
  const Scalar rises = since_us < 10'000'000 && t_s < settings.rise_s ? t_s / settings.rise_s : Scalar(1);
  Accelerations<Scalar> added;
  for (std::size_t k = 0; k < shares.size(); ++k) {
    if (!(shares[k] > Scalar(0))) continue;
    const auto& sines = settings.sums[k];
    const detail::SineAmplitudes<Scalar> amplitudes =
        detail::sine_amplitudes(settings, k, slopes[k], rises * shares[k]);
    const Scalar sum =
        amplitudes.slow * sin(two_pi * sines.slow_Hz * t_s) + amplitudes.fast * sin(two_pi * sines.fast_Hz * t_s);
    if (k == 0) {
      added.linear_m_s2[2] = sum;
    } else {
      added.angular_rad_s2[static_cast<int>(k) - 1] = sum;
    }
  }
  return added;
}

}  // namespace pinnquad
