// SPDX-License-Identifier: MIT
// Bodies of slopes_under_noise.hpp.
#pragma once

#include "pinnquad/training/structured/slopes_under_noise.hpp"

namespace pinnquad {
namespace detail {

/// neighbour_lag_s in rows.
PINNQUAD_BODY std::size_t neighbour_rows(double period_s) {
  return static_cast<std::size_t>(std::max(2.0, std::ceil(neighbour_lag_s / period_s - 0.01)));
}

PINNQUAD_BODY void each_with_neighbours(const FitContext& context, const FlightRows& piece,
                                        const NeighboursVisit& visit) {
  const RowSet one(*piece.flight, piece.rows);
  const double period_s = sample_period_s(one);
  if (!(period_s > 0)) return;
  const std::size_t lag = neighbour_rows(period_s);
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

PINNQUAD_BODY std::vector<int> noisy_features(const FitContext& context) {
  if (context.is_windowed()) return context.features.thrusts();
  std::vector<int> noisy;
  for (int i = 0; i < context.inputs(); ++i) {
    const std::string_view unit = context.features.units[static_cast<std::size_t>(i)];
    if (unit == "m/s^2" || unit == "rad/s" || unit == "rad/s^2" || unit == "rad^2/s^2") noisy.push_back(i);
  }
  return noisy;
}

PINNQUAD_BODY AffineMap by_neighbours(const FitContext& context, const std::vector<int>& noisy,
                                      const RegressionSums& all, int place, std::vector<bool> told) {
  for (const int feature : noisy) told[static_cast<std::size_t>(feature)] = false;
  for (const int first : context.features.accelerations) {
    for (int i = 0; i < 3; ++i) told[static_cast<std::size_t>(first + i)] = false;
  }
  return fit_ridge(all.of_input(place), usual_penalties().front(), told);
}

/// Each tap of the bent slopes as its neighbours tell it: those that have neighbour_lag_s off this tap.
PINNQUAD_BODY void add_denoised(const FitContext& context, const RowSet& rows, MeasuredSlopes& slopes) {
  const std::size_t count = slopes.noisy.size();
  RegressionSums all(context.inputs() + 2 * static_cast<int>(count), 0);
  for (const FlightRows& piece : rows.pieces()) {
    each_with_neighbours(context, piece, [&](std::size_t, const double* x, const double* before, const double* after) {
      all.add(with_neighbours(context, slopes.noisy, x, before, after).data(), nullptr);
    });
  }
  if (!(all.rows() > 0)) return;
  const RunTimeFeatures::Window& window = context.features.window;
  const auto time_s = [&window](std::size_t tap) {
    return tap == 0 ? 0.0 : window.offset_s(static_cast<int>(tap) - 1);
  };
  for (int output = 0; output < AxisCommandOutputs::size; ++output) {
    if (!slopes.of[static_cast<std::size_t>(output)].smoothed()) continue;
    const std::vector<std::pair<int, double>> taps = slope_terms(context, output);
    for (std::size_t tap = 0; tap < taps.size(); ++tap) {
      std::vector<bool> told(static_cast<std::size_t>(all.inputs()), true);
      for (std::size_t i = 0; i < 2 * count && taps.size() > 1; ++i) {
        const double lag_s = i < count ? -neighbour_lag_s : neighbour_lag_s;
        told[static_cast<std::size_t>(context.inputs()) + i] =
            std::abs(time_s(i % count) + lag_s - time_s(tap)) > neighbour_lag_s - window.tolerance_s;
      }
      slopes.denoised.push_back({taps[tap].first, by_neighbours(context, slopes.noisy, all, taps[tap].first, told)});
    }
  }
}

/// Standardised features and outputs of consecutive rows, column by column, and what their accelerations are of.
struct ConsecutiveRows {
  std::vector<std::vector<double>> columns;
  /// Body rates and velocity along z, and what is to be added to their derivatives: nothing, omega x v - R^T g.
  std::array<std::vector<double>, 4> integrals, added;
  bool has_velocity = false;

  explicit ConsecutiveRows(std::size_t count) : columns(count) {}
  std::size_t size() const { return integrals[0].size(); }

  void add(const double* x, std::size_t inputs, const double* y, const Sample& sample) {
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].push_back(i < inputs ? x[i] : y[i - inputs]);
    for (int axis = 0; axis < 3; ++axis) {
      integrals[static_cast<std::size_t>(axis)].push_back(sample.body_rates_rad_s[axis]);
      added[static_cast<std::size_t>(axis)].push_back(0);
    }
    const MotionInputs<double> motion = sample_inputs<MotionInputs<double>>(sample);
    integrals[3].push_back(sample.velocity_m_s[2]);
    added[3].push_back(SpecificForce::of(motion)[2] - sample.linear_acceleration_m_s2[2]);
    has_velocity = has_velocity || sample.velocity_m_s[2] != 0;
  }

  /// Calls use(centre, columns) of each window, a quarter of it apart; without one, of each row. Not of what is within
  /// neighbour_lag_s of an end, where a log's derivatives err most.
  template <class Use>
  void each_window(const FitContext& context, double period_s, double window_s, const Use& use) const {
    const std::size_t edge = neighbour_rows(period_s);
    std::vector<double> smooth(columns.size());
    for (std::size_t row = edge; row + edge < size() && !(window_s > 0); ++row) {
      for (std::size_t i = 0; i < smooth.size(); ++i) smooth[i] = columns[i][row];
      use(row, smooth.data());
    }
    const std::size_t half = half_window(window_s, period_s);
    if (!(window_s > 0) || size() < 2 * (half + edge) + 1) return;
    std::vector<std::vector<double>> means;
    for (const std::vector<double>& column : columns) means.push_back(means_between_rows(column));
    const std::vector<int> thrusts = context.features.thrusts();
    for (std::size_t k = 0; k < (has_velocity && !thrusts.empty() ? 4U : 3U); ++k) {
      const auto place = k < 3 ? static_cast<std::size_t>(context.features.accelerations.front()) + k
                               : static_cast<std::size_t>(thrusts.front());
      const std::vector<double> others = means_between_rows(added[k]);
      for (std::size_t i = 0; i < others.size(); ++i) {
        const double value = (integrals[k][i + 1] - integrals[k][i]) / period_s + others[i];
        means[place][i] = (value - context.input_mean[place]) / context.input_deviation[place];
      }
    }
    const std::vector<double> weights = window_weights(half);
    for (std::size_t first = edge; first + weights.size() + edge < size(); first += half / 2) {
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
  if (!(period_s > 0)) return {};
  const double length = std::max(static_cast<double>(rows.size()) / most, least_s / period_s);
  const auto count = static_cast<std::size_t>(static_cast<double>(rows.size()) / length) + 1;
  std::vector<RegressionSums> blocks(count, RegressionSums(context.inputs(), context.outputs()));
  ConsecutiveRows stretch(inputs + outputs);
  std::size_t counted = 0;
  const auto finish = [&] {
    stretch.each_window(context, period_s, window_s, [&](std::size_t row, const double* x) {
      const auto block = static_cast<std::size_t>(static_cast<double>(counted - stretch.size() + row) / length);
      blocks[block].add(x, x + inputs);
    });
    stretch = ConsecutiveRows(inputs + outputs);
  };
  const Flight* last = nullptr;
  double last_s = 0;
  context.each_standardised(rows, [&](const Flight& flight, std::size_t row, const double* x, const double* y) {
    const double since_s = flight[row].time_s - last_s;
    if (&flight != last || !(since_s > 0 && since_s < gap * period_s)) finish();
    stretch.add(x, inputs, y, flight[row]);
    last = &flight;
    last_s = flight[row].time_s;
    ++counted;
  });
  finish();
  return blocks;
}

PINNQUAD_BODY SlopeOfBlocks::SlopeOfBlocks(const FitContext& context, const std::vector<RegressionSums>& blocks,
                                           int output) {
  std::vector<bool> taken = features_of_output(context, output);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    taken[i] = taken[i] && is_of_present(context.features.names[i]);
  }
  const auto [present, factor] = slope_terms(context, output).front();
  const double unit = output == 0 ? -factor : factor;
  const auto slope = [&, place = static_cast<std::size_t>(present)](const RegressionSums& sums) {
    return unit * fit_ridge(sums, usual_penalties().front(), taken).weights[place];
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

/// Blocks of rows as they are, window 0, and of smoothed ones: each window is twice as long as the one before it.
class BlocksByWindow {
 public:
  BlocksByWindow(const FitContext& context, const RowSet& rows)
      : context_(context), rows_(rows), blocks_{row_blocks(context, rows, 0)} {
    const double period_s = sample_period_s(rows);
    shortest_s_ = period_s > 0 ? 2 * period_s * static_cast<double>(half_window(0.16, period_s)) : 0;
    while (!blocks_[0].empty() && !(blocks_[0].back().rows() > 0)) blocks_[0].pop_back();
  }

  double window_s(std::size_t window) const {
    return window == 0 ? 0.0 : std::ldexp(shortest_s_, static_cast<int>(window) - 1);
  }

  /// Whether its blocks tell a slope; those of window + 1 are made after those of `window`.
  bool told(std::size_t window) {
    constexpr std::ptrdiff_t fewest = 10;
    if (!(shortest_s_ > 0)) return false;
    if (window == blocks_.size()) {
      blocks_.push_back(row_blocks(context_, rows_, window_s(window)));
      blocks_.back().resize(blocks_[0].size(), RegressionSums(context_.inputs(), context_.outputs()));
    }
    const auto has_rows = [](const RegressionSums& block) { return block.rows() > 0; };
    return std::count_if(blocks_[window].begin(), blocks_[window].end(), has_rows) >= fewest;
  }

  const std::vector<RegressionSums>& operator[](std::size_t window) const { return blocks_[window]; }

 private:
  const FitContext& context_;
  const RowSet& rows_;
  double shortest_s_ = 0;
  std::vector<std::vector<RegressionSums>> blocks_;
};

/// The slope of the first window that the next one finds no steeper one than, beyond chance.
struct SteepestSlope {
  std::size_t window = 0;
  SlopeOfBlocks slope;
  std::optional<SlopeOfBlocks> next;  ///< of the window twice as long, where it tells one
  double of_rows = 0;                 ///< as they are

  SteepestSlope(const FitContext& context, BlocksByWindow& blocks, int output)
      : slope(context, blocks[0], output), of_rows(slope.all) {
    constexpr std::size_t last = 5;
    constexpr double one_sided_99 = 2.326;
    // of the rows: rotor lag, too, moves a slope by some percent; of a window: an eighth of its noise is in the next
    constexpr double kept_by_rows = 0.95, kept_by_window = 0.99;
    for (; window < last && blocks.told(window + 1); ++window) {
      next.emplace(context, blocks[window + 1], output);
      const double factor = -1 / (window == 0 ? kept_by_rows : kept_by_window);
      const double steeper = next->all + factor * slope.all;
      if (!(next->all > 0) || !(steeper > one_sided_99 * block_error(factor, slope, &*next))) return;
      slope = *next;
    }
    next.reset();
  }
};

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
  const bool windowed = context.is_windowed();
  MeasuredSlopes slopes;
  slopes.noisy = detail::noisy_features(context);
  const bool sees_thrust = !context.features.thrusts().empty();
  double held_thrust = 0;
  detail::BlocksByWindow blocks(context, rows);
  if (!blocks.told(0)) return slopes;
  const double half = student_t_975(static_cast<double>(blocks[0].size()) - 1);
  for (int output = 0; output < map.outputs; ++output) {
    if (output == 0 ? !sees_thrust : pinned || windowed) continue;
    const detail::SteepestSlope found(context, blocks, output);
    if (windowed && found.window == 0) continue;  // its taps are not what was examined
    const auto begin = std::ptrdiff_t{output} * map.inputs;
    MeasuredSlope& slope = slopes.of[static_cast<std::size_t>(output)];
    slope.known = true;
    slope.window_s = blocks.window_s(found.window);
    slope.least_squares = found.of_rows;
    slope.standard_error = detail::block_error(1, found.slope);
    double upper = -std::numeric_limits<double>::infinity();
    if (found.window > 0 && found.next) upper = found.next->all + half * detail::block_error(1, *found.next);
    if (found.window > 0) {
      if (output == 0) {
        held_thrust = found.slope.all;
        const Identification vehicle = identify(rows, axis_signs(context.airframe));
        const Estimate& thrust = vehicle.thrust_m_s2;
        // commands with another zero, and flights of several masses, have no such thrust: the slope of smoothed rows
        // stays
        if (thrust.low() > 0 && vehicle.thrust_slope_m_s2.holds(thrust.value)) {
          held_thrust = 1 / thrust.value;
          slope.standard_error = thrust.half_width / (half * thrust.value * thrust.value);
          upper = 1 / thrust.low();
        }
      }
      const AffineMap mended =
          fit_monotone_base(context, {detail::total(blocks[windowed ? 0 : found.window])}, pinned, held_thrust);
      std::copy_n(mended.weights.begin() + begin, map.inputs, map.weights.begin() + begin);
      map.intercept[static_cast<std::size_t>(output)] = mended.intercept[static_cast<std::size_t>(output)];
    }
    double fitted = 0;
    for (const auto& [place, factor] : detail::slope_terms(context, output)) {
      fitted += factor * map.weights[static_cast<std::size_t>(begin + place)];
    }
    slope.slope = output == 0 ? -fitted : fitted;
    slope.lower = slope.slope - half * slope.standard_error;
    slope.upper = std::max(slope.slope + half * slope.standard_error, upper);
  }
  if (slopes.smoothed()) detail::add_denoised(context, rows, slopes);
  return slopes;
}

}  // namespace pinnquad
