// SPDX-License-Identifier: MIT
#include "logs/clock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "pinnquad/core/rotation.hpp"

namespace pinnquad::logs {
namespace {

/// Index of the last of `time_s` that is not after `t`, where `from` is one of an earlier t; size() if there is none.
std::size_t last_not_after(const std::vector<double>& time_s, double t, std::size_t from) noexcept {
  if (time_s.empty() || time_s.front() > t) return time_s.size();
  std::size_t i = from < time_s.size() && time_s[from] <= t ? from : 0;
  while (i + 1 < time_s.size() && time_s[i + 1] <= t) ++i;
  return i;
}

/// Stamps are whole microseconds and clocks are sums: half of one is the same time.
constexpr double same_time_s = 0.5e-6;

/// The value at `t` of the least-squares line through points under a triangle; their mean where they are at one time.
struct LocalLine {
  double weight = 0, t = 0, tt = 0, y = 0, ty = 0;
  void add(double dt, double value, double w) noexcept {
    weight += w;
    t += w * dt;
    tt += w * dt * dt;
    y += w * value;
    ty += w * dt * value;
  }
  double at_zero() const noexcept {
    if (!(weight > 0)) return std::nan("");
    const double determinant = weight * tt - t * t;
    if (!(determinant > 1e-9 * weight * tt)) return y / weight;
    return (tt * y - t * ty) / determinant;
  }
};

/// The longest chain of rows whose times do not decrease, by the index in `time_s`.
std::vector<bool> longest_chain(const std::vector<double>& time_s, const std::vector<std::size_t>& rows) {
  std::vector<std::size_t> ends, before(rows.size(), rows.size());  // by length: the row whose time is the least
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto place = std::upper_bound(ends.begin(), ends.end(), time_s[rows[i]],
                                        [&](double t, std::size_t end) { return t < time_s[rows[end]]; });
    if (place != ends.begin()) before[i] = *(place - 1);
    if (place == ends.end()) {
      ends.push_back(i);
    } else {
      *place = i;
    }
  }
  std::vector<bool> in(rows.size(), false);
  for (std::size_t i = ends.empty() ? rows.size() : ends.back(); i < rows.size(); i = before[i]) in[i] = true;
  return in;
}

/// Rows whose time is more than a second off all rows around them that follow each other, or hours behind all others:
/// not among `rows` afterwards where they are few.
void leave_out_wild(const std::vector<double>& time_s, std::vector<std::size_t>& rows, ClockReport& report) {
  constexpr std::size_t most_at_end = 2;
  constexpr double hours_s = 3 * 3600;
  const auto at = [&](std::size_t i) { return time_s[rows[i]]; };
  bool steps_back = false;
  for (std::size_t i = 1; i < rows.size(); ++i) steps_back = steps_back || at(i - 1) - at(i) > restart_step_s;
  const bool late_end = rows.size() > 2 * most_at_end && at(rows.size() - 1) - at(rows.size() - 2) >= hours_s;
  if (!steps_back && !late_end) return;
  std::vector<bool> in(rows.size(), true);
  if (steps_back) in = longest_chain(time_s, rows);
  for (std::size_t n = 0; n < most_at_end && rows.size() > 2 * most_at_end; ++n) {  // nothing follows them
    std::size_t last = rows.size();
    while (last > 0 && !in[last - 1]) --last;
    if (last < 2 || !in[last - 2] || at(last - 1) - at(last - 2) < hours_s) break;
    in[last - 1] = false;
  }
  std::vector<std::size_t> left, wild;
  double before = -std::numeric_limits<double>::infinity();
  std::size_t next = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    while (next < rows.size() && (next <= i || !in[next])) ++next;
    const double after = next < rows.size() ? at(next) : before + restart_step_s;
    const bool near = at(i) > before - restart_step_s && at(i) < after + restart_step_s;  // a queue reorders so
    (in[i] || near ? left : wild).push_back(rows[i]);
    if (in[i]) before = at(i);
  }
  const std::size_t few = std::min(rows.size() / 10, std::max<std::size_t>(3, rows.size() / 100));
  if (wild.empty() || wild.size() > std::max<std::size_t>(1, few)) return;
  report.wild = wild.size();
  report.first_wild_s = time_s[wild.front()];
  rows = std::move(left);
}

}  // namespace

