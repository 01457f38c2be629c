// SPDX-License-Identifier: MIT
// Bodies of slopes_under_noise.hpp.
#pragma once

#include "pinnquad/training/structured/slopes_under_noise.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY void each_with_neighbours(const FitContext& context, const FlightRows& piece,
                                        const NeighboursVisit& visit) {
  const RowSet one(*piece.flight, piece.rows);
  const double period_s = sample_period_s(one);
  if (!(period_s > 0)) return;
  const auto lag = static_cast<std::size_t>(std::max(2.0, std::ceil(instrument_lag_s / period_s - 0.01)));
  const double longest_s = 1.1 * static_cast<double>(lag) * period_s;
  const auto near = [&](std::size_t first, std::size_t last) {
    return last - first == lag && (*piece.flight)[last].time_s - (*piece.flight)[first].time_s <= longest_s;
  };
  const auto inputs = static_cast<std::size_t>(context.inputs()), outputs = std::size_t(context.outputs());
  std::vector<std::size_t> at;
  std::vector<double> x, y;
  context.each_row(one, [&](const Flight&, std::size_t row, const double* features, const double* answers) {
    at.push_back(row);
    x.insert(x.end(), features, features + inputs);
    y.insert(y.end(), answers, answers + outputs);
  });
  for (std::size_t i = lag; i + lag < at.size(); ++i) {
    if (!near(at[i - lag], at[i]) || !near(at[i], at[i + lag])) continue;
    const auto of = [&](std::size_t row) { return x.data() + row * inputs; };
    visit(at[i], of(i), y.data() + i * outputs, of(i - lag), of(i + lag));
  }
}

/// Standardised features, then the noisy ones before and after.
PINNQUAD_BODY std::vector<double> with_instruments(const FitContext& context, const std::vector<int>& noisy,
                                                   const double* x, const double* before, const double* after) {
  std::vector<double> all;
  const auto add = [&](const double* from, int feature) {
    const auto i = static_cast<std::size_t>(feature);
    all.push_back((from[i] - context.input_mean[i]) / context.input_deviation[i]);
  };
  for (int i = 0; i < context.inputs(); ++i) add(x, i);
  for (const double* from : {before, after}) {
    for (const int i : noisy) add(from, i);
  }
  return all;
}

PINNQUAD_BODY std::vector<RegressionSums> instrumented_blocks(const FitContext& context, const RowSet& rows,
                                                              const std::vector<int>& noisy) {
  constexpr double most = 50, least_s = 2;
  const RegressionSums none(context.inputs() + 2 * static_cast<int>(noisy.size()), context.outputs());
  const double period_s = sample_period_s(rows);
  const double length = std::max(static_cast<double>(rows.size()) / most, period_s > 0 ? least_s / period_s : 0.0);
  std::vector<RegressionSums> blocks;
  std::vector<double> z(context.output_mean.size());
  for (const FlightRows& piece : rows.pieces()) {
    each_with_neighbours(context, piece,
                         [&](std::size_t, const double* x, const double* y, const double* before, const double* after) {
                           for (std::size_t k = 0; k < z.size(); ++k) {
                             z[k] = (y[k] - context.output_mean[k]) / context.output_deviation[k];
                           }
                           if (blocks.empty() || blocks.back().rows() >= length) blocks.push_back(none);
                           blocks.back().add(with_instruments(context, noisy, x, before, after).data(), z.data());
                         });
  }
  return blocks;
}

/// The roles of the inputs for one output.
PINNQUAD_BODY InstrumentRoles instrument_roles(const MonotoneShape& shape, const std::vector<bool>& taken) {
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

PINNQUAD_BODY AffineMap by_neighbours(const MonotoneShape& shape, const std::vector<int>& noisy,
                                      const RegressionSums& all, int place, std::vector<bool> told) {
  for (const int feature : noisy) told[static_cast<std::size_t>(feature)] = false;
  for (const int first : shape.places) {
    for (int i = 0; i < 3; ++i) told[static_cast<std::size_t>(first + i)] = false;
  }
  return fit_ridge(all.of_input(place), smallest_penalty(), told);
}

PINNQUAD_BODY std::vector<MeasuredSlopes::Denoised> denoised_taps(const FitContext& context, const MonotoneShape& shape,
                                                                  const RegressionSums& all) {
  const std::size_t taps = shape.thrusts.size();
  const RunTimeWindow& window = context.features.window;
  const auto time_s = [&window](std::size_t tap) {
    return tap == 0 ? 0.0 : window.offset_s(static_cast<int>(tap) - 1);
  };
  std::vector<MeasuredSlopes::Denoised> denoised;
  for (std::size_t tap = 0; tap < taps; ++tap) {
    std::vector<bool> told(static_cast<std::size_t>(all.inputs()), true);
    for (std::size_t i = 0; i < 2 * taps; ++i) {
      const double lag_s = i < taps ? -instrument_lag_s : instrument_lag_s;
      told[static_cast<std::size_t>(shape.inputs) + i] =
          std::abs(time_s(i % taps) + lag_s - time_s(tap)) > instrument_lag_s - window.tolerance_s;
    }
    const int place = shape.thrusts[tap];
    denoised.push_back({place, by_neighbours(shape, shape.thrusts, all, place, told)});
  }
  return denoised;
}

}  // namespace detail

PINNQUAD_BODY void each_denoised(const FitContext& context, const MeasuredSlopes& slopes, const RowSet& rows,
                                 const std::function<void(std::size_t row, const std::vector<double>& x)>& visit) {
  std::size_t first = 0;
  for (const FlightRows& piece : rows.pieces()) {
    detail::each_with_neighbours(
        context, piece,
        [&](std::size_t row, const double* x, const double*, const double* before, const double* after) {
          const std::vector<double> told = detail::with_instruments(context, slopes.noisy, x, before, after);
          std::vector<double> denoised(x, x + context.inputs());
          for (const MeasuredSlopes::Denoised& feature : slopes.denoised) {
            const auto at = static_cast<std::size_t>(feature.place);
            denoised[at] =
                context.input_mean[at] + context.input_deviation[at] * feature.by_neighbours(told.data()).front();
          }
          visit(first + row - piece.rows.begin, denoised);
        });
    first += piece.rows.size();
  }
}

PINNQUAD_BODY MeasuredSlopes measure_slopes(const MonotoneShape& shape, const std::vector<RegressionSums>& blocks,
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
