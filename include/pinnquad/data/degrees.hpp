// SPDX-License-Identifier: MIT
// Are angles or body rates in degrees? Asked of the motion, not of the range: from row to row the attitude turns by the body
// rates. In radians throughout the slope between the two is 1; with one of them in degrees it is 57.3 or 1 / 57.3.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "pinnquad/core/rotation.hpp"
#include "pinnquad/data/dataset.hpp"

namespace pinnquad {

/// Which columns are in degrees.
struct DegreesFound {
  std::array<bool, 3> angle{};  ///< roll, pitch, yaw
  bool body_rates = false;      ///< all three
};

namespace detail {

/// Body rates, mean over a step of `dt_s`, that turn the attitude (roll, pitch, yaw, rad) of its begin into that of its end.
inline Vector3<double> turning_rate(const std::array<double, 3>& begin, const std::array<double, 3>& end, double dt_s) {
  const auto quaternion = [](const std::array<double, 3>& angles) {
    return from_euler(EulerAngles<double>{angles[0], angles[1], angles[2]});
  };
  const Quaternion<double> q = conjugate(quaternion(begin)) * quaternion(end);
  const double shorter_way = q.w < 0 ? -1 : 1;
  const double w = shorter_way * q.w;
  const Vector3<double> v = shorter_way * Vector3<double>(q.x, q.y, q.z);
  const double sine = v.norm();
  const double turn = sine > 1e-12 ? 2 * std::atan2(sine, w) / sine : 2.0;
  return v * (turn / dt_s);
}

/// Steps of at least `step_s`, without gaps, one after the other: visit(first row, last row).
template <class Visit>
void for_each_step(const Flight& flight, double step_s, Visit&& visit) {
  constexpr double longest_step_s = 0.5;
  for (std::size_t first = 0, last = 0; first < flight.size(); first = last) {
    bool usable = true;
    const double begin_s = flight[first].time_s;
    for (last = first; usable && last + 1 < flight.size() && flight[last].time_s - begin_s < step_s; ++last) {
      const Sample& next = flight[last + 1];
      usable = next.time_s - flight[last].time_s > 0 && next.time_s - begin_s <= longest_step_s;
    }
    if (last == first) break;
    if (usable) visit(first, last);
  }
}

/// Steps of 0.2 s: visit(first sample, last sample, mean body rates over it, its length in s).
/// A measured attitude jitters from row to row; over a step it turns.
template <class Visit>
void for_each_turning_step(const Flight& flight, Visit&& visit) {
  constexpr double step_s = 0.2, largest = 1e4;  // beyond is no angle and no rate, whatever the unit
  for_each_step(flight, step_s, [&](std::size_t first, std::size_t last) {
    // rates by the trapezium rule from row to row, the attitude by its ends
    Vector3<double> turned = Vector3<double>::Zero();
    for (std::size_t row = first; row < last; ++row) {
      const Sample& a = flight[row];
      const Sample& b = flight[row + 1];
      turned += (a.body_rates_rad_s + b.body_rates_rad_s) * ((b.time_s - a.time_s) / 2);
    }
    const double dt_s = flight[last].time_s - flight[first].time_s;
    const Vector3<double> rate = turned / dt_s;
    bool usable = rate.norm() <= largest;
    for (const Sample* end : {&flight[first], &flight[last]}) {
      for (const double angle : {end->roll_rad, end->pitch_rad, end->yaw_rad}) {
        usable = usable && std::abs(angle) <= largest;
      }
    }
    if (usable) visit(flight[first], flight[last], rate, dt_s);
  });
}

}  // namespace detail

/// Tries every choice of angles in degrees with rates in rad/s and in deg/s: the share of the rates' squares that the turning
/// of the attitude leaves unexplained, both over steps of 0.2 s, for a measured attitude jitters from row to row. Degrees are
/// found only where radians explain next to nothing (0.8 is left or more) and degrees more than half: a flight that hardly
/// turns, noise and gaps in time decide nothing.
inline DegreesFound find_degrees_by_motion(const Flight& flight) {
  constexpr double unexplained = 0.8, explained = 0.5;
  constexpr double smallest_rates = 1e-6;  // mean square
  constexpr std::size_t choices = 8;
  std::array<std::array<double, 2>, choices> residual{};  // [angles in degrees, a bit each][rates in degrees]
  double rates = 0, steps = 0;
  const auto judge = [&](const Sample& a, const Sample& b, const Vector3<double>& rate, double dt_s) {
    const std::array<double, 3> begin = {a.roll_rad, a.pitch_rad, a.yaw_rad},
                                end = {b.roll_rad, b.pitch_rad, b.yaw_rad};
    rates += rate.squaredNorm();
    steps += 1;
    for (std::size_t choice = 0; choice < choices; ++choice) {
      std::array<double, 3> from = begin, to = end;
      for (std::size_t i = 0; i < 3; ++i) {
        if ((choice >> i & 1u) == 0) continue;
        from[i] /= degrees_per_radian;
        to[i] /= degrees_per_radian;
      }
      const Vector3<double> turning = detail::turning_rate(from, to, dt_s);
      residual[choice][0] += (rate - turning).squaredNorm();
      residual[choice][1] += (rate - turning * degrees_per_radian).squaredNorm();
    }
  };
  detail::for_each_turning_step(flight, judge);
  DegreesFound found;
  if (!(rates > smallest_rates * steps) || !(residual[0][0] > unexplained * rates)) return found;
  std::size_t best = 0, best_rates = 0;
  for (std::size_t choice = 0; choice < choices; ++choice) {
    for (std::size_t unit = 0; unit < 2; ++unit) {
      if (residual[choice][unit] < residual[best][best_rates]) {
        best = choice;
        best_rates = unit;
      }
    }
  }
  if (!(residual[best][best_rates] < explained * rates)) return found;
  found.angle = {(best & 1u) != 0, (best & 2u) != 0, (best & 4u) != 0};
  found.body_rates = best_rates == 1;
  return found;
}

}  // namespace pinnquad
