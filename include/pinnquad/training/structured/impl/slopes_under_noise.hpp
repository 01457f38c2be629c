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
  const auto lag = static_cast<std::size_t>(std::max(2.0, std::ceil(neighbour_lag_s / period_s - 0.01)));
  const double longest_s = 1.1 * static_cast<double>(lag) * period_s;
  const auto near = [&](std::size_t first, std::size_t last) {
    return last - first == lag && (*piece.flight)[last].time_s - (*piece.flight)[first].time_s <= longest_s;
  };
  const auto inputs = static_cast<std::size_t>(context.inputs());
  std::vector<std::size_t> at;
  std::vector<double> x;
  context.each_row(one, [&](const Flight&, std::size_t row, const double* features, const double*) {
    at.push_back(row);
    x.insert(x.end(), features, features + inputs);
  });
  for (std::size_t i = lag; i + lag < at.size(); ++i) {
    if (!near(at[i - lag], at[i]) || !near(at[i], at[i + lag])) continue;
    const auto of = [&](std::size_t row) { return x.data() + row * inputs; };
    visit(at[i], of(i), of(i - lag), of(i + lag));
  }
}

/// Standardised features, then the noisy ones before and after.
PINNQUAD_BODY std::vector<double> with_neighbours(const FitContext& context, const std::vector<int>& noisy,
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

PINNQUAD_BODY AffineMap by_neighbours(const MonotoneShape& shape, const std::vector<int>& noisy,
                                      const RegressionSums& all, int place, std::vector<bool> told) {
  for (const int feature : noisy) told[static_cast<std::size_t>(feature)] = false;
  for (const int first : shape.places) {
    for (int i = 0; i < 3; ++i) told[static_cast<std::size_t>(first + i)] = false;
  }
  return fit_ridge(all.of_input(place), usual_penalties().front(), told);
}

/// Each tap of a bent slope as its neighbours tell it: those that have neighbour_lag_s off this tap.
PINNQUAD_BODY void add_denoised(const FitContext& context, const MonotoneShape& shape, const RegressionSums& all,
                                int output, MeasuredSlopes& slopes) {
  const RunTimeWindow& window = context.features.window;
  const auto time_s = [&window](std::size_t tap) {
    return tap == 0 ? 0.0 : window.offset_s(static_cast<int>(tap) - 1);
  };
  const std::size_t count = slopes.noisy.size();
  const std::vector<std::pair<int, double>> taps = slope_terms(shape, output);
  for (std::size_t tap = 0; tap < taps.size(); ++tap) {
    std::vector<bool> told(static_cast<std::size_t>(all.inputs()), true);
    for (std::size_t i = 0; i < 2 * count && taps.size() > 1; ++i) {
      const double lag_s = i < count ? -neighbour_lag_s : neighbour_lag_s;
      told[static_cast<std::size_t>(shape.inputs) + i] =
          std::abs(time_s(i % count) + lag_s - time_s(tap)) > neighbour_lag_s - window.tolerance_s;
    }
    slopes.denoised.push_back({taps[tap].first, by_neighbours(shape, slopes.noisy, all, taps[tap].first, told)});
  }
}

/// Standardised features and outputs of consecutive rows, column by column, and the body rates.
struct ConsecutiveRows {
  std::vector<std::vector<double>> columns;
  std::array<std::vector<double>, 3> rates;

  explicit ConsecutiveRows(std::size_t count) : columns(count) {}
  std::size_t size() const { return rates[0].size(); }
  void clear() { *this = ConsecutiveRows(columns.size()); }

  void add(const double* x, std::size_t inputs, const double* y, const Vector3<double>& rates_rad_s) {
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].push_back(i < inputs ? x[i] : y[i - inputs]);
    for (int axis = 0; axis < 3; ++axis) rates[static_cast<std::size_t>(axis)].push_back(rates_rad_s[axis]);
  }

  /// Calls use(centre, columns) of each window of so many intervals on each side, a quarter of the window apart.
  template <class Use>
  void each_window(const FitContext& context, double period_s, std::size_t half, const Use& use) const {
    if (size() < 2 * half + 1) return;
    std::vector<std::vector<double>> means;
    for (const std::vector<double>& column : columns) means.push_back(means_between_rows(column));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto place = static_cast<std::size_t>(context.features.accelerations.front()) + axis;
      for (std::size_t i = 0; i < means[place].size(); ++i) {
        const double turned = (rates[axis][i + 1] - rates[axis][i]) / period_s;
        means[place][i] = (turned - context.input_mean[place]) / context.input_deviation[place];
      }
    }
    const std::vector<double> weights = window_weights(half);
    std::vector<double> smooth(columns.size());
    for (std::size_t first = 0; first + weights.size() < size(); first += half / 2) {
      for (std::size_t i = 0; i < smooth.size(); ++i) {
        smooth[i] = 0;
        for (std::size_t k = 0; k < weights.size(); ++k) smooth[i] += weights[k] * means[i][first + k];
      }
      use(first + half, smooth.data());
    }
  }
};

