// SPDX-License-Identifier: MIT
#include "logs/command_lag.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "logs/specific_force.hpp"
#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/data/plausibility.hpp"

namespace pinnquad::logs {
namespace {

/// y' = (x - y) / tau with x held over a period: a first-order lag, exactly, along the rows from `begin` to `end`.
template <class Iterator>
void apply_first_order_lag(Iterator begin, Iterator end, double period_s, double time_constant_s) {
  const double share = 1 - std::exp(-period_s / time_constant_s);
  double state = *begin;
  for (; begin != end; ++begin) *begin = state += share * (*begin - state);
}

/// Twice forward, twice backward: no phase, half the amplitude at about 0.64 of the corner.
void low_pass_without_phase(std::vector<double>& series, double period_s, double corner_Hz) {
  constexpr double tau = 6.283185307179586;
  const double time_constant_s = 1 / (tau * corner_Hz);
  for (int pass = 0; pass < 2 && !series.empty(); ++pass) {
    apply_first_order_lag(series.begin(), series.end(), period_s, time_constant_s);
    apply_first_order_lag(series.rbegin(), series.rend(), period_s, time_constant_s);
  }
}

/// A series at `fine` times its rows, by a windowed sinc: rows that are far apart hold a motion's maximum to their own
/// places otherwise.
std::vector<double> between_rows(const std::vector<double>& series, std::size_t fine) {
  constexpr std::ptrdiff_t reach = 6;
  const auto sinc = [](double x) { return std::abs(x) < 1e-12 ? 1.0 : std::sin(pi * x) / (pi * x); };
  std::vector<std::array<double, 2 * reach>> weights(fine);  // of each part
  std::vector<double> total(fine, 0.0);
  for (std::size_t part = 1; part < fine; ++part) {
    const double share = static_cast<double>(part) / static_cast<double>(fine);
    for (std::size_t i = 0; i < weights[part].size(); ++i) {
      const double x = share - static_cast<double>(1 - reach + static_cast<std::ptrdiff_t>(i));
      weights[part][i] = sinc(x) * sinc(x / static_cast<double>(reach));
      total[part] += weights[part][i];
    }
  }
  const auto rows = static_cast<std::ptrdiff_t>(series.size());
  std::vector<double> result;
  result.reserve(series.size() * fine);
  for (std::ptrdiff_t row = 0; row < rows; ++row) {
    result.push_back(series[static_cast<std::size_t>(row)]);
    for (std::size_t part = 1; part < fine; ++part) {
      double sum = 0;
      for (std::size_t i = 0; i < weights[part].size(); ++i) {
        const std::ptrdiff_t at = row + 1 - reach + static_cast<std::ptrdiff_t>(i);
        sum += weights[part][i] * series[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, rows - 1))];
      }
      result.push_back(sum / total[part]);
    }
  }
  return result;
}

/// Sets the sums of products of `Count` columns, the `First` and those behind it, with all columns. `lag` counts
/// parts of rows, of which commands have `fine` each. How many rows.
template <std::size_t First, std::size_t Count>
std::size_t set_products(const std::vector<LagSeries>& all, std::size_t ahead, std::size_t behind, int lag,
                         std::size_t fine, std::size_t step, LagMoments& moments) {
  using Columns = Eigen::Array<double, static_cast<int>(lag_columns), 1>;
  std::array<Columns, Count> sums;
  sums.fill(Columns::Zero());
  std::size_t rows = 0;
  for (const LagSeries& one : all) {
    for (std::size_t row = ahead; row + behind < one.size(); row += step) {
      Columns x;
      Eigen::Index column = 0;
      x[column++] = 1;
      const auto commanded = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(row * fine) - lag);
      for (const auto& series : one.commands) x[column++] = series[commanded];
      for (const auto& series : one.rates) x[column++] = series[row];
      for (const auto& series : one.motions) x[column++] = series[row];
      const double weight = one.weights.empty() ? 1 : one.weights[row];
      for (std::size_t k = 0; k < Count; ++k) sums[k] += weight * x[static_cast<Eigen::Index>(First + k)] * x;
      ++rows;
    }
  }
  for (std::size_t k = 0; k < Count; ++k) {
    for (std::size_t j = 0; j < lag_columns; ++j) {
      moments[First + k][j] = moments[j][First + k] = sums[k][static_cast<Eigen::Index>(j)];
    }
  }
  return rows;
}

