// SPDX-License-Identifier: MIT
// One topic's clock made usable, and one uniform clock for all: what is out of order, twice, stale or not a time is put
// right or left out, and counted. Values: resampling.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/data/split.hpp"

namespace programs {

/// The cleaning of a topic's clock, in rows.
struct ClockReport {
  std::size_t rows_read = 0;
  std::size_t not_a_time = 0;      ///< NaN or infinite: left out
  std::size_t out_of_order = 0;    ///< earlier than a row before them: sorted in
  std::size_t same_time = 0;       ///< left out: of rows with one time the last of the file stays
  std::size_t stale_first = 0;     ///< left out: latched values from before the log began
  std::size_t restarts = 0;        ///< steps back by more than a second: two recordings in one, or a clock that was set
  double largest_step_back_s = 0;  ///< before sorting
  double nominal_period_s = 0;     ///< median step; 0 for fewer than two rows
  double largest_step_s = 0;       ///< after sorting
  std::size_t gaps = 0;            ///< steps longer than ClockRules::gap_periods nominal ones
  double time_in_gaps_s = 0;
  std::size_t rows_kept = 0;
};

struct ClockRules {
  double gap_periods = 3.5;  ///< longer steps, in nominal periods, are gaps
  double stale_periods =
      10;  ///< up to `most_stale` first rows are stale where a step of this and `stale_s` follows them
  double stale_s = 0.5;
  std::size_t most_stale = 2;
  double log_begin_s = -std::numeric_limits<double>::infinity();  ///< rows before it are stale as well
};

/// Times that increase strictly, and the topic's row that each is of.
struct CleanClock {
  std::vector<double> time_s;
  std::vector<std::size_t> row;
  ClockReport report;

  std::size_t size() const noexcept { return time_s.size(); }
};

/// A step back is no restart up to this: queues and buses reorder within it.
inline constexpr double restart_step_s = 1.0;

/// Puts a topic's clock right; of several rows with one time the last stays (a publisher that corrects itself does so
/// later). Never throws: a topic without one usable row has an empty clock.
inline CleanClock clean_clock(const std::vector<double>& time_s, const ClockRules& rules = {}) {
  CleanClock clock;
  ClockReport& report = clock.report;
  report.rows_read = time_s.size();
  std::vector<std::size_t> rows;
  double latest = -std::numeric_limits<double>::infinity(), before = latest;
  for (std::size_t row = 0; row < time_s.size(); ++row) {
    const double t = time_s[row];
    if (!std::isfinite(t)) {
      report.not_a_time += 1;
      continue;
    }
    if (t < latest) report.out_of_order += 1;
    if (t < before) {
      report.largest_step_back_s = std::max(report.largest_step_back_s, before - t);
      if (before - t > restart_step_s) report.restarts += 1;
    }
    latest = std::max(latest, t);
    before = t;
    rows.push_back(row);
  }
  std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) { return time_s[a] < time_s[b]; });
  for (const std::size_t row : rows) {
    if (!clock.time_s.empty() && !(time_s[row] > clock.time_s.back())) {
      report.same_time += 1;
      clock.row.back() = row;
      continue;
    }
    clock.time_s.push_back(time_s[row]);
    clock.row.push_back(row);
  }
  std::vector<double> steps;
  for (std::size_t i = 1; i < clock.size(); ++i) steps.push_back(clock.time_s[i] - clock.time_s[i - 1]);
  if (!steps.empty()) {
    std::vector<double> sorted = steps;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    report.nominal_period_s = *middle;
  }
  std::size_t stale = 0;
  while (stale < clock.size() && clock.time_s[stale] < rules.log_begin_s) ++stale;
  const double stale_step_s = std::max(rules.stale_s, rules.stale_periods * report.nominal_period_s);
  for (std::size_t i = 0; i < std::min(rules.most_stale, steps.size()); ++i) {
    if (steps[i] > stale_step_s && steps.size() > 2 * rules.most_stale) stale = std::max(stale, i + 1);
  }
  report.stale_first = stale;
  clock.time_s.erase(clock.time_s.begin(), clock.time_s.begin() + static_cast<std::ptrdiff_t>(stale));
  clock.row.erase(clock.row.begin(), clock.row.begin() + static_cast<std::ptrdiff_t>(stale));
  for (std::size_t i = stale; i < steps.size(); ++i) {
    report.largest_step_s = std::max(report.largest_step_s, steps[i]);
    if (!(steps[i] > rules.gap_periods * report.nominal_period_s)) continue;
    report.gaps += 1;
    report.time_in_gaps_s += steps[i];
  }
  report.rows_kept = clock.size();
  return clock;
}

/// begin, begin + period, ..., `rows` of them.
struct UniformClock {
  double begin_s = 0;
  double period_s = 0;
  std::size_t rows = 0;

  double at(std::size_t row) const noexcept { return begin_s + static_cast<double>(row) * period_s; }
};

/// The clock on which every topic has values on both sides: from the latest begin to the earliest end. `begin_s` is a
/// multiple of the period, so that clocks of one log with different topics have rows in common. No rows where the
/// topics don't meet. Throws std::invalid_argument for a period that is not above 0 and for no topics.
inline UniformClock common_clock(const std::vector<const CleanClock*>& topics, double period_s) {
  if (!(period_s > 0) || !std::isfinite(period_s)) {
    throw std::invalid_argument("common clock: expected a period above 0 s");
  }
  if (topics.empty()) throw std::invalid_argument("common clock: expected at least one topic");
  double begin = -std::numeric_limits<double>::infinity(), end = -begin;
  for (const CleanClock* topic : topics) {
    if (topic->time_s.empty()) return {0, period_s, 0};
    begin = std::max(begin, topic->time_s.front());
    end = std::min(end, topic->time_s.back());
  }
  constexpr double rounding = 1e-6;  // of a period: times are sums of steps, and stamps are whole microseconds
  const double first = std::ceil(begin / period_s - rounding), last = std::floor(end / period_s + rounding);
  constexpr double most_rows = 1e9;  // twelve days at 1 kHz: beyond, a time is no time
  if (!(last >= first) || last - first > most_rows) return {0, period_s, 0};
  return {first * period_s, period_s, static_cast<std::size_t>(last - first) + 1};
}

}  // namespace programs
