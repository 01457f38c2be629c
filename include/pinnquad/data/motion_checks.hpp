// SPDX-License-Identifier: MIT
// Two checks of a flight by its motion, not by the range of its columns. Degrees: from row to row the attitude turns by
// the body rates; in radians throughout the slope between the two is 1, with one of them in degrees 57.3 or 1 / 57.3.
// Accelerations: w and v change by the integral of wdot and vdot; a column that is negated, or that of another axis,
// integrates to something else.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "pinnquad/core/rotation.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/io/decimal.hpp"

namespace pinnquad {

namespace detail {

/// A value that cannot be, or a whole column that is wrong.
struct Implausible {
  std::size_t row = 0;    ///< from 0
  std::size_t field = 0;  ///< index in `sample_field_names`
  std::string expected;   ///< "the derivative of w_x"
  std::string found;      ///< "that of w_y negated"
};

/// Columns in degrees.
struct DegreesFound {
  std::array<bool, 3> angle{};  ///< roll, pitch, yaw
  bool body_rates = false;      ///< all three
};

/// Body rates, mean over a step of `dt_s`, that turn the attitude (roll, pitch, yaw, rad) of its begin into that of its
/// end.
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

/// Tries every choice of angles in degrees with rates in rad/s and in deg/s: the share of the rates' squares that the
/// turning of the attitude leaves unexplained, both over steps of 0.2 s, for a measured attitude jitters from row to
/// row. Degrees are found only where radians explain next to nothing (0.8 is left or more) and degrees more than half:
/// a flight that hardly turns, noise and gaps in time decide nothing.
inline detail::DegreesFound find_degrees_by_motion(const Flight& flight) {
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
  detail::DegreesFound found;
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

namespace detail {

inline constexpr double acceleration_step_s = 0.04;
inline constexpr std::size_t fewest_acceleration_steps = 20;

/// Sums over the steps of a flight: changes of three columns against the integrals of three accelerations.
struct AccelerationSums {
  Matrix<double, 3, 3> products = Matrix<double, 3, 3>::Zero();  ///< row: axis that changes; column: acceleration
  Vector3<double> changes = Vector3<double>::Zero();             ///< squares
  Vector3<double> integrals = Vector3<double>::Zero();
  double steps = 0;

  void add(const Vector3<double>& change, const Vector3<double>& integral) {
    products += change * integral.transpose();
    changes += change.cwiseAbs2();
    integrals += integral.cwiseAbs2();
    steps += 1;
  }
  /// 0 where one of the two stands still.
  double correlation(Eigen::Index axis, Eigen::Index column) const {
    constexpr double smallest_change = 1e-3;  // rad/s, m/s: root mean square over a step
    const double still = smallest_change * smallest_change * steps;
    if (!(changes[axis] > still) || !(integrals[column] > still)) return 0;
    return products(axis, column) / std::sqrt(changes[axis] * integrals[column]);
  }
};

/// The integral of `acceleration(sample)` over the rows first to last, by the trapezium rule.
template <class Acceleration>
Vector3<double> integral(const Flight& flight, std::size_t first, std::size_t last, const Acceleration& acceleration) {
  Vector3<double> sum = Vector3<double>::Zero();
  for (std::size_t row = first; row < last; ++row) {
    const double half_s = (flight[row + 1].time_s - flight[row].time_s) / 2;
    sum += (acceleration(flight[row]) + acceleration(flight[row + 1])) * half_s;
  }
  return sum;
}

/// The first of three columns that follows another axis, or its own against the sign, or in another unit.
inline std::optional<Implausible> wrong_axis(const AccelerationSums& sums, std::size_t first_field,
                                             std::size_t first_integrated_field) {
  constexpr double follows = 0.35, better = 0.25;      // correlations
  constexpr double straight = 0.9, most_factor = 4.0;  // of a column that is its axis's but for a factor
  const auto axis_name = [&](Eigen::Index axis) {
    return std::string(sample_field_names[first_integrated_field + static_cast<std::size_t>(axis)]);
  };
  for (Eigen::Index column = 0; column < 3; ++column) {
    const double own = sums.correlation(column, column);
    Eigen::Index best = column;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (std::abs(sums.correlation(axis, column)) > std::abs(sums.correlation(best, column))) best = axis;
    }
    const double fits = sums.correlation(best, column);
    const std::size_t field = first_field + static_cast<std::size_t>(column);
    const std::string expected = "the derivative of " + axis_name(column);
    if (std::abs(fits) > follows && std::abs(fits) > own + better) {
      return Implausible{0, field, expected, "that of " + axis_name(best) + (fits < 0 ? " negated" : "")};
    }
    const double factor = own > straight ? sums.integrals[column] / sums.products(column, column) : 1;
    if (factor > most_factor || factor < 1 / most_factor) {
      return Implausible{0, field, expected,
                         "about " + number_text(std::round(factor * 100) / 100) + " times that (its unit?)"};
    }
  }
  return std::nullopt;
}

/// Accelerations that logs hold in the place of the derivative of the body-frame velocity, turned into that.
inline constexpr std::size_t acceleration_kinds = 4;
inline constexpr std::array<const char*, acceleration_kinds> acceleration_kind_texts = {
    "", "the world's acceleration in the body's axes (subtract w x v)",
    "what an accelerometer reads (add gravity in the body's axes, subtract w x v)",
    "the world's acceleration in axes north, east, down (turn it into the body, subtract w x v)"};
inline std::array<Vector3<double>, acceleration_kinds> as_body_derivative(const Sample& sample) {
  const Vector3<double> given = sample.linear_acceleration_m_s2;
  const Vector3<double> turning = cross(sample.body_rates_rad_s, sample.velocity_m_s);
  const Quaternion<double> q = from_euler(EulerAngles<double>{sample.roll_rad, sample.pitch_rad, sample.yaw_rad});
  const Vector3<double> gravity = world_to_body(q, Vector3<double>(0, 0, standard_gravity_m_s2<double>));
  return {given, given - turning, given + gravity - turning, world_to_body(q, given) - turning};
}

}  // namespace detail

/// Correlates, over steps of 0.04 s or of a row, the change of each body rate and velocity with the integral of each
/// acceleration. A mistake where a column follows another axis, or its own negated, by 0.25 better than its own; where
/// it follows its own in another unit; where vdot leaves 0.3 or more of the change of v unexplained, and another
/// meaning of it less than a quarter of that.
/// Measured, correlation of a column with its own axis, and most with another: the paper's flights above 0.88 and 0.17,
/// the independent simulator's above 0.97 and 0.12, real logs above 0.73 and 0.45 (or 1.00 and 0.8); under gyro noise
/// that drowns the motion 0 and 0.03.
/// Limits: a column that noise drowns, an axis that hardly moves and a flight of few rows decide nothing.
inline std::optional<detail::Implausible> find_acceleration_mistake(const Flight& flight) {
  constexpr std::size_t linear_field = 1, angular_field = 4, velocity_field = 7, rates_field = 10;
  constexpr double unexplained = 0.3, better = 0.25;
  detail::AccelerationSums angular, linear;
  std::array<double, detail::acceleration_kinds> left{};
  detail::for_each_step(flight, detail::acceleration_step_s, [&](std::size_t first, std::size_t last) {
    const Vector3<double> rates = flight[last].body_rates_rad_s - flight[first].body_rates_rad_s;
    const Vector3<double> velocity = flight[last].velocity_m_s - flight[first].velocity_m_s;
    angular.add(rates, detail::integral(flight, first, last, [](const Sample& sample) -> const Vector3<double>& {
                  return sample.angular_acceleration_rad_s2;
                }));
    for (std::size_t kind = 0; kind < left.size(); ++kind) {
      const Vector3<double> change = detail::integral(
          flight, first, last, [kind](const Sample& sample) { return detail::as_body_derivative(sample)[kind]; });
      if (kind == 0) linear.add(velocity, change);
      left[kind] += (velocity - change).squaredNorm();
    }
  });
  if (angular.steps < static_cast<double>(detail::fewest_acceleration_steps)) return std::nullopt;
  std::size_t best = 0;
  for (std::size_t kind = 1; kind < left.size(); ++kind) {
    if (left[kind] < left[best]) best = kind;
  }
  if (auto mistake = detail::wrong_axis(angular, angular_field, rates_field)) return mistake;
  if (left[0] > unexplained * linear.changes.sum() && left[best] < better * left[0]) {
    return detail::Implausible{0, linear_field, "the derivative of the velocity in the body's axes",
                               detail::acceleration_kind_texts[best]};
  }
  return detail::wrong_axis(linear, linear_field, velocity_field);
}

}  // namespace pinnquad
