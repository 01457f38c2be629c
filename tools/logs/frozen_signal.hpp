// SPDX-License-Identifier: MIT
// A measured signal that stands still: a sensor or a link that stopped while its last value was still written.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "logs/clock_checks.hpp"
#include "logs/finding.hpp"
#include "pinnquad/data/split.hpp"

namespace programs {

/// Runs of identical values that last `longest_s` or longer and hold `fewest_rows` or more; NaN ends a run.
inline std::vector<pinnquad::IndexRange> frozen_rows(const std::vector<double>& time_s,
                                                     const std::vector<double>& values, double longest_s = 0.3,
                                                     std::size_t fewest_rows = 10) {
  std::vector<pinnquad::IndexRange> runs;
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

/// Of a signal that is measured and in motion: body rates, specific force, attitude in the air. Not of commands (they
/// saturate), battery voltage (it is coarse), nor of rows on the ground. number: seconds that are frozen.
/// Limits: a signal of few digits that hardly moves looks frozen; one that is held longer than it is measured (a topic
/// copied at a higher rate) does so only from `longest_s` on.
inline std::optional<Finding> check_frozen(const std::string& name, const std::vector<double>& time_s,
                                           const std::vector<double>& values, double longest_s = 0.3) {
  const std::vector<pinnquad::IndexRange> runs = frozen_rows(time_s, values, longest_s);
  if (runs.empty()) return std::nullopt;
  double sum_s = 0;
  for (const pinnquad::IndexRange& run : runs) sum_s += time_s[run.end - 1] - time_s[run.begin];
  const pinnquad::IndexRange& first = runs.front();
  const bool whole = first.size() == values.size();
  return Finding{"frozen", sum_s, "s",
                 whole ? name + " never changes: it was not measured"
                       : name + " stands still for " + detail::short_number(sum_s) + " s in " +
                             std::to_string(runs.size()) + (runs.size() == 1 ? " stretch" : " stretches") +
                             ", first at " + detail::short_number(time_s[first.begin] - time_s.front()) +
                             " s: what stopped there measured nothing, drop it"};
}

}  // namespace programs
