// SPDX-License-Identifier: MIT
// Spectra of two signals that were sampled together, by Welch's method: the power of each, what they have in common,
// frequency by frequency.
#pragma once

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include "pinnquad/core/scalar_math.hpp"

namespace programs {

/// Neighbouring frequencies together. Densities are one-sided, in the square of the signals' unit per Hz; the cross
/// spectrum is that of the output by the input, so that cross / input is the response.
struct SpectralBand {
  double frequency_hz = 0;  ///< mean of the band's
  double averages = 0;      ///< independent estimates that it is the mean of
  double input = 0, output = 0;
  std::complex<double> cross = 0;

  double gain() const { return std::abs(cross) / input; }
  double phase_rad() const { return std::arg(cross); }
  /// Share of the output's power that follows the input linearly, 0 to 1.
  double coherence() const { return input > 0 && output > 0 ? std::norm(cross) / (input * output) : 0; }
  /// Standard error of the gain over the gain, and of the phase in rad (Bendat & Piersol).
  double relative_error() const {
    const double c = coherence();
    return std::sqrt(std::max(0.0, 1 - c) / (2 * averages * std::max(c, 1e-9)));
  }
  /// Less than this has one chance in twenty where they have nothing in common.
  double chance_coherence() const { return averages > 1 ? 1 - std::pow(0.05, 1 / (averages - 1)) : 1; }
  /// Power of output - input.
  double difference() const { return std::max(0.0, input + output - 2 * cross.real()); }
};

/// Sums over segments of a length, half of each in the next: Hann's window, the segment's mean taken out.
class WelchSpectra {
 public:
  WelchSpectra(std::size_t length, double period_s)
      : length_(length),
        period_s_(period_s),
        window_(length),
        input_(length / 2),
        output_(length / 2),
        cross_(length / 2) {
    for (std::size_t i = 0; i < length; ++i) {
      const double angle = 2 * pinnquad::pi * static_cast<double>(i) / static_cast<double>(length);
      window_[i] = 0.5 * (1 - std::cos(angle));
      window_power_ += window_[i] * window_[i];
    }
    fft_.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  }

  static std::size_t segments_in(std::size_t samples, std::size_t length) {
    return samples < length ? 0 : 1 + (samples - length) / (length / 2);
  }

  /// Samples that follow each other without a gap; what is left behind the last segment counts for nothing.
  void add(const std::vector<double>& input, const std::vector<double>& output) {
    for (std::size_t segment = 0; segment < segments_in(input.size(), length_); ++segment) {
      const std::size_t begin = segment * (length_ / 2);
      transform(input, begin, input_lines_);
      transform(output, begin, output_lines_);
      for (std::size_t bin = 0; bin < input_.size(); ++bin) {
        input_[bin] += std::norm(input_lines_[bin]);
        output_[bin] += std::norm(output_lines_[bin]);
        cross_[bin] += std::conj(input_lines_[bin]) * output_lines_[bin];
      }
      ++segments_;
    }
  }

  std::size_t segments() const { return segments_; }

  /// Frequencies from `from_hz` up to below `to_hz`, as one band.
  SpectralBand band(double from_hz, double to_hz) const {
    SpectralBand band;
    double bins = 0;
    for (std::size_t bin = first_bin; bin < input_.size(); ++bin) {
      const double frequency_hz = static_cast<double>(bin) * step_hz();
      if (frequency_hz < from_hz || frequency_hz >= to_hz) continue;
      band.frequency_hz += frequency_hz;
      band.input += input_[bin];
      band.output += output_[bin];
      band.cross += cross_[bin];
      bins += 1;
    }
    if (bins < 1) return band;
    const double to_density = 2 * period_s_ / (window_power_ * static_cast<double>(segments_) * bins);
    band.frequency_hz /= bins;
    band.input *= to_density;
    band.output *= to_density;
    band.cross *= to_density;
    // Hann's window makes neighbouring lines alike (correlations 2/3 and 1/6), and halves of segments (1/6)
    const double lines = bins / (1 + 8.0 / 9 * (1 - 1 / bins) + (bins > 1 ? 1.0 / 18 * (1 - 2 / bins) : 0));
    band.averages = lines * static_cast<double>(segments_) / (segments_ > 1 ? 1 + 1.0 / 18 : 1);
    return band;
  }

