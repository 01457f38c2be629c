// SPDX-License-Identifier: MIT
// Order and window of a Savitzky-Golay filter from the series itself: its spectrum says what is signal and what noise,
// and the filter whose derivative would have the least squared error is taken.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "logs/noise_floor.hpp"
#include "logs/power_spectrum.hpp"
#include "logs/savitzky_golay.hpp"

namespace programs {

struct SavitzkyGolayChoice {
  SavitzkyGolay filter;
  double noise = 0;           ///< standard deviation of the noise of a row, in the series' unit
  double bandwidth_Hz = 0;    ///< where the signal sinks into the noise; half the sampling rate where it does not
  double expected_error = 0;  ///< root of the mean square of the derivative's error inside a segment, in its unit
};

namespace detail {

/// Real factor by which a centred filter multiplies (i omega)^d / |omega|^d at a bin; the ideal is |omega|^d.
inline double gain(const std::vector<double>& weights, int half_window, int derivative, double radians_per_row) {
  double sum = 0;
  for (int i = -half_window; i <= half_window; ++i) {
    const double weight = weights[static_cast<std::size_t>(i + half_window)];
    sum += weight * (derivative == 1 ? std::sin(radians_per_row * i) : std::cos(radians_per_row * i));
  }
  return derivative == 2 ? -sum : sum;
}

}  // namespace detail

/// Takes, of orders 2 and 4 and all half windows up to an eighth of the longest segment, 0.5 s and 100 rows, the least
///   sum over frequency of (H - |omega|^d)^2 signal + H^2 noise,
/// H the filter's gain, signal and noise of noise_floor(): the expected squared error of the derivative, bias and noise
/// together, for noise of any colour that noise_floor() sees. A piece is an eighth to a sixteenth of the longest
/// segment, 1024 rows at most: of a signal slower than a piece the error is smaller than expected, and a still wider
/// window might be better. Without a segment of 32 rows: order 2, half window 2.
inline SavitzkyGolayChoice choose_savitzky_golay(const std::vector<double>& series,
                                                 const std::vector<pinnquad::IndexRange>& segments, double period_s,
                                                 int derivative) {
  constexpr std::size_t shortest_piece = 32, longest_piece = 1024, most_half_window = 100;
  constexpr double longest_half_window_s = 0.5, pi = 3.14159265358979323846;
  SavitzkyGolayChoice choice;
  detail::require_savitzky_golay(choice.filter, derivative);
  choice.bandwidth_Hz = 0.5 / period_s;
  std::size_t longest = 0;
  for (const pinnquad::IndexRange& segment : segments) longest = std::max(longest, segment.size());
  std::size_t length = shortest_piece;
  while (length < longest_piece && 16 * length <= longest) length *= 2;
  const PowerSpectrum spectrum = power_spectrum(series, segments, period_s, length);
  if (spectrum.pieces == 0) return choice;
  const NoiseFloor floor = noise_floor(spectrum);
  if (floor.first_bin < spectrum.power.size()) choice.bandwidth_Hz = spectrum.frequency_Hz(floor.first_bin);
  double noise = 0;
  for (const double power : floor.noise) noise += power;
  choice.noise = std::sqrt(noise);
  const std::size_t most =
      std::min({most_half_window, longest / 8, static_cast<std::size_t>(longest_half_window_s / period_s) + 1});
  double least = std::numeric_limits<double>::infinity();
  for (const int order : {2, 4}) {
    for (std::size_t half = static_cast<std::size_t>(order) / 2; half <= most; ++half) {
      const SavitzkyGolay filter{order, static_cast<int>(half)};
      const std::vector<double> weights = savitzky_golay_weights(filter, derivative);
      double error = 0;
      for (std::size_t bin = 0; bin < spectrum.power.size(); ++bin) {
        const double angle = pi * static_cast<double>(bin) / static_cast<double>(spectrum.power.size() - 1);
        const double h = detail::gain(weights, filter.half_window, derivative, angle);
        const double bias = h - std::pow(angle, derivative);
        error += bias * bias * floor.signal[bin] + h * h * floor.noise[bin];
      }
      if (!(error < least)) continue;
      least = error;
      choice.filter = filter;
    }
  }
  choice.expected_error = std::sqrt(least) / std::pow(period_s, derivative);
  return choice;
}

}  // namespace programs
