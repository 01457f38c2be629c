// SPDX-License-Identifier: MIT
#include "logs/motor_order_check.hpp"

#include <algorithm>

#include "logs/command_lag.hpp"
#include "logs/log_checks.hpp"
#include "logs/motor_order.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad::logs {
namespace {

/// Second moments of what is left of signed command sums and accelerations when constant and body rates are taken out.
struct OrderMoments {
  std::array<std::array<double, rotor_count>, rotor_count> commands{};
  std::array<std::array<double, rotor_count>, 3> with_motion{};
  std::array<double, 3> motion{};

  /// R^2 of acceleration `axis` by one sum with these weights, whose gain is positive; negative where it is not.
  double explained(std::size_t axis, const std::array<double, rotor_count>& weights) const noexcept {
    double along = 0, squares = 0;
    for (std::size_t i = 0; i < rotor_count; ++i) {
      along += weights[i] * with_motion[axis][i];
      for (std::size_t j = 0; j < rotor_count; ++j) squares += weights[i] * weights[j] * commands[i][j];
    }
    if (!(squares > 0) || !(motion[axis] > 0)) return 0;
    return (along < 0 ? -1 : 1) * along * along / (squares * motion[axis]);
  }
};

OrderMoments order_moments(const std::vector<LagSeries>& segments) {
  std::size_t rows = 0;
  LagMoments moments = lag_moments(segments, 0, 0, 0, 1, rows);
  const LagMoments whole = moments;
  for (const unsigned k : {0u, 5u, 6u, 7u}) take_out(moments, k, 1e-12 * whole[k][k]);
  OrderMoments result;
  for (std::size_t i = 0; i < rotor_count; ++i) {
    if (!(moments[1 + i][1 + i] > 1e-12 * whole[1 + i][1 + i])) continue;  // stands still: rounding is no motion
    for (std::size_t j = 0; j < rotor_count; ++j) result.commands[i][j] = moments[1 + i][1 + j];
    for (std::size_t axis = 0; axis < 3; ++axis) result.with_motion[axis][i] = moments[1 + i][8 + axis];
  }
  for (std::size_t axis = 0; axis < 3; ++axis) result.motion[axis] = std::max(0.0, moments[8 + axis][8 + axis]);
  return result;
}

}  // namespace

MotorOrderCheck check_motor_order(const std::vector<Flight>& lag_aligned, const Airframe<double>& airframe) {
  constexpr double least_explained = 0.05, stands = 0.75, alike = 0.8, yaw_explained = 0.1, corner_Hz = 8;
  using Order = std::array<std::size_t, rotor_count>;
  const Order identity = {0, 1, 2, 3};
  const AllocationMatrix<double> rows = allocation(airframe);
  const auto weights = [&](std::size_t axis, const Order& order) {
    std::array<double, rotor_count> result{};
    for (std::size_t i = 0; i < rotor_count; ++i) result[order[i]] = rows[1 + axis][i];
    return result;
  };
  MotorOrderCheck check;
  Order best = identity;
  OrderMoments moments;
  double most = -2, second = -2;
  const auto try_all = [&](const std::vector<LagSeries>& series) {
    const OrderMoments of_band = order_moments(series);
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
  const std::vector<LagSeries> series = lag_series(lag_aligned);
  try_all(series);
  for (const Flight& segment : lag_aligned) {
    if (segment.size() < 2) continue;
    try_all(low_passed(series, segment[1].time_s - segment[0].time_s, corner_Hz));
    break;
  }
  check.explained_permuted = most;
  check.ambiguous = !(most >= least_explained) || second > alike * most;
  const bool as_it_stands = best == identity;
  if (!check.ambiguous) check.yaw_reversed = moments.explained(2, weights(2, best)) < -yaw_explained;
  if (check.ambiguous || (as_it_stands && !check.yaw_reversed)) return check;
  if (as_it_stands) {
    check.finding =
        "roll and pitch follow the commands, yaw turns against them: the propellers turn the other way than the "
        "airframe says (spin), or two that turn alike are exchanged with the other two";
    return check;
  }
  if (check.explained > stands * most) return check;
  check.permutation = best;
  MotorOrder airframe_order;
  if (motor_order_of(airframe, airframe_order) == Status::ok) {
    for (const MotorOrder& known : motor_orders) {
      bool same = true;
      for (std::size_t i = 0; i < rotor_count; ++i) same = same && known.corners[best[i]] == airframe_order.corners[i];
      if (same) check.convention = known.name;
    }
  }
  std::string wanted;
  for (const std::size_t column : best) wanted += (wanted.empty() ? "u" : ", u") + std::to_string(column + 1);
  check.finding = "the commands explain " + percent(std::max(0.0, check.explained)) +
                  " of roll and pitch acceleration in the order they have, and " + percent(most) +
                  " if the airframe's motors 1 to 4 are the log's " + wanted +
                  (check.convention.empty() ? "" : " (the order of " + check.convention + ")") +
                  (check.yaw_reversed ? "; yaw then turns against them: propellers turn the other way" : "");
  return check;
}

}  // namespace pinnquad::logs
