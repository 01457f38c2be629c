// SPDX-License-Identifier: MIT
// How long after a command the vehicle moves, by how well the delayed commands explain the motion; and commands moved
// by it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "logs/lagged_motion.hpp"

namespace programs {

struct LagSearch {
  double longest_s = 0.2;     ///< motors and links are faster
  double shortest_s = -0.06;  ///< motion before its command: what a clock that is wrong or feedback looks like
};

/// Of one motion: angular acceleration about x, y, z, or specific force along z.
struct MotionLag {
  double lag_s = 0;
  double explained = 0;  ///< R^2 by the commands at the lag, beyond what a constant and the body rates explain
  double sharpness = 0;  ///< how much of -log(1 - R^2) is lost 50 ms away on the better side, 0..1
  bool found = false;    ///< a maximum inside the range, above and sharper than chance
};

struct CommandLag {
  std::array<MotionLag, detail::lag_motions> motions;  ///< roll, pitch, yaw, collective
  double lag_s = 0;                                    ///< where those found are explained best together
  double spread_s = 0;     ///< largest distance of one of them, with half the best one's say or more, to it
  double confidence = 0;   ///< sharpness of all found together, 0..1
  double low_pass_Hz = 0;  ///< up to where commands and motion were compared; 0: as they are
  bool found = false;      ///< otherwise lag_s is 0 and nothing should be removed
  std::string warning;     ///< why it is not found, or not to be trusted; empty for none
  std::size_t rows = 0;
};

namespace detail {

constexpr double lag_away_s = 0.05;
constexpr double least_explained = 0.05, least_sharpness = 0.1;

/// -log(1 - R^2): log-likelihood per row, so that motions of different noise can be added.
inline double say(double explained) noexcept { return -0.5 * std::log(std::max(1e-9, 1 - explained)); }

/// Index of a curve's maximum with the fraction that a parabola through its neighbours adds.
inline double peak_at(const std::vector<double>& curve) noexcept {
  const auto top = static_cast<std::size_t>(std::max_element(curve.begin(), curve.end()) - curve.begin());
  const auto at = static_cast<double>(top);
  if (top == 0 || top + 1 >= curve.size()) return at;
  const double bend = curve[top - 1] - 2 * curve[top] + curve[top + 1];
  return bend < 0 ? at + 0.5 * (curve[top - 1] - curve[top + 1]) / bend : at;
}

inline double sharpness_of(const std::vector<double>& curve, double step_s) noexcept {
  const auto top = std::max_element(curve.begin(), curve.end()) - curve.begin();
  const auto size = static_cast<std::ptrdiff_t>(curve.size());
  const auto away = static_cast<std::ptrdiff_t>(std::lround(lag_away_s / step_s));
  const std::ptrdiff_t reach = std::max<std::ptrdiff_t>(1, away);
  const double peak = curve[static_cast<std::size_t>(top)];
  double better = 0;
  if (top - reach >= 0) better = std::max(better, curve[static_cast<std::size_t>(top - reach)]);
  if (top + reach < size) better = std::max(better, curve[static_cast<std::size_t>(top + reach)]);
  return peak > 0 ? 1 - better / peak : 0;
}

inline std::string milliseconds(double seconds) { return std::to_string(std::lround(seconds * 1e3)) + " ms"; }

/// Lags in whole rows, a few milliseconds apart at most.
struct LagGrid {
  int first = 0, last = 0, stride = 1;
  double period_s = 0;
  LagGrid(const LagSearch& search, double period) : period_s(period) {
    constexpr double step_s = 0.004;
    stride = std::max(1, static_cast<int>(step_s / period));
    first = stride * static_cast<int>(std::floor(search.shortest_s / (period * stride)));
    last = stride * static_cast<int>(std::ceil(search.longest_s / (period * stride)));
  }
  double lag_s(double index) const noexcept { return (first + index * stride) * period_s; }
  double step_s() const noexcept { return stride * period_s; }
};

inline CommandLag command_lag_of(const std::vector<LagSeries>& series, const LagGrid& grid) {
  CommandLag result;
  const std::vector<Explained> explained = explained_by_lag(series, grid.first, grid.last, grid.stride, result.rows);
  std::vector<double> together(explained.size(), 0.0);
  std::array<double, lag_motions> weight{};
  for (std::size_t m = 0; m < lag_motions; ++m) {
    MotionLag& motion = result.motions[m];
    std::vector<double> curve;
    for (const Explained& at : explained) curve.push_back(say(at[m]));
    const double peak = peak_at(curve);
    const auto top = static_cast<std::size_t>(std::lround(peak));
    motion.lag_s = grid.lag_s(peak);
    motion.explained = explained[top][m];
    motion.sharpness = sharpness_of(curve, grid.step_s());
    motion.found =
        motion.explained >= least_explained && motion.sharpness >= least_sharpness && top > 0 && top + 1 < curve.size();
    if (!motion.found) continue;
    weight[m] = curve[top];
    result.found = true;
    for (std::size_t i = 0; i < curve.size(); ++i) together[i] += curve[i];
  }
  if (!result.found) return result;
  result.lag_s = grid.lag_s(peak_at(together));
  result.confidence = sharpness_of(together, grid.step_s());
  const double most = *std::max_element(weight.begin(), weight.end());
  for (std::size_t m = 0; m < lag_motions; ++m) {
    if (weight[m] < 0.5 * most) continue;
    result.spread_s = std::max(result.spread_s, std::abs(result.motions[m].lag_s - result.lag_s));
  }
  return result;
}

/// The weight of all motions found, at their best: it prefers one band to another.
inline double total_say(const CommandLag& lag) noexcept {
  double total = 0;
  for (const MotionLag& motion : lag.motions) total += motion.found ? say(motion.explained) : 0;
  return total;
}

}  // namespace detail

/// The lag at which the four commands explain angular accelerations and vertical specific force best: the multiple
/// correlation, so that neither the order of the motors nor the battery has to be known; a constant and the body rates
/// (damping) explain what they can first. Both sides are compared as they are, up to 15 Hz and up to 8 Hz, without
/// phase, and the band in which most is explained is taken: gyro noise that comes back through the controller as
/// commands pulls the plain correlation to shorter lags, by tens of milliseconds in calm flights.
/// Segments of one log, each on a uniform clock of `period_s`, commands as they were logged, idle and ground left out.
/// Limits: a motor behaves like a first-order lag, of which the best pure delay depends on how fast the commands
/// change: 36 to 40 ms for a time constant of 50 ms; MotorLag says more. A filter's delay in what was measured counts
/// as lag.
inline CommandLag estimate_command_lag(const std::vector<pinnquad::Flight>& segments, double period_s,
                                       const LagSearch& search = {}) {
  constexpr double spread_of_doubt_s = 0.03, confidence_of_doubt = 0.25;
  const std::vector<detail::LagSeries> series = detail::lag_series(segments);
  const detail::LagGrid grid(search, period_s);
  CommandLag best = detail::command_lag_of(series, grid);
  for (const double corner_Hz : {15.0, 8.0}) {
    if (corner_Hz * period_s > 0.4) continue;
    CommandLag other = detail::command_lag_of(detail::low_passed(series, period_s, corner_Hz), grid);
    other.low_pass_Hz = corner_Hz;
    if (detail::total_say(other) > detail::total_say(best)) best = other;
  }
  if (!best.found) {
    best.lag_s = 0;
    best.warning = best.rows == 0
                       ? "no stretch of the flight is long enough to look for a lag"
                       : "no lag stands out: the commands explain the motion alike whenever they act; fly more agile "
                         "manoeuvres, or state the lag";
  } else if (best.lag_s < -0.5 * grid.step_s()) {
    best.warning = "the motion comes " + detail::milliseconds(-best.lag_s) +
                   " before the commands: the clocks of the two differ, or the commands are those of a later stage";
  } else if (best.spread_s > spread_of_doubt_s) {
    best.warning = "the motions disagree about the lag by " + detail::milliseconds(best.spread_s);
  } else if (best.confidence < confidence_of_doubt) {
    best.warning =
        "the lag hardly stands out: one that is 50 ms away explains the motion nearly as well; fly more agile "
        "manoeuvres, or state the lag";
  }
  return best;
}

/// A series on a uniform clock, each row with the value of `lag_s` earlier, by lines between rows; NaN where there is
/// none.
inline std::vector<double> remove_lag(const std::vector<double>& series, double period_s, double lag_s) {
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

/// The commands of each row replaced by those of `lag_s` earlier; rows that have none are gone. Extra columns stay as
/// they are.
inline pinnquad::Flight remove_lag(pinnquad::Flight segment, double period_s, double lag_s) {
  std::vector<double> commands(segment.size());
  for (std::size_t k = 0; k < pinnquad::rotor_count; ++k) {
    for (std::size_t row = 0; row < segment.size(); ++row) commands[row] = segment[row].commands[k];
    const std::vector<double> earlier = remove_lag(commands, period_s, lag_s);
    for (std::size_t row = 0; row < segment.size(); ++row) segment[row].commands[k] = earlier[row];
  }
  segment.keep_rows([&segment](std::size_t row) { return !std::isnan(segment[row].commands[0]); });
  return segment;
}

}  // namespace programs
