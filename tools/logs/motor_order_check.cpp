// SPDX-License-Identifier: MIT
#include "logs/motor_order_check.hpp"

#include <algorithm>

#include "logs/command_lag.hpp"
#include "logs/log_checks.hpp"
#include "logs/motor_order.hpp"
#include "pinnquad/data/motion_pair.hpp"
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

/// Moments of a flight. A crash or a catch by hand weighs no more than the liveliest of the other blocks of time.
LagMoments weighted_moments(const std::vector<LagSeries>& segments, double period_s) {
  std::size_t rows = 0;
  for (const LagSeries& segment : segments) rows += segment.size();
  const std::size_t length = std::max<std::size_t>(1, rows / detail::block_count(static_cast<double>(rows) * period_s));
  std::vector<LagMoments> blocks;
  std::vector<double> energies;
  for (const LagSeries& segment : segments) {
    const std::vector<LagSeries> one = {segment};
    const std::size_t parts = std::max<std::size_t>(1, segment.size() / length);
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t first = part * segment.size() / parts, last = (part + 1) * segment.size() / parts;
      blocks.push_back(lag_moments(one, first, segment.size() - last, 0, 1, rows));
      energies.push_back((blocks.back()[8][8] + blocks.back()[9][9]) / static_cast<double>(rows));
    }
  }
  const std::vector<double> weights = detail::block_weights(energies);
  LagMoments sum{};
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    for (std::size_t i = 0; i < lag_columns; ++i) {
      for (std::size_t j = 0; j < lag_columns; ++j) sum[i][j] += weights[block] * blocks[block][i][j];
    }
  }
  return sum;
}

OrderMoments order_moments(LagMoments moments) {
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

/// The motors of a '+' frame: one each to the right, left, front and rear.
struct PlusFrame {
  std::array<std::size_t, rotor_count> motors{};  ///< right, left, front, rear
  double explained = -2;                          ///< R^2 of roll and pitch, mean
};

/// Roll by right and left alone, pitch by front and rear alone.
PlusFrame best_plus_frame(const OrderMoments& moments) {
  PlusFrame best;
  std::array<std::size_t, rotor_count> order = {0, 1, 2, 3};
  do {
    std::array<double, rotor_count> roll{}, pitch{};
    roll[order[0]] = -1, roll[order[1]] = 1;
    pitch[order[2]] = 1, pitch[order[3]] = -1;
    const double explained = (moments.explained(0, roll) + moments.explained(1, pitch)) / 2;
    if (explained > best.explained) best = {order, explained};
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

}  // namespace

MotorOrderCheck check_motor_order(const std::vector<Flight>& lag_aligned, const Airframe<double>& airframe) {
  constexpr double least_explained = 0.05, plus_explained = 0.3, stands = 0.75, alike = 0.8, yaw_explained = 0.1,
                   corner_Hz = 8;
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
  double most = -2, second = -2, yaw = 0;
  PlusFrame plus;
  const auto tilting = [&](const OrderMoments& moments, const Order& order) {
    return (moments.explained(0, weights(0, order)) + moments.explained(1, weights(1, order))) / 2;
  };
  check.ambiguous = true;
  const auto timed =
      std::find_if(lag_aligned.begin(), lag_aligned.end(), [](const Flight& segment) { return segment.size() > 1; });
  if (timed == lag_aligned.end()) return check;
  const double period_s = (*timed)[1].time_s - (*timed)[0].time_s;
  const std::vector<LagSeries> series = lag_series(lag_aligned);
  for (const auto& band : {series, low_passed(series, period_s, corner_Hz)}) {
    const OrderMoments moments = order_moments(weighted_moments(band, period_s));
    Order order = identity, first = identity;
    double highest = -2, next = -2;
    do {
      const double explained = tilting(moments, order);
      next = std::max(next, std::min(explained, highest));
      if (!(explained > highest)) continue;
      highest = explained;
      first = order;
    } while (std::next_permutation(order.begin(), order.end()));
    if (!(highest > most)) continue;
    most = highest;
    plus = best_plus_frame(moments);
    second = next;
    best = first;
    check.explained = tilting(moments, identity);
    yaw = moments.explained(2, weights(2, best));
    for (std::size_t axis = 0; axis < 3; ++axis)
      check.turns_against[axis] = moments.explained(axis, weights(axis, identity)) < 0;
  }
  check.explained_permuted = most;
  if (plus.explained > plus_explained && most < stands * plus.explained) {
    const auto u = [&plus](std::size_t at) { return "u" + std::to_string(plus.motors[at] + 1); };
    check.ambiguous = false;
    check.finding = "roll follows two commands alone and pitch the other two: a '+' frame, " + u(0) + " right, " +
                    u(1) + " left, " + u(2) + " front, " + u(3) + " rear, which explains " + percent(plus.explained) +
                    " of roll and pitch acceleration, an X at best " + percent(std::max(0.0, most));
    return check;
  }
  check.ambiguous = !(most >= least_explained) || second > alike * most;
  const bool as_it_stands = best == identity;
  if (!check.ambiguous) check.yaw_reversed = yaw < -yaw_explained;
  if (check.ambiguous || (as_it_stands && !check.yaw_reversed)) return check;
  if (as_it_stands) {
    check.finding =
        "roll and pitch follow the commands, yaw turns against them: the propellers turn the other way than the "
        "airframe says (spin), or two that turn alike are exchanged with the other two; for the former write its file, "
        "exchange the spins in it and give it with --airframe: pinnquad airframe convert racer_5_inch --out mine.toml";
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