PINNQUAD_BODY std::vector<RegressionSums> row_blocks(const FitContext& context, const RowSet& rows, double window_s) {
  constexpr double most = 50, least_s = 2, gap = 1.5;
  const auto inputs = static_cast<std::size_t>(context.inputs()), outputs = std::size_t(context.outputs());
  const double period_s = sample_period_s(rows);
  const double length = std::max(static_cast<double>(rows.size()) / most, period_s > 0 ? least_s / period_s : 1.0);
  const auto count = static_cast<std::size_t>(static_cast<double>(rows.size()) / length) + 1;
  std::vector<RegressionSums> blocks(count, RegressionSums(context.inputs(), context.outputs()));
  const auto add = [&](std::size_t row, const double* x, const double* y) {
    blocks[static_cast<std::size_t>(static_cast<double>(row) / length)].add(x, y);
  };
  ConsecutiveRows stretch(inputs + outputs);
  std::size_t counted = 0;
  const auto finish = [&] {
    stretch.each_window(context, period_s, half_window(window_s, period_s),
                        [&](std::size_t row, const double* x) { add(counted - stretch.size() + row, x, x + inputs); });
    stretch.clear();
  };
  const Flight* last = nullptr;
  double last_s = 0;
  context.each_standardised(rows, [&](const Flight& flight, std::size_t row, const double* x, const double* y) {
    if (window_s > 0) {
      const double since_s = flight[row].time_s - last_s;
      if (&flight != last || !(since_s > 0 && since_s < gap * period_s)) finish();
      stretch.add(x, inputs, y, flight[row].body_rates_rad_s);
      last = &flight;
      last_s = flight[row].time_s;
    } else {
      add(counted, x, y);
    }
    ++counted;
  });
  if (window_s > 0) finish();
  return blocks;
}

PINNQUAD_BODY SlopeOfBlocks::SlopeOfBlocks(const MonotoneShape& shape, const std::vector<RegressionSums>& blocks,
                                           int output) {
  const std::vector<bool> taken = features_of_output(shape, output);
  const auto slope = [&](const RegressionSums& sums) {
    const AffineMap map = fit_ridge(sums, usual_penalties().front(), taken);
    double sum = 0;
    for (const auto& [place, factor] : slope_terms(shape, output)) {
      sum += factor * map.weights[static_cast<std::size_t>(place)];
    }
    return output == 0 ? -sum : sum;
  };
  const RegressionSums total_of = total(blocks).of_output(output);
  all = slope(total_of);
  for (const RegressionSums& block : blocks) {
    RegressionSums others = total_of;
    others -= block.of_output(output);
    without.push_back(block.rows() > 0 ? slope(others) : all);
  }
}

PINNQUAD_BODY double block_error(double factor, const SlopeOfBlocks& a, const SlopeOfBlocks* b) {
  double sum = 0, squares = 0;
  const double count = static_cast<double>(a.without.size());
  for (std::size_t i = 0; i < a.without.size(); ++i) {
    const double moved = factor * (a.without[i] - a.all) + (b != nullptr ? b->without[i] - b->all : 0.0);
    sum += moved;
    squares += moved * moved;
  }
  return std::sqrt(std::max(0.0, (count - 1) / count * (squares - sum * sum / count)));
}

}  // namespace detail