/// R^2 of each motion by the commands, beyond what a constant and the body rates explain.
using Explained = std::array<double, lag_motions>;

Explained explained_beyond_rates(LagMoments moments) {
  constexpr double rank_threshold = 1e-9;
  constexpr std::size_t first_rate = 1 + rotor_count, first_motion = first_rate + 3;
  const LagMoments whole = moments;
  take_out(moments, 0, rank_threshold * whole[0][0]);
  const LagMoments centred = moments;
  for (std::size_t k = first_rate; k < first_motion; ++k) take_out(moments, k, rank_threshold * centred[k][k]);
  Explained before{}, result{};
  for (std::size_t m = 0; m < lag_motions; ++m) before[m] = moments[first_motion + m][first_motion + m];
  for (std::size_t k = 1; k < first_rate; ++k) take_out(moments, k, rank_threshold * centred[k][k]);
  for (std::size_t m = 0; m < lag_motions; ++m) {
    const double of = whole[first_motion + m][first_motion + m];
    if (!(before[m] > 1e-12 * of)) continue;
    result[m] = std::clamp(1 - moments[first_motion + m][first_motion + m] / before[m], 0.0, 1.0);
  }
  return result;
}

/// Lags a few milliseconds apart, in rows, or in parts of rows that are far apart.
struct LagGrid {
  std::size_t fine = 1;  ///< parts of a row
  int first = 0, last = 0, stride = 1;
  double period_s = 0;  ///< of a part
  LagGrid(double row_s, const LagRange& range) {
    constexpr double shortest_s = 0.004, longest_s = 0.01, rounding = 1e-6;
    fine = static_cast<std::size_t>(std::max(1.0, std::ceil(row_s / longest_s - rounding)));
    period_s = row_s / static_cast<double>(fine);
    stride = std::max(1, static_cast<int>(shortest_s / period_s));
    first = stride * static_cast<int>(std::floor(range.shortest_s / step_s()));
    last = stride * static_cast<int>(std::ceil(range.longest_s / step_s()));
  }
  double lag_s(double index) const noexcept { return (first + index * stride) * period_s; }
  double step_s() const noexcept { return stride * period_s; }
  /// Rows that hold so many parts.
  std::size_t rows(int parts) const noexcept { return (static_cast<std::size_t>(parts) + fine - 1) / fine; }
};

/// By lag, all over the same rows, at most about `most_rows` of them. `rows`: how many.
std::vector<Explained> explained_by_lag(const std::vector<LagSeries>& all, const LagGrid& grid, std::size_t& rows) {
  constexpr std::size_t most_rows = 8000;
  const std::size_t ahead = grid.rows(grid.last), behind = grid.rows(-grid.first);
  std::size_t whole = 0;
  for (const LagSeries& one : all) whole += one.size() > ahead + behind ? one.size() - ahead - behind : 0;
  const std::size_t step = std::max<std::size_t>(1, whole / most_rows);
  std::vector<Explained> result;
  LagMoments moments = lag_moments(all, ahead, behind, 0, step, rows);
  std::vector<LagSeries> fine;
  if (grid.fine > 1) fine = all;
  for (LagSeries& one : fine) {
    for (auto& series : one.commands) series = between_rows(series, grid.fine);
  }
  for (int lag = grid.first; lag <= grid.last; lag += grid.stride) {
    set_products<1, rotor_count>(grid.fine > 1 ? fine : all, ahead, behind, lag, grid.fine, step,
                                 moments);  // others are those of any lag
    result.push_back(rows > lag_columns ? explained_beyond_rates(moments) : Explained{});
  }
  return result;
}

/// -log(1 - R^2): log-likelihood per row, so that motions of different noise can be added.
double say(double explained) noexcept { return -0.5 * std::log(std::max(1e-9, 1 - explained)); }

/// Index of a curve's maximum with the fraction that a parabola through its neighbours adds.
double peak_at(const std::vector<double>& curve) noexcept {
  const auto top = static_cast<std::size_t>(std::max_element(curve.begin(), curve.end()) - curve.begin());
  const auto at = static_cast<double>(top);
  if (top == 0 || top + 1 >= curve.size()) return at;
  const double bend = curve[top - 1] - 2 * curve[top] + curve[top + 1];
  return bend < 0 ? at + 0.5 * (curve[top - 1] - curve[top + 1]) / bend : at;
}

