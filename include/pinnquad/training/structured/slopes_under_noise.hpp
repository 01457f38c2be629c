// SPDX-License-Identifier: MIT
// The slopes of a monotone base (closed_form.hpp) with standard errors, and by instruments where the noise of gyro and
// accelerometer bends those of least squares (regression/instrumental_variables.hpp). Instruments are the noisy
// features themselves, a moment before and after: the motion goes on, white noise does not.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "pinnquad/features/windowed.hpp"
#include "pinnquad/regression/block_regression.hpp"
#include "pinnquad/regression/instrumental_variables.hpp"
#include "pinnquad/training/structured/closed_form.hpp"
#include "pinnquad/training/structured/measured_slope.hpp"

namespace pinnquad {

/// A feature of which noise bends a slope, as the rows before and after tell it.
struct DenoisedFeature {
  int place = 0;
  /// Of the standardised features, then of the noisy ones before and after; the noisy ones of now count nothing.
  AffineMap by_neighbours;
};

/// Of a monotone base.
struct MeasuredSlopes {
  SlopesOfSums of;
  std::vector<int> noisy;                 ///< MonotoneShape::noisy
  std::vector<DenoisedFeature> denoised;  ///< of the slopes by instruments
  bool by_instruments() const { return !denoised.empty(); }
};

namespace detail {

/// Time from a row to its instruments, s: past a sensor's filter, within the motion.
inline constexpr double instrument_lag_s = 0.1;

/// Calls `visit(flight, row, x, before, after)` for each row whose neighbours are in the same piece, without a gap
/// between: features in physical units. They are instrument_lag_s away, two rows at least.
template <class Features, class Visit>
void each_with_neighbours(const RowSet& rows, const Visit& visit) {
  using Vector = std::array<double, static_cast<std::size_t>(Features::size)>;
  for (const FlightRows& piece : rows.pieces()) {
    const RowSet one(*piece.flight, piece.rows);
    const double period_s = sample_period_s(one);
    if (!(period_s > 0)) continue;
    const auto lag = static_cast<std::size_t>(std::max(2.0, std::ceil(instrument_lag_s / period_s - 0.01)));
    const double longest_s = 1.1 * static_cast<double>(lag) * period_s;
    const auto near = [&](std::size_t first, std::size_t last) {
      return last - first == lag && (*piece.flight)[last].time_s - (*piece.flight)[first].time_s <= longest_s;
    };
    std::vector<std::size_t> at;
    std::vector<Vector> x;
    each_features<Features, double>(one, [&](const Flight&, std::size_t row, const Vector& features) {
      at.push_back(row);
      x.push_back(features);
    });
    for (std::size_t i = lag; i + lag < x.size(); ++i) {
      if (near(at[i - lag], at[i]) && near(at[i], at[i + lag])) {
        visit(*piece.flight, at[i], x[i], x[i - lag], x[i + lag]);
      }
    }
  }
}

/// Standardised features, then the noisy ones before and after.
template <class Scales, class Vector>
std::vector<double> with_instruments(const Scales& scales, const std::vector<int>& noisy, const Vector& x,
                                     const Vector& before, const Vector& after) {
  std::vector<double> all;
  const auto add = [&](const Vector& from, std::size_t i) {
    all.push_back((from[i] - static_cast<double>(scales.mean[i])) / static_cast<double>(scales.standard_deviation[i]));
  };
  for (std::size_t i = 0; i < x.size(); ++i) add(x, i);
  for (const Vector* from : {&before, &after}) {
    for (const int i : noisy) add(*from, static_cast<std::size_t>(i));
  }
  return all;
}

/// Sums of these over blocks of consecutive rows: fifty, of two seconds at least.
template <class ContextType>
std::vector<RegressionSums> instrumented_blocks(const ContextType& context, const RowSet& rows,
                                                const std::vector<int>& noisy) {
  constexpr double most = 50, least_s = 2;
  using Features = typename ContextType::Features;
  const auto setting = context.template output_setting<typename ContextType::Outputs, double>();
  const RegressionSums none(Features::size + 2 * static_cast<int>(noisy.size()), ContextType::output_count);
  const double period_s = sample_period_s(rows);
  const double length = std::max(static_cast<double>(rows.size()) / most, period_s > 0 ? least_s / period_s : 0.0);
  std::vector<RegressionSums> blocks;
  each_with_neighbours<Features>(
      rows, [&](const Flight& flight, std::size_t row, const auto& x, const auto& before, const auto& after) {
        auto y = sample_outputs<ContextType>(x, flight[row], setting);
        context.output.standardise(y.data(), y.data());
        if (blocks.empty() || blocks.back().rows() >= length) blocks.push_back(none);
        blocks.back().add(with_instruments(context.input, noisy, x, before, after).data(), y.data());
      });
  return blocks;
}

/// The roles of the inputs for one output.
inline InstrumentRoles instrument_roles(const MonotoneShape& shape, const std::vector<bool>& taken) {
  InstrumentRoles roles;
  const int count = static_cast<int>(shape.noisy.size());
  for (int i = 0; i < shape.inputs; ++i) {
    if (!taken[static_cast<std::size_t>(i)]) continue;
    const auto found = std::find(shape.noisy.begin(), shape.noisy.end(), i);
    if (found == shape.noisy.end()) {
      roles.exact.push_back(i);
      continue;
    }
    roles.noisy.push_back(i);
    const int before = shape.inputs + static_cast<int>(found - shape.noisy.begin());
    roles.instruments.insert(roles.instruments.end(), {before, before + count});
  }
  return roles;
}

/// A noisy feature as the others that `told` names, and the noisy ones of the neighbours, tell it:
/// DenoisedFeature::by_neighbours. `all`: of instrumented_blocks().
inline AffineMap by_neighbours(const MonotoneShape& shape, const std::vector<int>& noisy, const RegressionSums& all,
                               int place, std::vector<bool> told) {
  for (const int feature : noisy) told[static_cast<std::size_t>(feature)] = false;
  for (const int first : shape.places) {
    for (int i = 0; i < 3; ++i) told[static_cast<std::size_t>(first + i)] = false;
  }
  return fit_ridge(all.of_input(place), smallest_penalty(), told);
}

/// The specific force along the thrust axis at each tap of a window, as what the neighbours' windows have
/// instrument_lag_s off this tap tells it. `all`: of instrumented_blocks(), MonotoneShape::thrusts the noisy ones.
template <class Features>
std::vector<DenoisedFeature> denoised_taps(const MonotoneShape& shape, const RegressionSums& all) {
  using Window = typename Features::Window;
  const int taps = static_cast<int>(shape.thrusts.size());
  const auto time_s = [](int tap) { return tap == 0 ? 0.0 : Window::offset_s(tap - 1); };
  std::vector<DenoisedFeature> denoised;
  for (int tap = 0; tap < taps; ++tap) {
    std::vector<bool> told(static_cast<std::size_t>(all.inputs()), true);
    for (int i = 0; i < 2 * taps; ++i) {
      const double lag_s = i < taps ? -instrument_lag_s : instrument_lag_s;
      told[static_cast<std::size_t>(shape.inputs + i)] =
          std::abs(time_s(i % taps) + lag_s - time_s(tap)) > instrument_lag_s - Window::tolerance_s;
    }
    const int place = shape.thrusts[static_cast<std::size_t>(tap)];
    denoised.push_back({place, by_neighbours(shape, shape.thrusts, all, place, told)});
  }
  return denoised;
}

}  // namespace detail

/// Calls `visit(row, x)` for each row whose neighbours are at hand, counted through the set: features in physical
/// units, those that bend a slope as the neighbours tell them. Rows to judge a model by whose slopes are by
/// instruments: on the noisy ones the worse model errs less. `scales`: of a trained model's features.
template <class Features, class Scales, class Visit>
void each_denoised(const Scales& scales, const MeasuredSlopes& slopes, const RowSet& rows, const Visit& visit) {
  std::size_t first = 0;
  for (const FlightRows& piece : rows.pieces()) {
    detail::each_with_neighbours<Features>(
        RowSet(*piece.flight, piece.rows),
        [&](const Flight&, std::size_t row, const auto& x, const auto& before, const auto& after) {
          const std::vector<double> told = detail::with_instruments(scales, slopes.noisy, x, before, after);
          std::vector<double> denoised(x.begin(), x.end());
          for (const DenoisedFeature& feature : slopes.denoised) {
            const auto at = static_cast<std::size_t>(feature.place);
            denoised[at] = static_cast<double>(scales.mean[at]) + static_cast<double>(scales.standard_deviation[at]) *
                                                                      feature.by_neighbours(told.data()).front();
          }
          visit(first + row - piece.rows.begin, denoised);
        });
    first += piece.rows.size();
  }
}

/// Examines the slopes of `map`, a base by least squares of the same rows, and puts into it the weights by instruments
/// of each sum whose slope noise bends. `blocks`: of detail::instrumented_blocks(). The bounds of fit_monotone_base()
/// hold. Fewer than ten blocks say nothing.
inline MeasuredSlopes measure_slopes(const MonotoneShape& shape, const std::vector<RegressionSums>& blocks,
                                     const std::optional<AxisSlopes>& pinned, AffineMap& map) {
  constexpr std::size_t fewest = 10;
  MeasuredSlopes slopes;
  slopes.noisy = shape.noisy;
  if (blocks.size() < fewest) return slopes;
  const RegressionSums all = detail::total(blocks);
  const double half = student_t_975(static_cast<double>(blocks.size()) - 1);
  for (int output = 0; output < map.outputs; ++output) {
    if (output == 0 ? shape.thrusts.empty() : pinned.has_value()) continue;
    const int place = output == 0 ? shape.thrusts.front() : shape.places.front() + output - 1;
    const auto roles = detail::instrument_roles(shape, detail::features_of_output(shape, output));
    if (std::find(roles.noisy.begin(), roles.noisy.end(), place) == roles.noisy.end()) continue;
    const InstrumentedWeight found = instrumented_weight(blocks, output, roles, place);
    const double scale = (output == 0 ? -1 : 1) * shape.output_deviation[static_cast<std::size_t>(output)] /
                         shape.input_deviation[static_cast<std::size_t>(place)];
    MeasuredSlope& slope = slopes.of[static_cast<std::size_t>(output)];
    slope.by_instruments = found.errors_in_variables && found.instrumented * scale > 0;
    const auto row = static_cast<std::size_t>(output * map.inputs);
    if (slope.by_instruments) {
      const AffineMap one =
          fit_instrumented(all.of_output(output), roles, place, detail::slope_bounds(shape, output, pinned));
      std::copy_n(one.weights.begin(), map.inputs, map.weights.begin() + static_cast<std::ptrdiff_t>(row));
      map.intercept[static_cast<std::size_t>(output)] = one.intercept.front();
      const std::vector<bool> every(static_cast<std::size_t>(all.inputs()), true);
      slopes.denoised.push_back({place, detail::by_neighbours(shape, shape.noisy, all, place, every)});
    }
    slope.known = true;
    slope.slope = map.weights[row + static_cast<std::size_t>(place)] * scale;
    slope.standard_error =
        (slope.by_instruments ? found.instrumented_error : found.least_squares_error) * std::abs(scale);
    slope.lower = slope.slope - half * slope.standard_error;
    slope.upper = slope.slope + half * slope.standard_error;
    slope.least_squares = found.least_squares * scale;
    slope.strength = found.strength;
  }
  return slopes;
}

}  // namespace pinnquad