PINNQUAD_BODY void each_denoised(const FitContext& context, const MeasuredSlopes& slopes, const RowSet& rows,
                                 const std::function<void(std::size_t row, const std::vector<double>& x)>& visit) {
  std::size_t first = 0;
  for (const FlightRows& piece : rows.pieces()) {
    detail::each_with_neighbours(
        context, piece, [&](std::size_t row, const double* x, const double* before, const double* after) {
          const std::vector<double> told = detail::with_neighbours(context, slopes.noisy, x, before, after);
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

PINNQUAD_BODY MeasuredSlopes measure_slopes(const FitContext& context, const RowSet& rows,
                                            const std::optional<AxisSlopes>& pinned, AffineMap& map) {
  constexpr std::ptrdiff_t fewest = 10;
  constexpr std::size_t most_windows = 5;
  constexpr double shortest_s = 0.16, one_sided_99 = 2.326;
  // of the rows: rotor lag, too, moves a slope by some percent; of a window: what noise is left is an eighth of it
  constexpr double tolerated_of_rows = 0.05, tolerated_of_window = 0.01;
  MonotoneShape shape = monotone_shape(context);
  MeasuredSlopes slopes;
  const double period_s = sample_period_s(rows);
  const double first_s = std::max(shortest_s, 2 * period_s * static_cast<double>(detail::half_window(0, period_s)));
  std::vector<std::vector<RegressionSums>> windows = {detail::row_blocks(context, rows, 0)};
  while (!windows.front().empty() && !(windows.front().back().rows() > 0)) windows.front().pop_back();
  const auto length_s = [&](std::size_t window) { return window == 0 ? 0.0 : std::ldexp(first_s, int(window) - 1); };
  const auto told = [&](std::size_t window) {
    if (window == windows.size()) {
      windows.push_back(detail::row_blocks(context, rows, length_s(window)));
      windows.back().resize(windows.front().size(), windows.front().front());
    }
    const auto has_rows = [](const RegressionSums& block) { return block.rows() > 0; };
    return std::count_if(windows[window].begin(), windows[window].end(), has_rows) >= fewest;
  };
  if (!(period_s > 0) || !told(0)) return slopes;
  const double half = student_t_975(static_cast<double>(windows.front().size()) - 1);
  slopes.noisy = context.is_windowed() ? shape.thrusts : shape.noisy;
  std::optional<RegressionSums> neighbours;
  for (int output = 0; output < map.outputs; ++output) {
    if (output == 0 ? shape.thrusts.empty() : pinned || context.is_windowed()) continue;
    detail::SlopeOfBlocks found(shape, windows.front(), output);
    MeasuredSlope& slope = slopes.of[static_cast<std::size_t>(output)];
    slope.least_squares = found.all;
    std::size_t window = 0;
    double left = 0;  // from the slope to the upper end of that of the next window: noise bends towards 0
    while (window < most_windows && told(window + 1)) {
      const detail::SlopeOfBlocks longer(shape, windows[window + 1], output);
      const double kept = 1 - (window == 0 ? tolerated_of_rows : tolerated_of_window);
      const double steeper = longer.all - found.all / kept;
      if (!(longer.all > 0) || !(steeper > one_sided_99 * detail::block_error(-1 / kept, found, &longer))) {
        left = std::max(0.0, longer.all - found.all + half * detail::block_error(1, longer));
        break;
      }
      found = longer;
      ++window;
    }
    slope.known = true;
    slope.window_s = length_s(window);
    slope.standard_error = detail::block_error(1, found);
    const std::ptrdiff_t begin = std::ptrdiff_t{output} * map.inputs;
    if (slope.smoothed()) {
      if (context.is_windowed()) shape.held_thrust = slope.slope;
      const AffineMap mended =
          fit_monotone_base(shape, {detail::total(windows[context.is_windowed() ? 0 : window])}, pinned);
      std::copy_n(mended.weights.begin() + begin, map.inputs, map.weights.begin() + begin);
      map.intercept[static_cast<std::size_t>(output)] = mended.intercept[static_cast<std::size_t>(output)];
      if (!neighbours) {
        neighbours.emplace(map.inputs + 2 * static_cast<int>(slopes.noisy.size()), 0);
        for (const FlightRows& piece : rows.pieces()) {
          detail::each_with_neighbours(
              context, piece, [&](std::size_t, const double* x, const double* before, const double* after) {
                neighbours->add(detail::with_neighbours(context, slopes.noisy, x, before, after).data(), nullptr);
              });
        }
      }
      detail::add_denoised(context, shape, *neighbours, output, slopes);
    }
    double fitted = 0;
    for (const auto& [place, factor] : detail::slope_terms(shape, output)) {
      fitted += factor * map.weights[static_cast<std::size_t>(begin + place)];
    }
    slope.slope = output == 0 ? -fitted : fitted;
    slope.lower = slope.slope - half * slope.standard_error;
    slope.upper = slope.slope + std::max(half * slope.standard_error, slope.smoothed() ? left : 0.0);
  }
  return slopes;
}

}  // namespace pinnquad
