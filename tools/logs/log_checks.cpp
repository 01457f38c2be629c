// SPDX-License-Identifier: MIT
#include "logs/log_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>

#include "pinnquad/data/split.hpp"

namespace pinnquad::logs {
namespace {

/// Runs of identical values that last `longest_s` or longer and hold `fewest_rows` or more; NaN ends a run.
std::vector<IndexRange> frozen_rows(const std::vector<double>& time_s, const std::vector<double>& values,
                                    double longest_s = 0.3, std::size_t fewest_rows = 10) {
  std::vector<IndexRange> runs;
  for (std::size_t begin = 0, end = 0; begin < values.size(); begin = end) {
    for (end = begin + 1; end < values.size() && !(values[end] < values[begin] || values[end] > values[begin]) &&
                          std::isfinite(values[end]);) {
      ++end;
    }
    if (!std::isfinite(values[begin]) || end - begin < fewest_rows) continue;
    if (time_s[end - 1] - time_s[begin] >= longest_s) runs.push_back({begin, end});
  }
  return runs;
}

}  // namespace

std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string many_flights(const std::vector<std::string>& names) {
  return std::to_string(names.size()) + " flights, " + names[0] + ", " + names[1] + " ... " + names.back();
}

std::string with_interval(const Estimate& estimate, const char* unit) {
  return short_number(estimate.value) + " " + unit + " (" + short_number(estimate.low()) + " to " +
         short_number(estimate.high()) + ")";
}

std::vector<std::string> check_clock(const std::string& topic, const ClockReport& report) {
  constexpr double jump_s = 1, jump_periods = 20, share_in_gaps = 0.05, share_of_rows = 0.01;
  std::vector<std::string> findings;
  const double period = report.nominal_period_s;
  if (report.restarts > 0) {
    findings.push_back(topic + ": time steps back by up to " + short_number(report.largest_step_back_s) + " s, " +
                       std::to_string(report.restarts) +
                       " times: two recordings in one file, or a clock that was set in flight; cut it there");
  }
  if (report.largest_step_s > jump_s && report.largest_step_s > jump_periods * period) {
    findings.push_back(topic + ": time jumps by " + short_number(report.largest_step_s) + " s between rows that are " +
                       short_number(1e3 * period) +
                       " ms apart elsewhere; what lies on both sides is treated as two flights");
  }
  const double rows = static_cast<double>(report.rows_kept);
  const double steady = report.time_in_gaps_s - (report.largest_step_s > jump_s ? report.largest_step_s : 0);
  if (period > 0 && steady > share_in_gaps * rows * period) {
    findings.push_back(topic + ": " + std::to_string(report.gaps) + " gaps, " + short_number(steady) +
                       " s in sum: the logger lost rows; a faster card or fewer topics help");
  }
  const double lost = static_cast<double>(report.same_time + report.not_a_time);
  if (lost > share_of_rows * static_cast<double>(report.rows_read)) {
    findings.push_back(topic + ": " + std::to_string(report.same_time) + " rows have a time that another row has, " +
                       std::to_string(report.not_a_time) + " have none");
  }
  return findings;
}

std::optional<std::string> check_log_rate(const std::string& topic, double period_s, bool px4) {
  if (!(period_s * least_log_rate_Hz > 1.0 + 1e-3)) return std::nullopt;
  std::string sentence = topic + " was logged at " + short_number(1 / period_s) +
                         " Hz, too slow to see what the motors do (50 Hz or more is good)";
  if (px4) {
    sentence += ": set SDLOG_PROFILE to 25 (default 1, system identification 8 and high rate 16 together) and restart";
  }
  return sentence;
}

std::optional<std::string> check_frozen(const std::string& name, const std::vector<double>& time_s,
                                        const std::vector<double>& values, double longest_s) {
  const std::vector<IndexRange> runs = frozen_rows(time_s, values, longest_s);
  if (runs.empty()) return std::nullopt;
  double sum_s = 0;
  for (const IndexRange& run : runs) sum_s += time_s[run.end - 1] - time_s[run.begin];
  const IndexRange& first = runs.front();
  const bool whole = first.size() == values.size();
  return whole ? name + " never changes: it was not measured"
               : name + " stands still for " + short_number(sum_s) + " s in " + std::to_string(runs.size()) +
                     (runs.size() == 1 ? " stretch" : " stretches") + ", first at " +
                     short_number(time_s[first.begin] - time_s.front()) +
                     " s: what stopped there measured nothing, drop it";
}

}  // namespace pinnquad::logs