CleanClock clean_clock(const std::vector<double>& time_s) {
  constexpr double stale_periods = 10, stale_s = 0.5;  // a step of both behind first rows: they are old news
  constexpr std::size_t most_stale = 2;
  CleanClock clock;
  ClockReport& report = clock.report;
  report.rows_read = time_s.size();
  std::vector<std::size_t> rows;
  rows.reserve(time_s.size());
  for (std::size_t row = 0; row < time_s.size(); ++row) {
    if (std::isfinite(time_s[row])) {
      rows.push_back(row);
    } else {
      report.not_a_time += 1;
    }
  }
  leave_out_wild(time_s, rows, report);
  double latest = -std::numeric_limits<double>::infinity(), before = latest;
  for (const std::size_t row : rows) {
    const double t = time_s[row];
    if (t < latest) report.out_of_order += 1;
    if (t < before) {
      report.largest_step_back_s = std::max(report.largest_step_back_s, before - t);
      if (before - t > restart_step_s) report.restarts += 1;
    }
    latest = std::max(latest, t);
    before = t;
  }
  if (report.out_of_order > 0) {
    std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) { return time_s[a] < time_s[b]; });
  }
  clock.time_s.reserve(rows.size());
  clock.row.reserve(rows.size());
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
  steps.reserve(clock.size());
  for (std::size_t i = 1; i < clock.size(); ++i) steps.push_back(clock.time_s[i] - clock.time_s[i - 1]);
  if (!steps.empty()) {
    std::vector<double> sorted = steps;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    report.nominal_period_s = *middle;
  }
  std::size_t stale = 0;
  const double stale_step_s = std::max(stale_s, stale_periods * report.nominal_period_s);
  for (std::size_t i = 0; i < std::min(most_stale, steps.size()); ++i) {
    if (steps[i] > stale_step_s && steps.size() > 2 * most_stale) stale = i + 1;
  }
  report.stale_first = stale;
  clock.time_s.erase(clock.time_s.begin(), clock.time_s.begin() + static_cast<std::ptrdiff_t>(stale));
  clock.row.erase(clock.row.begin(), clock.row.begin() + static_cast<std::ptrdiff_t>(stale));
  for (std::size_t i = stale; i < steps.size(); ++i) {
    report.largest_step_s = std::max(report.largest_step_s, steps[i]);
    if (!(steps[i] > gap_periods * report.nominal_period_s)) continue;
    report.gaps += 1;
    report.time_in_gaps_s += steps[i];
  }
  report.rows_kept = clock.size();
  return clock;
}