  /// From the second line to the last below half the sampling rate, `per_octave` to an octave where lines are that
  /// close.
  std::vector<SpectralBand> bands(double per_octave = 6) const {
    std::vector<SpectralBand> result;
    const double ratio = std::pow(2.0, 1 / per_octave);
    for (double from = first_bin; from < static_cast<double>(input_.size());) {
      const double to = std::min(std::max(from + 1, std::round(from * ratio)), static_cast<double>(input_.size()));
      result.push_back(band((from - 0.5) * step_hz(), (to - 0.5) * step_hz()));
      from = to;
    }
    return result;
  }

 private:
  static constexpr std::size_t first_bin = 2;  ///< the first is bent by the mean that is taken out

  double step_hz() const { return 1 / (period_s_ * static_cast<double>(length_)); }

  void transform(const std::vector<double>& signal, std::size_t begin, std::vector<std::complex<double>>& lines) {
    double mean = 0;
    for (std::size_t i = 0; i < length_; ++i) mean += signal[begin + i] / static_cast<double>(length_);
    segment_.resize(length_);
    for (std::size_t i = 0; i < length_; ++i) segment_[i] = window_[i] * (signal[begin + i] - mean);
    fft_.fwd(lines, segment_);
  }

  std::size_t length_;
  double period_s_, window_power_ = 0;
  std::vector<double> window_, input_, output_, segment_;
  std::vector<std::complex<double>> cross_, input_lines_, output_lines_;
  std::size_t segments_ = 0;
  Eigen::FFT<double> fft_;
};

/// How a response goes in the frequencies where the output follows the input.
struct FollowedRange {
  /// Of the coherence: Tischler & Remple's rule for identification from flight tests.
  static constexpr double least_coherence = 0.6;

  double from_hz = 0, to_hz = 0;          ///< 0: nowhere
  double gain = 0, gain_error = 0;        ///< mean and standard error
  double delay_s = 0, delay_error_s = 0;  ///< of the output behind the input: phase = -2 pi f delay
};

/// Of the bands without a break whose coherence is high enough, those that reach over most octaves. Gain and delay by
/// weighted least squares.
inline FollowedRange followed_range(const std::vector<SpectralBand>& bands) {
  std::size_t first = 0, last = 0;
  double widest = 0;
  for (std::size_t begin = 0; begin < bands.size(); ++begin) {
    std::size_t end = begin;
    while (end < bands.size() && bands[end].coherence() >= FollowedRange::least_coherence) ++end;
    const double octaves = end > begin + 1 ? std::log2(bands[end - 1].frequency_hz / bands[begin].frequency_hz) : 0;
    if (octaves > widest) {
      widest = octaves;
      first = begin;
      last = end;
    }
    begin = end;
  }
  FollowedRange range;
  if (first == last) return range;
  range.from_hz = bands[first].frequency_hz;
  range.to_hz = bands[last - 1].frequency_hz;
  double gains = 0, weights = 0, turned = 0, squares = 0, before = 0;
  for (std::size_t i = first; i < last; ++i) {
    const double error = std::max(bands[i].relative_error(), 1e-6), weight = 1 / (error * error);
    gains += weight * bands[i].gain();
    weights += weight;
    double phase = bands[i].phase_rad();
    while (phase - before > pinnquad::pi) phase -= 2 * pinnquad::pi;
    while (phase - before < -pinnquad::pi) phase += 2 * pinnquad::pi;
    before = phase;
    const double turn = 2 * pinnquad::pi * bands[i].frequency_hz;
    turned -= weight * turn * phase;
    squares += weight * turn * turn;
  }
  range.gain = gains / weights;
  range.gain_error = range.gain / std::sqrt(weights);
  range.delay_s = turned / squares;
  range.delay_error_s = 1 / std::sqrt(squares);
  return range;
}

}  // namespace programs
