// SPDX-License-Identifier: MIT
// Are the commands in the order of the airframe's motors? Asked of the motion: each order is fitted to roll, pitch and
// yaw acceleration with the signs that the airframe's allocation gives it, and the one that explains them says which it
// is.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "logs/finding.hpp"
#include "logs/lagged_motion.hpp"
#include "logs/motor_order.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace programs {

struct MotorOrderCheck {
  std::optional<Finding> finding;  ///< none where the order as it stands fits, and where nothing can be said
  /// The airframe's motor i is the log's command `permutation[i]`; 0, 1, 2, 3 where nothing is proposed.
  std::array<std::size_t, pinnquad::rotor_count> permutation = {0, 1, 2, 3};
  std::string convention;         ///< that has the log's order: "betaflight"; empty for none known
  bool ambiguous = false;         ///< nothing is excited enough to tell, or two orders explain the motion alike
  bool yaw_reversed = false;      ///< roll and pitch fit, yaw has the wrong sign: propellers turn the other way
  double explained = 0;           ///< R^2 of roll and pitch acceleration, mean, as the commands stand
  double explained_permuted = 0;  ///< by the best order
};

namespace detail {

/// Second moments of what is left of signed command sums and accelerations when constant and body rates are taken out.
struct OrderMoments {
  std::array<std::array<double, pinnquad::rotor_count>, pinnquad::rotor_count> commands{};
  std::array<std::array<double, pinnquad::rotor_count>, 3> with_motion{};
  std::array<double, 3> motion{};

  /// R^2 of acceleration `axis` by one sum with these weights, whose gain is positive; negative where it is not.
  double explained(std::size_t axis, const std::array<double, pinnquad::rotor_count>& weights) const noexcept {
    double along = 0, squares = 0;
    for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
      along += weights[i] * with_motion[axis][i];
      for (std::size_t j = 0; j < pinnquad::rotor_count; ++j) squares += weights[i] * weights[j] * commands[i][j];
    }
    if (!(squares > 0) || !(motion[axis] > 0)) return 0;
    return (along < 0 ? -1 : 1) * along * along / (squares * motion[axis]);
  }
};

inline OrderMoments order_moments(const std::vector<LagSeries>& segments) {
  LagMoments moments{};
  for (const LagSeries& one : segments) {
    for (std::size_t row = 0; row < one.size(); ++row) {
      std::array<double, lag_columns> x{};
      std::size_t column = 0;
      x[column++] = 1;
      for (const auto& series : one.commands) x[column++] = series[row];
      for (const auto& series : one.rates) x[column++] = series[row];
      for (const auto& series : one.motions) x[column++] = series[row];
      for (std::size_t i = 0; i < lag_columns; ++i) {
        for (std::size_t j = 0; j < lag_columns; ++j) moments[i][j] += x[i] * x[j];
      }
    }
  }
  const LagMoments whole = moments;
  for (const std::size_t k : {std::size_t(0), std::size_t(5), std::size_t(6), std::size_t(7)}) {
    if (!(moments[k][k] > 1e-12 * whole[k][k])) continue;
    const auto row = moments[k];
    for (std::size_t i = 0; i < lag_columns; ++i) {
      const double factor = moments[i][k] / row[k];
      for (std::size_t j = 0; j < lag_columns; ++j) moments[i][j] -= factor * row[j];
    }
  }
  OrderMoments result;
  for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
    if (!(moments[1 + i][1 + i] > 1e-12 * whole[1 + i][1 + i])) continue;  // stands still: rounding is no motion
    for (std::size_t j = 0; j < pinnquad::rotor_count; ++j) result.commands[i][j] = moments[1 + i][1 + j];
    for (std::size_t axis = 0; axis < 3; ++axis) result.with_motion[axis][i] = moments[1 + i][8 + axis];
  }
  for (std::size_t axis = 0; axis < 3; ++axis) result.motion[axis] = std::max(0.0, moments[8 + axis][8 + axis]);
  return result;
}

}  // namespace detail

