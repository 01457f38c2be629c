// SPDX-License-Identifier: MIT
// How the power of a series is spread over frequency: mean periodogram of overlapping pieces (Welch), never across a
// gap.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pinnquad/data/split.hpp"

namespace programs {

/// Power of each bin k, k = 0..size-1, at frequency k step_Hz, up to half the sampling rate: of white noise of variance
/// s^2 each has s^2 / (size - 1) (its two ends half that), so that the sum is the variance of the series without its
/// trend.
struct PowerSpectrum {
  double step_Hz = 0;
  std::vector<double> power;
  std::size_t pieces = 0;  ///< periodograms in the mean; 0: no segment is long enough

  double frequency_Hz(std::size_t bin) const noexcept { return static_cast<double>(bin) * step_Hz; }
};

/// Pieces of `length` rows (even), half over each other, without their own straight line, under a Hann window.
/// Source: Welch (1967).
inline PowerSpectrum power_spectrum(const std::vector<double>& series,
                                    const std::vector<pinnquad::IndexRange>& segments, double period_s,
                                    std::size_t length) {
  constexpr double pi = 3.14159265358979323846;
  const std::size_t half = length / 2;
  PowerSpectrum spectrum;
  if (half < 2 || !(period_s > 0)) return spectrum;
  length = 2 * half;
  const auto rows = static_cast<double>(length);
  spectrum.step_Hz = 1 / (rows * period_s);
  spectrum.power.assign(half + 1, 0.0);
  std::vector<double> cosine(length), sine(length), window(length), piece(length);
  double window_power = 0;
  for (std::size_t i = 0; i < length; ++i) {
    cosine[i] = std::cos(2 * pi * static_cast<double>(i) / rows);
    sine[i] = std::sin(2 * pi * static_cast<double>(i) / rows);
    window[i] = 0.5 - 0.5 * cosine[i];
    window_power += window[i] * window[i];
  }
  for (const pinnquad::IndexRange& segment : segments) {
    for (std::size_t first = segment.begin; first + length <= segment.end; first += half) {
      double mean = 0, slope = 0;
      for (std::size_t i = 0; i < length; ++i) mean += series[first + i] / rows;
      for (std::size_t i = 0; i < length; ++i) {
        slope += (static_cast<double>(i) - (rows - 1) / 2) * (series[first + i] - mean);
      }
      slope *= 12 / (rows * (rows * rows - 1));
      for (std::size_t i = 0; i < length; ++i) {
        piece[i] = window[i] * (series[first + i] - mean - slope * (static_cast<double>(i) - (rows - 1) / 2));
      }
      for (std::size_t bin = 0; bin <= half; ++bin) {
        double real = 0, imaginary = 0;
        for (std::size_t i = 0, phase = 0; i < length; ++i) {
          real += piece[i] * cosine[phase];
          imaginary += piece[i] * sine[phase];
          phase += bin;
          if (phase >= length) phase -= length;
        }
        const double sides = bin == 0 || bin == half ? 1 : 2;
        spectrum.power[bin] += sides * (real * real + imaginary * imaginary) / (rows * window_power);
      }
      spectrum.pieces += 1;
    }
  }
  for (double& power : spectrum.power) power /= static_cast<double>(std::max<std::size_t>(spectrum.pieces, 1));
  return spectrum;
}

}  // namespace programs
