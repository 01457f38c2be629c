// SPDX-License-Identifier: MIT
#include "logs/savitzky_golay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>
#include <string>

#include <unsupported/Eigen/FFT>

#include "pinnquad/core/scalar_math.hpp"

namespace pinnquad::logs {
namespace {

void require_savitzky_golay(const SavitzkyGolay& filter, int derivative) {
  constexpr int largest_half_window = 1 << 20;
  if (filter.order >= 0 && filter.half_window >= 0 && filter.half_window <= largest_half_window &&
      filter.order <= 2 * filter.half_window && derivative >= 0 && derivative <= 2) {
    return;
  }
  throw std::invalid_argument(
      "savitzky-golay: expected an order of 0 to twice the half window and a derivative of 0 to 2, found order " +
      std::to_string(filter.order) + ", half window " + std::to_string(filter.half_window) + ", derivative " +
      std::to_string(derivative));
}

/// Orthonormal polynomials of degree 0 to `order` over the rows -m..m: P[degree][row + m]. Gram's recursion, in x = row
/// / m.
std::vector<std::vector<double>> gram_polynomials(int order, int half_window) {
  const std::size_t rows = 2 * static_cast<std::size_t>(half_window) + 1;
  std::vector<std::vector<double>> basis(static_cast<std::size_t>(order) + 1, std::vector<double>(rows, 1.0));
  const double scale = half_window > 0 ? 1.0 / half_window : 1.0;
  for (std::size_t degree = 0; degree < basis.size(); ++degree) {
    std::vector<double>& p = basis[degree];
    if (degree > 0) {
      for (std::size_t row = 0; row < rows; ++row) {
        p[row] = (static_cast<double>(row) - half_window) * scale * basis[degree - 1][row];
      }
    }
    for (int pass = 0; pass < 2; ++pass) {  // the second pass takes what rounding left of the first
      for (std::size_t lower = 0; lower < degree; ++lower) {
        double along = 0;
        for (std::size_t row = 0; row < rows; ++row) along += p[row] * basis[lower][row];
        for (std::size_t row = 0; row < rows; ++row) p[row] -= along * basis[lower][row];
      }
    }
    double squares = 0;
    for (const double value : p) squares += value * value;
    for (double& value : p) value /= std::sqrt(squares);
  }
  return basis;
}

/// The polynomials of gram_polynomials(), or their first or second derivative, at `position` rows from the centre: by
/// the same recursion, whose factors are sums over the window's rows.
std::vector<double> gram_derivatives(const std::vector<std::vector<double>>& basis, int half_window, double position,
                                     int derivative) {
  const std::size_t rows = basis[0].size(), degrees = basis.size();
  const double scale = half_window > 0 ? 1.0 / half_window : 1.0;
  const double x = position * scale;
  // values[k][d]: d-th derivative of p_k with respect to x; repeats the orthogonalisation that made p_k of x p_(k-1)
  std::vector<std::array<double, 3>> values(degrees);
  values[0] = {basis[0][0], 0, 0};
  for (std::size_t k = 1; k < degrees; ++k) {
    std::array<double, 3> next = {x * values[k - 1][0], x * values[k - 1][1] + values[k - 1][0],
                                  x * values[k - 1][2] + 2 * values[k - 1][1]};
    // x p_(k-1) = sum_l c_l p_l + c_k p_k
    std::vector<double> raw(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      raw[row] = (static_cast<double>(row) - half_window) * scale * basis[k - 1][row];
    }
    const auto along = [&](std::size_t l) {
      double sum = 0;
      for (std::size_t row = 0; row < rows; ++row) sum += raw[row] * basis[l][row];
      return sum;
    };
    for (std::size_t l = 0; l < k; ++l) {
      const double c = along(l);
      for (std::size_t d = 0; d < 3; ++d) next[d] -= c * values[l][d];
    }
    const double c = along(k);
    for (std::size_t d = 0; d < 3; ++d) values[k][d] = next[d] / c;
  }
  std::vector<double> result(degrees);
  for (std::size_t k = 0; k < degrees; ++k) {
    result[k] = values[k][static_cast<std::size_t>(derivative)] * std::pow(scale, derivative);
  }
  return result;
}

/// Mean power of the bins [k, 2^(1/3) k), at least one, k by k.
std::vector<double> third_octave_means(const std::vector<double>& power) {
  const double width = std::cbrt(2.0) - 1;
  std::vector<double> sums(power.size() + 1, 0.0), means(power.size());
  for (std::size_t i = 0; i < power.size(); ++i) sums[i + 1] = sums[i] + power[i];
  for (std::size_t k = 0; k < power.size(); ++k) {
    const std::size_t end = std::min(power.size(), k + 1 + static_cast<std::size_t>(width * static_cast<double>(k)));
    means[k] = (sums[end] - sums[k]) / static_cast<double>(end - k);
  }
  return means;
}

struct NoiseFloor {
  double power = 0;            ///< of a bin
  std::size_t first_bin = 0;   ///< from it on all is noise; the spectrum's size where nothing is
  std::vector<double> noise;   ///< power by bin: the floor below `first_bin`, the spectrum itself above
  std::vector<double> signal;  ///< power by bin: what stands above the floor
};

/// A vehicle is a low-pass, so that what it does sinks with frequency; a sensor's noise lies flat until the sensor's
/// own filter ends it. The floor begins with the highest run of flat octaves that begins below 30 Hz: octaves above the
/// peak, at a tenth of it or less, over which the power keeps 0.3 of itself (where one follows that keeps half, with
/// that one). Manoeuvres leave shelves further down; further up is what a sensor's own filter or a log's last digit
/// leaves. What follows the floor is noise too. All is signal where no octave is flat (a log that was filtered before
/// it was written), all is noise where nothing stands out (the largest third of an octave less than ten times the
/// least). Limits: a vibration above the floor counts as noise; motion that is itself flat over an octave just before
/// the noise hides it; noise that rises towards low frequencies (a drift) is taken for signal.
NoiseFloor noise_floor(const PowerSpectrum& spectrum) {
  constexpr double below_peak = 0.1, kept = 0.3, flatter = 0.5, highest_begin_Hz = 30;
  const std::vector<double>& power = spectrum.power;
  const std::size_t size = power.size();
  NoiseFloor floor;
  floor.first_bin = size;
  floor.noise.assign(size, 0.0);
  floor.signal = power;
  if (spectrum.pieces == 0 || size < 8) return floor;
  const std::vector<double> mean = third_octave_means(power);
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

/// Real factor by which a centred filter multiplies (i omega)^d / |omega|^d at a bin; the ideal is |omega|^d.
/// `wave`: of the first derivative the sine, else the cosine, of each row from the window's middle on.
double gain(const std::vector<double>& weights, int half_window, int derivative, const std::vector<double>& wave) {
  double sum = 0;
  for (int i = -half_window; i <= half_window; ++i) {
    const double at = wave[static_cast<std::size_t>(std::abs(i))];
    sum += weights[static_cast<std::size_t>(i + half_window)] * (derivative == 1 && i < 0 ? -at : at);
  }
  return derivative == 2 ? -sum : sum;
}

}  // namespace

std::vector<double> savitzky_golay_weights(const SavitzkyGolay& filter, int derivative, double position) {
  require_savitzky_golay(filter, derivative);
  const auto basis = gram_polynomials(filter.order, filter.half_window);
  const auto at = gram_derivatives(basis, filter.half_window, position, derivative);
  std::vector<double> weights(basis[0].size(), 0.0);
  for (std::size_t k = 0; k < basis.size(); ++k) {
    for (std::size_t row = 0; row < weights.size(); ++row) weights[row] += basis[k][row] * at[k];
  }
  return weights;
}

std::vector<double> savitzky_golay(const std::vector<double>& segment, double period_s, const SavitzkyGolay& filter,
                                   int derivative) {
  require_savitzky_golay(filter, derivative);
  if (!(period_s > 0)) throw std::invalid_argument("savitzky-golay: expected a period above 0 s");
  const std::size_t rows = segment.size();
  std::vector<double> result(rows, std::nan(""));
  if (rows == 0) return result;
  SavitzkyGolay fitting = filter;
  fitting.half_window = static_cast<int>(std::min(static_cast<std::size_t>(filter.half_window), (rows - 1) / 2));
  fitting.order = std::min(filter.order, 2 * fitting.half_window);
  if (fitting.order < derivative) return result;
  const auto m = static_cast<std::size_t>(fitting.half_window);
  const double unit = std::pow(period_s, derivative);
  const auto sum = [&](const std::vector<double>& weights, std::size_t first) {
    double value = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) value += weights[i] * segment[first + i];
    return value / unit;
  };
  const std::vector<double> centre = savitzky_golay_weights(fitting, derivative);
  for (std::size_t row = m; row + m < rows; ++row) result[row] = sum(centre, row - m);
  for (std::size_t row = 0; row < m; ++row) {
    const double before = static_cast<double>(row) - static_cast<double>(m);
    result[row] = sum(savitzky_golay_weights(fitting, derivative, before), 0);
    result[rows - 1 - row] = sum(savitzky_golay_weights(fitting, derivative, -before), rows - 1 - 2 * m);
  }
  return result;
}

std::vector<double> savitzky_golay(const std::vector<double>& series, const std::vector<IndexRange>& segments,
                                   double period_s, const SavitzkyGolay& filter, int derivative) {
  std::vector<double> result(series.size(), std::nan(""));
  for (const IndexRange& segment : segments) {
    const auto from = series.begin() + static_cast<std::ptrdiff_t>(segment.begin);
    const std::vector<double> part(from, from + static_cast<std::ptrdiff_t>(segment.size()));
    const std::vector<double> derived = savitzky_golay(part, period_s, filter, derivative);
    std::copy(derived.begin(), derived.end(), result.begin() + static_cast<std::ptrdiff_t>(segment.begin));
  }
  return result;
}

PowerSpectrum power_spectrum(const std::vector<double>& series, const std::vector<IndexRange>& segments,
                             double period_s, std::size_t length) {
  const std::size_t half = length / 2;
  PowerSpectrum spectrum;
  if (half < 2 || !(period_s > 0)) return spectrum;
  length = 2 * half;
  const auto rows = static_cast<double>(length);
  spectrum.step_Hz = 1 / (rows * period_s);
  spectrum.power.assign(half + 1, 0.0);
  std::vector<double> window(length), piece(length);
  double window_power = 0;
  for (std::size_t i = 0; i < length; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2 * pi * static_cast<double>(i) / rows);
    window_power += window[i] * window[i];
  }
  Eigen::FFT<double> transform;
  std::vector<std::complex<double>> waves;
  for (const IndexRange& segment : segments) {
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
      transform.fwd(waves, piece);
      for (std::size_t bin = 0; bin <= half; ++bin) {
        const double sides = bin == 0 || bin == half ? 1 : 2;
        spectrum.power[bin] += sides * std::norm(waves[bin]) / (rows * window_power);
      }
      spectrum.pieces += 1;
    }
  }
  for (double& power : spectrum.power) power /= static_cast<double>(std::max<std::size_t>(spectrum.pieces, 1));
  return spectrum;
}

