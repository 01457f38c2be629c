// SPDX-License-Identifier: MIT
// The noise of a spectrum: the level at which it stops falling. A vehicle is a low-pass, so that what it does sinks
// with frequency; a sensor's noise lies flat until the sensor's own filter ends it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "logs/power_spectrum.hpp"

namespace programs {

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

/// The floor begins with the highest run of flat octaves that begins below 30 Hz: octaves above the peak, at a tenth of
/// it or less, over which the power keeps 0.3 of itself (where one follows that keeps half, with that one). Manoeuvres
/// leave shelves further down; further up is what a sensor's own filter or a log's last digit leaves. What follows the
/// floor is noise too. All is signal where no octave is flat (a log that was filtered before it was written), all is
/// noise where nothing stands out (the largest third of an octave less than ten times the least).
/// Limits: a vibration above the floor counts as noise; motion that is itself flat over an octave just before the noise
/// hides it; noise that rises towards low frequencies (a drift) is taken for signal.
inline NoiseFloor noise_floor(const PowerSpectrum& spectrum) {
  constexpr double below_peak = 0.1, kept = 0.3, flatter = 0.5, highest_begin_Hz = 30;
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
  const auto keeps = [&](std::size_t k, double share) {
    const auto from = mean.begin() + static_cast<std::ptrdiff_t>(k);
    return mean[k]<below_peak * peak&& * std::min_element(from, from + static_cast<std::ptrdiff_t>(k) + 1)> share *
           mean[k];
  };
  std::size_t first = all_noise ? 1 : size, flat_before = 0;
  for (std::size_t k = peak_at; !all_noise && 2 * k <= last && spectrum.frequency_Hz(k) <= highest_begin_Hz; ++k) {
    if (!keeps(k, kept)) continue;
    if (first == size || 4 * k > 5 * flat_before + 4) first = k;  // after a third of an octave that was not
    flat_before = k;
  }
  for (std::size_t k = first; first < size && !all_noise && 2 * k <= last && k <= 2 * first; ++k) {
    if (!keeps(k, flatter)) continue;
    first = k;
    break;
  }
  if (first == size) return floor;
  const std::size_t end = all_noise ? last + 1 : 2 * first;
  double sum = 0;
  for (std::size_t k = first; k < end; ++k) sum += power[k];
  floor.power = sum / static_cast<double>(end - first);
  // the signal may reach a little into the octave that was found
  while (!all_noise && first + 1 < end && mean[first] > 1.5 * floor.power) ++first;
  floor.first_bin = first;
  for (std::size_t k = 0; k < size; ++k) {
    floor.noise[k] = k < first ? std::min(power[k], floor.power) : power[k];
    floor.signal[k] = power[k] - floor.noise[k];
  }
  return floor;
}

}  // namespace programs