UniformClock common_clock(const std::vector<const CleanClock*>& topics, double period_s) {
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

double bridged_gap_s(const CleanClock& clock) noexcept { return gap_periods * clock.report.nominal_period_s; }

std::vector<double> resample(const CleanClock& clock, const std::vector<double>& values, const UniformClock& to,
                             Resampling kind, double largest_gap_s) {
  std::vector<double> time_s, y;
  time_s.reserve(clock.size());
  y.reserve(clock.size());
  for (std::size_t i = 0; i < clock.size(); ++i) {
    const double value = values[clock.row[i]];
    if (!std::isfinite(value)) continue;
    time_s.push_back(clock.time_s[i]);
    y.push_back(value);
  }
  std::vector<double> result(to.rows, std::nan(""));
  const double bridged = largest_gap_s + same_time_s;
  std::size_t at = 0, first = 0;
  for (std::size_t row = 0; row < to.rows; ++row) {
    const double t = to.at(row) + same_time_s;
    at = last_not_after(time_s, t, at);
    if (at == time_s.size()) {
      at = 0;
      continue;
    }
    const bool last = at + 1 == time_s.size();
    if (last ? t - time_s[at] > (kind == Resampling::hold ? bridged : 2 * same_time_s)
             : time_s[at + 1] - time_s[at] > bridged && t - time_s[at] > 2 * same_time_s) {
      continue;
    }
    if (kind == Resampling::hold || last) {
      result[row] = y[at];
    } else {
      const double share = std::max(0.0, (to.at(row) - time_s[at]) / (time_s[at + 1] - time_s[at]));
      result[row] = share > 0 ? y[at] + share * (y[at + 1] - y[at]) : y[at];
    }
    if (kind != Resampling::low_pass) continue;
    // neighbours on both sides, up to the first gap
    while (first < time_s.size() && time_s[first] < to.at(row) - to.period_s) ++first;
    std::size_t begin = at, end = at + 1;
    while (begin > first && time_s[begin] - time_s[begin - 1] <= bridged) --begin;
    while (end < time_s.size() && time_s[end] < to.at(row) + to.period_s && time_s[end] - time_s[end - 1] <= bridged)
      ++end;
    LocalLine line;
    for (std::size_t i = begin; i < end; ++i) {
      const double dt = time_s[i] - to.at(row);
      line.add(dt, y[i], std::max(0.0, 1 - std::abs(dt) / to.period_s));
    }
    if (line.weight > 0) result[row] = line.at_zero();  // else a bridged gap: the line between its ends stays
  }
  return result;
}

std::array<std::vector<double>, 4> resample_attitude(const CleanClock& clock,
                                                     const std::array<const std::vector<double>*, 4>& wxyz,
                                                     const UniformClock& to, double largest_gap_s) {
  constexpr double norm_tolerance = 0.05;
  std::vector<double> time_s;
  std::vector<Quaternion<double>> q;
  for (std::size_t i = 0; i < clock.size(); ++i) {
    const std::size_t row = clock.row[i];
    Quaternion<double> one{(*wxyz[0])[row], (*wxyz[1])[row], (*wxyz[2])[row], (*wxyz[3])[row]};
    const double norm = std::sqrt(squared_norm(one));
    if (!(std::abs(norm - 1) <= norm_tolerance)) continue;
    one = normalized(one);
    if (!q.empty()) {
      const Quaternion<double>& b = q.back();
      if (one.w * b.w + one.x * b.x + one.y * b.y + one.z * b.z < 0) one = {-one.w, -one.x, -one.y, -one.z};
    }
    time_s.push_back(clock.time_s[i]);
    q.push_back(one);
  }
  std::array<std::vector<double>, 4> result;
  result.fill(std::vector<double>(to.rows, std::nan("")));
  std::size_t at = 0;
  for (std::size_t row = 0; row < to.rows; ++row) {
    const double t = to.at(row) + same_time_s;
    at = last_not_after(time_s, t, at);
    if (at == time_s.size()) {
      at = 0;
      continue;
    }
    Quaternion<double> value = q[at];
    const double since = std::max(0.0, to.at(row) - time_s[at]);
    if (since > same_time_s) {
      if (at + 1 == time_s.size() || time_s[at + 1] - time_s[at] > largest_gap_s + same_time_s) continue;
      const Quaternion<double>& b = q[at + 1];
      const double share = since / (time_s[at + 1] - time_s[at]);
      const double cosine = std::min(1.0, value.w * b.w + value.x * b.x + value.y * b.y + value.z * b.z);
      const double angle = std::acos(cosine);
      double of_a = 1 - share, of_b = share;
      if (angle > 1e-6) {
        of_a = std::sin((1 - share) * angle) / std::sin(angle);
        of_b = std::sin(share * angle) / std::sin(angle);
      }
      value = normalized(Quaternion<double>{of_a * value.w + of_b * b.w, of_a * value.x + of_b * b.x,
                                            of_a * value.y + of_b * b.y, of_a * value.z + of_b * b.z});
    }
    result[0][row] = value.w;
    result[1][row] = value.x;
    result[2][row] = value.y;
    result[3][row] = value.z;
  }
  return result;
}

}  // namespace pinnquad::logs
