// SPDX-License-Identifier: MIT
// A topic's values on another clock: lines between neighbours, the last value held, a local mean where the topic is
// faster than the clock, attitudes along the shorter arc. NaN where the topic has none: in gaps and outside its time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "logs/common_clock.hpp"
#include "pinnquad/core/rotation.hpp"

namespace programs {

enum class Resampling {
  linear,    ///< between the neighbours: signals that are smooth at their own rate
  hold,      ///< the last one before: commands, set points, flags
  low_pass,  ///< line under a triangle of +- one period of the new clock: a noisy signal that is faster than it
};

/// The resampling that suits a topic: a signal at more than 1.5 times the new clock's rate is low-passed, or what it
/// has above half the new rate would fold into the band (the triangle's gain is 0.41 at half the new rate, below 0.05
/// beyond it once and a half; no phase). Held signals too: their mean over a period is what the motor saw.
constexpr Resampling resampling_of(double topic_period_s, double new_period_s, bool held) noexcept {
  if (topic_period_s > 0 && topic_period_s * 1.5 < new_period_s) return Resampling::low_pass;
  return held ? Resampling::hold : Resampling::linear;
}

/// The longest step between neighbours that is bridged, s: beyond it rows are NaN.
inline double bridged_gap_s(const CleanClock& clock, double nominal_periods = 3.5) noexcept {
  return nominal_periods * clock.report.nominal_period_s;
}

namespace detail {

/// Index of the last of `time_s` that is not after `t`, where `from` is one of an earlier t; size() if there is none.
inline std::size_t last_not_after(const std::vector<double>& time_s, double t, std::size_t from) noexcept {
  if (time_s.empty() || time_s.front() > t) return time_s.size();
  std::size_t i = from < time_s.size() && time_s[from] <= t ? from : 0;
  while (i + 1 < time_s.size() && time_s[i + 1] <= t) ++i;
  return i;
}

/// Stamps are whole microseconds and clocks are sums: half of one is the same time.
inline constexpr double same_time_s = 0.5e-6;

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

}  // namespace detail

/// `values` by the topic's own row, as in its file; a cell that is NaN is a row that the topic does not have, so that a
/// step over it may become too long to bridge. `largest_gap_s`: of bridged_gap_s().
inline std::vector<double> resample(const CleanClock& clock, const std::vector<double>& values, const UniformClock& to,
                                    Resampling kind, double largest_gap_s) {
  std::vector<double> time_s, y;
  for (std::size_t i = 0; i < clock.size(); ++i) {
    const double value = values[clock.row[i]];
    if (!std::isfinite(value)) continue;
    time_s.push_back(clock.time_s[i]);
    y.push_back(value);
  }
  std::vector<double> result(to.rows, std::nan(""));
  const double bridged = largest_gap_s + detail::same_time_s;
  std::size_t at = 0, first = 0;
  for (std::size_t row = 0; row < to.rows; ++row) {
    const double t = to.at(row) + detail::same_time_s;
    at = detail::last_not_after(time_s, t, at);
    if (at == time_s.size()) {
      at = 0;
      continue;
    }
    const bool last = at + 1 == time_s.size();
    if (last ? t - time_s[at] > (kind == Resampling::hold ? bridged : 2 * detail::same_time_s)
             : time_s[at + 1] - time_s[at] > bridged && t - time_s[at] > 2 * detail::same_time_s) {
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
    detail::LocalLine line;
    for (std::size_t i = begin; i < end; ++i) {
      const double dt = time_s[i] - to.at(row);
      line.add(dt, y[i], std::max(0.0, 1 - std::abs(dt) / to.period_s));
    }
    if (line.weight > 0) result[row] = line.at_zero();  // else a bridged gap: the line between its ends stays
  }
  return result;
}

/// w, x, y, z by row. Between neighbours q and the one of +-q' that is nearer, along the great arc (by the normalised
/// line where they are within 1e-6 rad, where both agree to rounding). What is no unit quaternion (up to 5 %; it is
/// normalised) is a missing row. Sign-continuous from row to row.
inline std::array<std::vector<double>, 4> resample_attitude(const CleanClock& clock,
                                                            const std::array<const std::vector<double>*, 4>& wxyz,
                                                            const UniformClock& to, double largest_gap_s) {
  constexpr double norm_tolerance = 0.05;
  std::vector<double> time_s;
  std::vector<pinnquad::Quaternion<double>> q;
  for (std::size_t i = 0; i < clock.size(); ++i) {
    const std::size_t row = clock.row[i];
    pinnquad::Quaternion<double> one{(*wxyz[0])[row], (*wxyz[1])[row], (*wxyz[2])[row], (*wxyz[3])[row]};
    const double norm = std::sqrt(pinnquad::squared_norm(one));
    if (!(std::abs(norm - 1) <= norm_tolerance)) continue;
    one = pinnquad::normalized(one);
    if (!q.empty()) {
      const pinnquad::Quaternion<double>& b = q.back();
      if (one.w * b.w + one.x * b.x + one.y * b.y + one.z * b.z < 0) one = {-one.w, -one.x, -one.y, -one.z};
    }
    time_s.push_back(clock.time_s[i]);
    q.push_back(one);
  }
  std::array<std::vector<double>, 4> result;
  result.fill(std::vector<double>(to.rows, std::nan("")));
  std::size_t at = 0;
  for (std::size_t row = 0; row < to.rows; ++row) {
    const double t = to.at(row) + detail::same_time_s;
    at = detail::last_not_after(time_s, t, at);
    if (at == time_s.size()) {
      at = 0;
      continue;
    }
    pinnquad::Quaternion<double> value = q[at];
    const double since = std::max(0.0, to.at(row) - time_s[at]);
    if (since > detail::same_time_s) {
      if (at + 1 == time_s.size() || time_s[at + 1] - time_s[at] > largest_gap_s + detail::same_time_s) continue;
      const pinnquad::Quaternion<double>& b = q[at + 1];
      const double share = since / (time_s[at + 1] - time_s[at]);
      const double cosine = std::min(1.0, value.w * b.w + value.x * b.x + value.y * b.y + value.z * b.z);
      const double angle = std::acos(cosine);
      double of_a = 1 - share, of_b = share;
      if (angle > 1e-6) {
        of_a = std::sin((1 - share) * angle) / std::sin(angle);
        of_b = std::sin(share * angle) / std::sin(angle);
      }
      value =
          pinnquad::normalized(pinnquad::Quaternion<double>{of_a * value.w + of_b * b.w, of_a * value.x + of_b * b.x,
                                                            of_a * value.y + of_b * b.y, of_a * value.z + of_b * b.z});
    }
    result[0][row] = value.w;
    result[1][row] = value.x;
    result[2][row] = value.y;
    result[3][row] = value.z;
  }
  return result;
}

}  // namespace programs
