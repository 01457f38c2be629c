// SPDX-License-Identifier: MIT
#include "logs/tumbling.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "logs/log_checks.hpp"
#include "pinnquad/data/plausibility.hpp"

namespace pinnquad::logs {
namespace {

using Series = std::vector<double>;

/// Where a rate is at the end of its range.
void mark_rate(const Series& rate, RowMask& wild) {
  constexpr double ends_rad_s = 34, least_rad_s = 15, close = 1e-6;
  constexpr std::size_t held_rows = 3;
  double most = 0;
  for (const double value : rate) most = std::isfinite(value) ? std::max(most, std::abs(value)) : most;
  std::size_t held = 0, longest = 0;
  for (const double value : rate) {
    held = std::abs(value) >= most - close ? held + 1 : 0;
    longest = std::max(longest, held);
  }
  const double end = longest >= held_rows && most > least_rad_s ? std::min(most - close, ends_rad_s) : ends_rad_s;
  for (std::size_t row = 0; row < rate.size(); ++row) wild[row] = wild[row] || std::abs(rate[row]) >= end;
}

/// Where a force is beyond what rotors and air make; `down_only`: along the rotors' axis.
void mark_force(const Series& force, bool down_only, RowMask& wild) {
  constexpr double least_m_s2 = 40, deviations = 10, normal = 1.4826;
  Series sizes;
  for (const double value : force) {
    if (std::isfinite(value)) sizes.push_back(std::abs(value));
  }
  if (sizes.empty()) return;
  const double most = std::max(least_m_s2, down_only ? 0 : deviations * normal * detail::median_of(std::move(sizes)));
  for (std::size_t row = 0; row < force.size(); ++row) {
    wild[row] = wild[row] || (down_only ? force[row] : std::abs(force[row])) >= most;
  }
}

}  // namespace

Tumbling find_tumbling(const CommonRows& rows) {
  constexpr double together_s = 0.5, margin_s = 0.15, most_share = 0.1;
  constexpr std::size_t fewest = 3;
  Tumbling result;
  const std::size_t count = rows.rows();
  RowMask wild(count, false);
  for (const Series& rate : rows.body_rates) mark_rate(rate, wild);
  for (std::size_t axis = 0; axis < 3; ++axis) mark_force(rows.specific_force[axis], axis == 2, wild);
  RowMask out(count, false);
  for (std::size_t row = 0; row < count; ++row) {
    if (!wild[row]) continue;
    std::size_t last = row, found = 1;
    for (std::size_t next = row + 1; next < count && rows.time_s[next] - rows.time_s[last] <= together_s; ++next) {
      if (!wild[next]) continue;
      last = next;
      ++found;
    }
    if (found >= fewest) {
      std::size_t begin = row, end = last + 1;
      while (begin > 0 && rows.time_s[row] - rows.time_s[begin - 1] <= margin_s) --begin;
      while (end < count && rows.time_s[end] - rows.time_s[last] <= margin_s) ++end;
      std::fill(out.begin() + static_cast<std::ptrdiff_t>(begin), out.begin() + static_cast<std::ptrdiff_t>(end), true);
      result.told.push_back(short_number(rows.time_s[last] - rows.time_s[row]) + " s of tumbling at " +
                            short_number(rows.time_s[row] - rows.time_s.front()) + " s");
    }
    row = last;
  }
  const auto left_out = static_cast<double>(std::count(out.begin(), out.end(), true));
  if (result.told.empty() || left_out > most_share * static_cast<double>(count)) return {};
  result.out = std::move(out);
  return result;
}

void leave_out(CommonRows& rows, const RowMask& out) {
  for (std::size_t row = 0; row < out.size(); ++row) {
    if (!out[row]) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rows.body_rates[axis][row] = std::nan("");
      if (!rows.specific_force[axis].empty()) rows.specific_force[axis][row] = std::nan("");
    }
  }
}

}  // namespace pinnquad::logs