double sharpness_of(const std::vector<double>& curve, double step_s) noexcept {
  constexpr double away_s = 0.05;
  const auto top = std::max_element(curve.begin(), curve.end()) - curve.begin();
  const auto size = static_cast<std::ptrdiff_t>(curve.size());
  const auto away = static_cast<std::ptrdiff_t>(std::lround(away_s / step_s));
  const std::ptrdiff_t reach = std::max<std::ptrdiff_t>(1, away);
  const double peak = curve[static_cast<std::size_t>(top)];
  double better = 0;
  if (top - reach >= 0) better = std::max(better, curve[static_cast<std::size_t>(top - reach)]);
  if (top + reach < size) better = std::max(better, curve[static_cast<std::size_t>(top + reach)]);
  return peak > 0 ? 1 - better / peak : 0;
}

/// Share of the distance of two rows to which a lag between them is told at best.
constexpr double of_a_row = 0.1;

/// Half of the 95 % interval of a maximum, by how the log-likelihood per row bends there. Rows that a low-pass leaves
/// alike count as one.
double give_or_take_s(const std::vector<double>& curve, const LagGrid& grid, double seconds, std::size_t rows,
                      double low_pass_Hz) noexcept {
  constexpr double deviations = 2;
  const auto top = static_cast<std::size_t>(std::max_element(curve.begin(), curve.end()) - curve.begin());
  if (top == 0 || top + 1 >= curve.size()) return 0;
  const double bend = 2 * curve[top] - curve[top - 1] - curve[top + 1];
  double independent = static_cast<double>(rows);
  if (low_pass_Hz > 0) independent = std::min(independent, 2 * low_pass_Hz * seconds);
  if (!(bend > 0 && independent > 0)) return HUGE_VAL;
  const double row_s = grid.period_s * static_cast<double>(grid.fine);
  return std::hypot(deviations * grid.step_s() / std::sqrt(independent * bend), of_a_row * row_s);
}

/// Gives rows weights by blocks of time, so that a catch by hand or a knock weighs no more than the liveliest of the
/// others: by the motion that is wildest, each against its own usual energy.
void weigh(std::vector<LagSeries>& all, double period_s) {
  std::size_t rows = 0;
  for (const LagSeries& one : all) rows += one.size();
  const std::size_t blocks = detail::block_count(static_cast<double>(rows) * period_s);
  const auto block_of = [&](std::size_t row) {
    return std::min(blocks - 1, row * blocks / std::max<std::size_t>(1, rows));
  };
  std::vector<double> wildest(blocks, 0.0);
  for (std::size_t m = 0; m < lag_motions; ++m) {
    std::vector<double> energies(blocks, 0.0), values;
    for (const LagSeries& one : all) values.insert(values.end(), one.motions[m].begin(), one.motions[m].end());
    if (values.empty()) return;
    const double usual = detail::median_of(values);
    for (std::size_t row = 0; row < rows; ++row)
      energies[block_of(row)] += (values[row] - usual) * (values[row] - usual);
    const double middle = detail::median_of(energies);
    if (!(middle > 0)) continue;
    for (std::size_t k = 0; k < blocks; ++k) wildest[k] = std::max(wildest[k], energies[k] / middle);
  }
  const std::vector<double> weights = detail::block_weights(wildest);
  std::size_t row = 0;
  for (LagSeries& one : all) {
    one.weights.resize(one.size());
    for (double& weight : one.weights) weight = weights[block_of(row++)];
  }
}

std::string milliseconds(double seconds) { return std::to_string(std::lround(seconds * 1e3)) + " ms"; }

