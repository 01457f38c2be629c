// SPDX-License-Identifier: MIT
// Smoothed values and derivatives of a series on a uniform clock: in a window that slides over it, the least-squares
// polynomial. At the ends the same window's polynomial is evaluated off its centre: no sample is made up, none outside
// the segment is read. Order and window come from the series: its spectrum says what is signal and what noise, and the
// filter whose derivative would have the least squared error is taken.
#pragma once

#include <cstddef>
#include <vector>

#include "pinnquad/data/split.hpp"

namespace pinnquad::logs {

/// A polynomial of `order` over 2 `half_window` + 1 rows.
struct SavitzkyGolay {
  int order = 2;
  int half_window = 2;  ///< rows on each side; 2 half_window >= order
};

/// Rows at an end of a segment whose polynomial is evaluated off its centre: their noise is larger, see
/// savitzky_golay_weights().
constexpr std::size_t edge_rows(const SavitzkyGolay& filter) noexcept {
  return static_cast<std::size_t>(filter.half_window);
}

/// h_i, i = -m..m, with y^(d)(position) = sum_i h_i y_i / period^d for y the least-squares polynomial: h_i = sum_k
/// p_k(i) p_k^(d)(position), p_k orthonormal over the window. Of noise of variance s^2, white, sum_i h_i^2 s^2 /
/// period^2d remains; it grows towards the window's ends. `position` in rows from the centre, -m..m. Throws
/// std::invalid_argument for a filter that is none.
/// Source: Savitzky, Golay (1964); off the centre: Gorry (1990).
std::vector<double> savitzky_golay_weights(const SavitzkyGolay& filter, int derivative, double position = 0);

/// The d-th derivative, 1/s^d, of each row of a segment that has no gap and no NaN. A segment shorter than the window
/// gets a window that fits into it, and an order that fits the window; one row has no derivative: NaN. Throws
/// std::invalid_argument for a filter or a period that is none.
std::vector<double> savitzky_golay(const std::vector<double>& segment, double period_s, const SavitzkyGolay& filter,
                                   int derivative);

/// Segment by segment; rows in none of them are NaN.
std::vector<double> savitzky_golay(const std::vector<double>& series, const std::vector<IndexRange>& segments,
                                   double period_s, const SavitzkyGolay& filter, int derivative);

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
PowerSpectrum power_spectrum(const std::vector<double>& series, const std::vector<IndexRange>& segments,
                             double period_s, std::size_t length);

struct SavitzkyGolayChoice {
  SavitzkyGolay filter;
  double noise = 0;           ///< standard deviation of the noise of a row, in the series' unit
  double bandwidth_Hz = 0;    ///< where the signal sinks into the noise; half the sampling rate where it does not
  double expected_error = 0;  ///< root of the mean square of the derivative's error inside a segment, in its unit
};

/// Takes, of orders 2 and 4 and all half windows up to an eighth of the longest segment, 0.5 s and 100 rows, the least
///   sum over frequency of (H - |omega|^d)^2 signal + H^2 noise,
/// H the filter's gain, signal and noise of the series: the expected squared error of the derivative, bias and noise
/// together, for noise of any colour. A piece is an eighth to a sixteenth of the longest
/// segment, 1024 rows at most: of a signal slower than a piece the error is smaller than expected, and a still wider
/// window might be better. Without a segment of 32 rows: order 2, half window 2.
SavitzkyGolayChoice choose_savitzky_golay(const std::vector<double>& series, const std::vector<IndexRange>& segments,
                                          double period_s, int derivative);

}  // namespace pinnquad::logs
