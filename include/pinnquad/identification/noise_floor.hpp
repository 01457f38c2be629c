// SPDX-License-Identifier: MIT
// What of a spectrum is noise: the level at which it stops falling. A vehicle is a low-pass, so that what it does sinks with
// frequency; a sensor's noise lies flat until the sensor's own filter ends it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pinnquad/identification/power_spectrum.hpp"

namespace pinnquad {

struct NoiseFloor {
  double power = 0;            ///< of a bin
  std::size_t first_bin = 0;   ///< from it on all is noise; the spectrum's size where nothing is
  std::vector<double> noise;   ///< power by bin: the floor below `first_bin`, the spectrum itself above
  std::vector<double> signal;  ///< power by bin: what stands above the floor
};

namespace detail {

/// Mean power of the bins [k, 2^(1/3) k), at least one, k by k.
inline std::vector<double> third_octave_means(const std::vector<double>& power) {
  const double width = std::cbrt(2.0) - 1;
  std::vector<double> sums(power.size() + 1, 0.0), means(power.size());
  for (std::size_t i = 0; i < power.size(); ++i) sums[i + 1] = sums[i] + power[i];
  for (std::size_t k = 0; k < power.size(); ++k) {
    const std::size_t end = std::min(power.size(), k + 1 + static_cast<std::size_t>(width * static_cast<double>(k)));
    means[k] = (sums[end] - sums[k]) / static_cast<double>(end - k);
  }
  return means;
}

}  // namespace detail

/// The floor is the lowest octave above the peak, at a tenth of the peak or less, over which the power halves at most, and what
/// follows it as flat. All is signal where no octave is flat (a log that was filtered before it was written), all is
/// noise where nothing stands out of it (the largest third of an octave less than ten times the least).
/// Limits: a vibration above the floor counts as noise; a signal that is itself flat over an octave a tenth below its peak is
/// taken for noise; noise that rises towards low frequencies (a drift) is taken for signal.
inline NoiseFloor noise_floor(const PowerSpectrum& spectrum) {
  constexpr double below_peak = 0.1, halves = 0.5;
  const std::vector<double>& power = spectrum.power;
  const std::size_t size = power.size();
  NoiseFloor floor;
  floor.first_bin = size;
  floor.noise.assign(size, 0.0);
  floor.signal = power;
  if (spectrum.pieces == 0 || size < 8) return floor;
  const std::vector<double> mean = detail::third_octave_means(power);
  const auto last = size - 2;  // half the sampling rate itself has half the power of its neighbours
  const auto peak_at = static_cast<std::size_t>(std::max_element(mean.begin() + 1, mean.end() - 1) - mean.begin());
  const double peak = mean[peak_at], least = *std::min_element(mean.begin() + 1, mean.end() - 1);
  if (!(peak > 0)) return floor;
  const bool all_noise = least > below_peak * peak;
  std::size_t first = all_noise ? 1 : size, end = all_noise ? last + 1 : size;
  for (std::size_t k = peak_at; !all_noise && 2 * k <= last; ++k) {
    if (!(mean[k] < below_peak * peak) || !(mean[2 * k] > halves * mean[k])) continue;
    if (!(*std::min_element(mean.begin() + static_cast<std::ptrdiff_t>(k),
                            mean.begin() + static_cast<std::ptrdiff_t>(2 * k)) > halves * mean[k])) {
      continue;
    }
    first = k;
    for (end = 2 * k; end <= last && mean[end] > halves * mean[first];) ++end;
    break;
  }
  if (first == size) return floor;
  std::vector<double> flat(power.begin() + static_cast<std::ptrdiff_t>(first),
                           power.begin() + static_cast<std::ptrdiff_t>(end));
  double sum = 0;
  for (const double value : flat) sum += value;
  floor.power = sum / static_cast<double>(flat.size());
  // the signal may reach a little into the octave that was found
  while (first < end && !all_noise && mean[first] > 1.5 * floor.power) ++first;
  floor.first_bin = first;
  for (std::size_t k = 0; k < size; ++k) {
    floor.noise[k] = k < first ? std::min(power[k], floor.power) : power[k];
    floor.signal[k] = power[k] - floor.noise[k];
  }
  return floor;
}

}  // namespace pinnquad