CommandLag command_lag_of(const std::vector<LagSeries>& series, const LagGrid& grid, double low_pass_Hz) {
  constexpr double least_explained = 0.05, least_sharpness = 0.1, says_as_much = 0.6, alike_s = 0.02;
  CommandLag result;
  result.low_pass_Hz = low_pass_Hz;
  double seconds = 0;
  for (const LagSeries& one : series) seconds += static_cast<double>(one.size() * grid.fine) * grid.period_s;
  const std::vector<Explained> explained = explained_by_lag(series, grid, result.rows);
  std::array<std::vector<double>, lag_motions> curves;
  bool any_told = false;
  for (std::size_t m = 0; m < lag_motions; ++m) {
    MotionLag& motion = result.motions[m];
    std::vector<double>& curve = curves[m];
    for (const Explained& at : explained) curve.push_back(say(at[m]));
    const double peak = peak_at(curve);
    const auto top = static_cast<std::size_t>(std::lround(peak));
    motion.lag_s = grid.lag_s(peak);
    motion.explained = explained[top][m];
    motion.low_passed = low_pass_Hz > 0;
    motion.sharpness = sharpness_of(curve, grid.step_s());
    motion.found =
        motion.explained >= least_explained && motion.sharpness >= least_sharpness && top > 0 && top + 1 < curve.size();
    result.found = result.found || motion.found;
  }
  for (MotionLag& motion : result.motions) {
    const auto with = std::count_if(result.motions.begin(), result.motions.end(), [&](const MotionLag& other) {
      return other.found && std::abs(other.lag_s - motion.lag_s) <= alike_s;
    });
    motion.alone = with < 2;  // itself
    any_told = any_told || motion.told();
  }
  if (!result.found) return result;
  // what disturbs a motion comes back through the controller: where some motions are told, they alone count
  const auto counts = [&](const MotionLag& motion) { return any_told ? motion.told() : motion.found; };
  std::vector<double> together(explained.size(), 0.0);
  double most = 0;
  for (std::size_t m = 0; m < lag_motions; ++m) {
    if (!counts(result.motions[m])) continue;
    for (std::size_t i = 0; i < together.size(); ++i) together[i] += curves[m][i];
    most = std::max(most, say(result.motions[m].explained) * result.motions[m].sharpness);
  }
  result.lag_s = grid.lag_s(peak_at(together));
  result.confidence = sharpness_of(together, grid.step_s());
  result.give_or_take_s = give_or_take_s(together, grid, seconds, result.rows, low_pass_Hz);
  for (const MotionLag& motion : result.motions) {
    if (!counts(motion) || say(motion.explained) * motion.sharpness < says_as_much * most) continue;
    result.spread_s = std::max(result.spread_s, std::abs(motion.lag_s - result.lag_s));
  }
  // motion before its command is the fault of a clock, which all motions show, or an answer to a blow
  const bool all_alike = std::all_of(result.motions.begin(), result.motions.end(), [&](const MotionLag& motion) {
    return !motion.found || std::abs(motion.lag_s - result.lag_s) <= alike_s;
  });
  result.told = any_told && (all_alike || result.lag_s > -0.5 * grid.step_s());
  return result;
}

/// The weight of all motions that count, at their best: it prefers one band to another, first of all one that tells.
double total_say(const CommandLag& lag) noexcept {
  constexpr double told = 100;
  double total = 0;
  for (const MotionLag& motion : lag.motions) {
    if (lag.told ? motion.told() : motion.found) total += say(motion.explained);
  }
  return total + (lag.told ? told : 0);
}

/// Why the lag is not known, or that it is negative.
void add_warning(CommandLag& best, double period_s, double step_s) {
  if (!best.found) best.lag_s = 0;
  if (best.known()) {
    if (best.lag_s < -0.5 * step_s) {
      best.warning = "the motion comes " + milliseconds(-best.lag_s) +
                     " before the commands: the clocks of the two differ, or the commands are those of a later stage";
    }
  } else if (best.rows == 0) {
    best.warning = "no stretch of the flight is long enough to look for a lag";
  } else if (!best.found) {
    best.warning = "no lag stands out: the commands explain the motion alike whenever they act";
  } else if (!best.told) {
    best.warning =
        "the commands explain too little of the motion: what else moves the vehicle (gusts, a gyro's noise) comes back "
        "through the controller as commands, and looks like a lag of " +
        milliseconds(best.lag_s);
  } else if (best.spread_s > CommandLag::spread_of_doubt_s) {
    best.warning = "the motions disagree about the lag by " + milliseconds(best.spread_s);
  } else if (best.give_or_take_s > CommandLag::known_s) {
    const bool far_apart = of_a_row * period_s > 0.9 * CommandLag::known_s;
    best.warning =
        (far_apart ? "rows " + milliseconds(period_s) + " apart don't tell it to " + milliseconds(CommandLag::known_s)
                   : std::string("the flight is too short or too calm to tell it")) +
        ": it looks like " + milliseconds(best.lag_s) + ", give or take " + milliseconds(best.give_or_take_s);
  } else {
    best.warning = "the lag hardly stands out: one that is 50 ms away explains the motion nearly as well";
  }
}

}  // namespace