SavitzkyGolayChoice choose_savitzky_golay(const std::vector<double>& series, const std::vector<IndexRange>& segments,
                                          double period_s, int derivative) {
  constexpr std::size_t shortest_piece = 32, longest_piece = 1024, most_half_window = 100;
  constexpr double longest_half_window_s = 0.5;
  SavitzkyGolayChoice choice;
  require_savitzky_golay(choice.filter, derivative);
  choice.bandwidth_Hz = 0.5 / period_s;
  std::size_t longest = 0;
  for (const IndexRange& segment : segments) longest = std::max(longest, segment.size());
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
  const auto angle_of = [&spectrum](std::size_t bin) {
    return pi * static_cast<double>(bin) / static_cast<double>(spectrum.power.size() - 1);
  };
  std::vector<std::vector<double>> waves(spectrum.power.size());
  for (std::size_t bin = 0; bin < waves.size(); ++bin) {
    for (std::size_t i = 0; i <= most; ++i) {
      const double phase = angle_of(bin) * static_cast<double>(i);
      waves[bin].push_back(derivative == 1 ? std::sin(phase) : std::cos(phase));
    }
  }
  double least = std::numeric_limits<double>::infinity();
  for (const int order : {2, 4}) {
    for (std::size_t half = static_cast<std::size_t>(order) / 2; half <= most; ++half) {
      const SavitzkyGolay filter{order, static_cast<int>(half)};
      const std::vector<double> weights = savitzky_golay_weights(filter, derivative);
      double error = 0;
      for (std::size_t bin = 0; bin < spectrum.power.size(); ++bin) {
        const double h = gain(weights, filter.half_window, derivative, waves[bin]);
        const double bias = h - std::pow(angle_of(bin), derivative);
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

}  // namespace pinnquad::logs
