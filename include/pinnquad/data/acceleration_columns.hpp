// SPDX-License-Identifier: MIT
// Are the accelerations of a flight the derivatives of its body rates and of its velocity? Asked of the motion: from row
// to row w and v change by the integral of wdot and vdot. A column that is negated, or that of another axis, integrates
// to something else.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "pinnquad/core/rotation.hpp"
#include "pinnquad/data/degrees.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/io/decimal.hpp"

namespace pinnquad {

/// A column of accelerations that is not what its name says.
struct AccelerationMistake {
  std::size_t field = 0;  ///< index in `sample_field_names`
  std::string expected;   ///< "the derivative of w_x"
  std::string found;      ///< "that of w_y negated"
};

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
inline std::optional<AccelerationMistake> wrong_axis(const AccelerationSums& sums, std::size_t first_field,
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
      return AccelerationMistake{field, expected, "that of " + axis_name(best) + (fits < 0 ? " negated" : "")};
    }
    const double factor = own > straight ? sums.integrals[column] / sums.products(column, column) : 1;
    if (factor > most_factor || factor < 1 / most_factor) {
      return AccelerationMistake{field, expected,
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
/// it follows its own in another unit; where vdot leaves 0.3 or more of the change of v unexplained, and another meaning
/// of it less than a quarter of that.
/// Measured, correlation of a column with its own axis, and most with another: the paper's flights above 0.88 and 0.17,
/// the independent simulator's above 0.97 and 0.12, real logs above 0.73 and 0.45 (or 1.00 and 0.8); under gyro noise
/// that drowns the motion 0 and 0.03.
/// Limits: a column that noise drowns, an axis that hardly moves and a flight of few rows decide nothing.
inline std::optional<AccelerationMistake> find_acceleration_mistake(const Flight& flight) {
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
    return AccelerationMistake{linear_field, "the derivative of the velocity in the body's axes",
                               detail::acceleration_kind_texts[best]};
  }
  return detail::wrong_axis(linear, linear_field, velocity_field);
}

}  // namespace pinnquad