/// Of all 24 orders the one whose signed sums explain roll and pitch acceleration best, gains positive; yaw, which is
/// weak, only tells whether the propellers turn as the airframe says. As they are, or below 8 Hz: gyro noise that comes
/// back as commands hides the order in calm flights. A finding where that order is not the one that stands, which
/// explains less than three quarters of it (R^2, mean of both axes). Segments on one uniform clock, lag-aligned
/// (remove_lag()). Limits: body axes that are x forward, y left, z up look like motors exchanged front for rear, for
/// the commands cannot tell the two apart: check_rate_frame() can, and is to be asked first.
inline MotorOrderCheck check_motor_order(const std::vector<pinnquad::Flight>& lag_aligned,
                                         const pinnquad::Airframe<double>& airframe) {
  constexpr double least_explained = 0.05, stands = 0.75, alike = 0.8, yaw_explained = 0.1, corner_Hz = 8;
  using Order = std::array<std::size_t, pinnquad::rotor_count>;
  const Order identity = {0, 1, 2, 3};
  const pinnquad::AllocationMatrix<double> rows = allocation(airframe);
  const auto weights = [&](std::size_t axis, const Order& order) {
    std::array<double, pinnquad::rotor_count> result{};
    for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) result[order[i]] = rows[1 + axis][i];
    return result;
  };
  MotorOrderCheck check;
  Order best = identity;
  detail::OrderMoments moments;
  double most = -2, second = -2;
  const auto try_all = [&](const std::vector<detail::LagSeries>& series) {
    const detail::OrderMoments of_band = detail::order_moments(series);
    const auto tilting = [&](const Order& order) {
      return (of_band.explained(0, weights(0, order)) + of_band.explained(1, weights(1, order))) / 2;
    };
    Order order = identity, first = identity;
    double highest = -2, next = -2;
    do {
      const double explained = tilting(order);
      next = std::max(next, std::min(explained, highest));
      if (!(explained > highest)) continue;
      highest = explained;
      first = order;
    } while (std::next_permutation(order.begin(), order.end()));
    if (!(highest > most)) return;
    most = highest;
    second = next;
    best = first;
    moments = of_band;
    check.explained = tilting(identity);
  };
  const std::vector<detail::LagSeries> series = detail::lag_series(lag_aligned);
  try_all(series);
  for (const pinnquad::Flight& segment : lag_aligned) {
    if (segment.size() < 2) continue;
    try_all(detail::low_passed(series, segment[1].time_s - segment[0].time_s, corner_Hz));
    break;
  }
  check.explained_permuted = most;
  check.ambiguous = !(most >= least_explained) || second > alike * most;
  const bool as_it_stands = best == identity;
  if (!check.ambiguous) check.yaw_reversed = moments.explained(2, weights(2, best)) < -yaw_explained;
  if (check.ambiguous || (as_it_stands && !check.yaw_reversed)) return check;
  if (as_it_stands) {
    check.finding = Finding{
        "motor_order", moments.explained(2, weights(2, best)), "1",
        "roll and pitch follow the commands, yaw turns against them: the propellers turn the other way than the "
        "airframe says (spin), or two that turn alike are exchanged with the other two"};
    return check;
  }
  if (check.explained > stands * most) return check;
  check.permutation = best;
  MotorOrder airframe_order;
  if (motor_order_of(airframe, airframe_order) == pinnquad::Status::ok) {
    for (const MotorOrder& known : motor_orders) {
      bool same = true;
      for (std::size_t i = 0; i < pinnquad::rotor_count; ++i)
        same = same && known.corners[best[i]] == airframe_order.corners[i];
      if (same) check.convention = known.name;
    }
  }
  std::string wanted;
  for (const std::size_t column : best) wanted += (wanted.empty() ? "u" : ", u") + std::to_string(column + 1);
  check.finding =
      Finding{"motor_order", check.explained, "1",
              "the commands explain " + detail::percent(std::max(0.0, check.explained)) +
                  " of roll and pitch acceleration in the order they have, and " + detail::percent(most) +
                  " if the airframe's motors 1 to 4 are the log's " + wanted +
                  (check.convention.empty() ? "" : " (the order of " + check.convention + ")") +
                  (check.yaw_reversed ? "; yaw then turns against them: propellers turn the other way" : "")};
  return check;
}

}  // namespace programs