std::vector<LagSeries> lag_series(const std::vector<Flight>& segments) {
  std::vector<LagSeries> all(segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    LagSeries& one = all[i];
    for (auto& series : one.commands) series.reserve(segments[i].size());
    for (auto& series : one.rates) series.reserve(segments[i].size());
    for (auto& series : one.motions) series.reserve(segments[i].size());
    for (const Sample& sample : segments[i]) {
      for (std::size_t k = 0; k < rotor_count; ++k) one.commands[k].push_back(sample.commands[k]);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        one.rates[k].push_back(sample.body_rates_rad_s[axis]);
        one.motions[k].push_back(sample.angular_acceleration_rad_s2[axis]);
      }
      one.motions[3].push_back(specific_force_m_s2(sample)[2]);
    }
  }
  return all;
}

std::vector<LagSeries> low_passed(std::vector<LagSeries> all, double period_s, double corner_Hz) {
  for (LagSeries& one : all) {
    for (auto& series : one.commands) low_pass_without_phase(series, period_s, corner_Hz);
    for (auto& series : one.rates) low_pass_without_phase(series, period_s, corner_Hz);
    for (auto& series : one.motions) low_pass_without_phase(series, period_s, corner_Hz);
  }
  return all;
}

LagMoments lag_moments(const std::vector<LagSeries>& all, std::size_t ahead, std::size_t behind, int lag,
                       std::size_t step, std::size_t& rows) {
  LagMoments moments{};
  rows = set_products<0, lag_columns>(all, ahead, behind, lag, 1, step, moments);
  return moments;
}

void take_out(LagMoments& moments, std::size_t k, double least) {
  const auto row = moments[k];
  if (!(row[k] > least)) return;
  for (auto& other : moments) {
    const double factor = other[k] / row[k];
    for (std::size_t j = 0; j < lag_columns; ++j) other[j] -= factor * row[j];
  }
}

CommandLag estimate_command_lag(const std::vector<Flight>& segments, double period_s, const LagRange& range) {
  return estimate_command_lags(segments, period_s, {range}).front();
}

std::vector<CommandLag> estimate_command_lags(const std::vector<Flight>& segments, double period_s,
                                              const std::vector<LagRange>& ranges) {
  std::vector<LagSeries> series = lag_series(segments);
  weigh(series, period_s);
  std::vector<CommandLag> best(ranges.size());
  for (const double corner_Hz : {0.0, 15.0, 8.0}) {
    if (corner_Hz * period_s > 0.4) continue;
    std::vector<LagSeries> band;
    if (corner_Hz > 0) band = low_passed(series, period_s, corner_Hz);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const CommandLag other = command_lag_of(corner_Hz > 0 ? band : series, LagGrid(period_s, ranges[i]), corner_Hz);
      if (!(corner_Hz > 0) || total_say(other) > total_say(best[i])) best[i] = other;
    }
  }
  for (std::size_t i = 0; i < ranges.size(); ++i) add_warning(best[i], period_s, LagGrid(period_s, ranges[i]).step_s());
  return best;
}

std::vector<double> remove_lag(const std::vector<double>& series, double period_s, double lag_s) {
  constexpr double rounding = 1e-6;  // of a period
  std::vector<double> result(series.size(), std::nan(""));
  const double rows = lag_s / period_s;
  for (std::size_t row = 0; row < series.size(); ++row) {
    const double at = static_cast<double>(row) - rows;
    const double before = std::floor(at + rounding);
    const double share = at - before > rounding ? at - before : 0;
    if (!(before >= 0) || !(before + (share > 0 ? 1 : 0) < static_cast<double>(series.size()))) continue;
    const auto index = static_cast<std::size_t>(before);
    result[row] = share > 0 ? series[index] + share * (series[index + 1] - series[index]) : series[index];
  }
  return result;
}

Flight remove_lag(Flight segment, double period_s, double lag_s) {
  std::vector<double> commands(segment.size());
  for (std::size_t k = 0; k < rotor_count; ++k) {
    for (std::size_t row = 0; row < segment.size(); ++row) commands[row] = segment[row].commands[k];
    const std::vector<double> earlier = remove_lag(commands, period_s, lag_s);
    for (std::size_t row = 0; row < segment.size(); ++row) segment[row].commands[k] = earlier[row];
  }
  segment.keep_rows([&segment](std::size_t row) { return !std::isnan(segment[row].commands[0]); });
  return segment;
}

}  // namespace pinnquad::logs
