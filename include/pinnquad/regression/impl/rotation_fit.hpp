// SPDX-License-Identifier: MIT
// Bodies of rotation_fit.hpp.
#pragma once

#include "pinnquad/regression/rotation_fit.hpp"

namespace pinnquad::detail {

PINNQUAD_BODY InstrumentedFlights::InstrumentedFlights(const RowSet& rows, const Signs& signs, double window_s)
    : flights_(rows, window_s), signs_(signs) {
  constexpr double block_s = 3;  // long against rotors, controllers and gusts
  constexpr double fewest_blocks = 3, most_blocks = 50;
  if (flights_.size() == 0) return;
  const double step_s = flights_.step_s();
  first_shift_ = static_cast<std::size_t>(std::ceil(flights_.window_s() / step_s)) + 1;
  const std::size_t reach = first_shift_ + shifts - 1;
  for (std::size_t i = reach; i < flights_.size(); ++i) {
    if (flights_.stretch(i - reach) == flights_.stretch(i)) instants_.push_back(i);
  }
  blocks_ = static_cast<std::size_t>(std::clamp(duration_s() / block_s, fewest_blocks, most_blocks));
}

PINNQUAD_BODY double InstrumentedFlights::signed_sum(const Fractions& s, std::size_t axis, std::size_t i) const {
  double total = 0;
  for (std::size_t k = 0; k < rotor_count; ++k) total += signs_[axis][k] * s[k][i];
  return total;
}

PINNQUAD_BODY std::vector<RotationFit::Part> RotationFit::lag_and_delay() {
  return {{&RotorResponse::rise_s, &RotorResponse::fall_s}, {&RotorResponse::delay_s}};
}

PINNQUAD_BODY std::vector<RotationFit::Part> RotationFit::rise_fall_and_delay() {
  return {{&RotorResponse::rise_s}, {&RotorResponse::fall_s}, {&RotorResponse::delay_s}};
}

PINNQUAD_BODY RotationFit::RotationFit(const InstrumentedFlights& rows, double curve) : rows_(rows), curve_(curve) {
  const SmoothedFlights& flights = rows.flights();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    motion_[axis].reserve(flights.size());
    for (std::size_t i = 0; i < flights.size(); ++i) {
      motion_[axis].push_back({flights.rates()[axis][i], flights.rate_products()[axis][i],
                               flights.velocity()[across[axis]][i], flights.angular_acceleration()[axis][i]});
    }
  }
}

PINNQUAD_BODY RotorResponse RotationFit::nearest() const {
  constexpr std::array<double, 4> lags_s = {0.005, 0.03, 0.06, 0.1};
  constexpr double first_delay_s = -0.1, step_s = 0.02;
  constexpr int delays = 16;
  RotorResponse best{lags_s[1], lags_s[1], 0};
  double least = std::numeric_limits<double>::infinity();
  std::array<Products, 3> any;
  for (int k = 0; k < delays; ++k) {
    const double delay_s = first_delay_s + step_s * k;
    const Wanted wanted = rows_.flights().wanted(curve_, delay_s);
    for (const double lag_s : lags_s) {
      const RotorResponse at{lag_s, lag_s, delay_s};
      const Fractions s = rows_.flights().followed(wanted, at);
      const Turning turning = turning_of(s);
      double left = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (k == 0 && lag_s <= lags_s.front()) any[axis] = products_of(turning, axis);
        left += std::log(left_by_least_squares(turning, axis, any[axis]));
      }
      if (!(left < least)) continue;
      least = left;
      best = at;
    }
  }
  return best;
}

PINNQUAD_BODY BlockSolution RotationFit::converge(RotorResponse& response, const std::vector<Part>& parts) const {
  constexpr int most_steps = 30, least_steps = 4;
  constexpr double close_s = 1e-6;
  std::array<double, 3> effectiveness{}, weights = {1, 1, 1};
  for (int step = 0; step < most_steps; ++step) {
    const Wanted wanted = rows_.flights().wanted(curve_, response.delay_s);
    const Fractions s = rows_.flights().followed(wanted, response);
    const Turning turning = turning_of(s);
    const BlockSolution found = linearized(turning, wanted, response, parts, effectiveness, weights).solve(false);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      effectiveness[axis] = found.values()[axis * of_axis];
      weights[axis] = 1 / deviation(turning, axis, found, axis * of_axis);
    }
    if (step == 0) continue;  // without an effectiveness there was no slope
    double moved = 0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (!found.told(of_response + k)) continue;
      const double now = response.*parts[k].front(), reach = 0.5 * std::abs(now) + 0.005;
      const double next =
          within_bounds(std::clamp(found.values()[of_response + k], now - reach, now + reach), parts[k]);
      for (double RotorResponse::*const number : parts[k]) response.*number = next;
      moved = std::max(moved, std::abs(next - now));
    }
    if (step >= least_steps && moved < close_s) break;
  }
  const Wanted wanted = rows_.flights().wanted(curve_, response.delay_s);
  const Fractions s = rows_.flights().followed(wanted, response);
  return linearized(turning_of(s), wanted, response, parts, effectiveness, weights).solve();
}

PINNQUAD_BODY double RotationFit::within_bounds(double value_s, const Part& part) {
  if (part.front() == &RotorResponse::delay_s) return std::clamp(value_s, -longest_delay_s, longest_delay_s);
  return std::clamp(value_s, shortest_s, longest_s);
}

PINNQUAD_BODY RotationFit::Fractions RotationFit::slope(const RotorResponse& at, const Part& part,
                                                        const Wanted& wanted) const {
  constexpr double delay_step_s = 0.001, lag_step = 0.02;
  const bool by_delay = part.front() == &RotorResponse::delay_s;
  const double step_s = by_delay ? delay_step_s : lag_step * at.*part.front();
  RotorResponse ahead = at, behind = at;
  for (double RotorResponse::*const number : part) {
    ahead.*number += step_s;
    behind.*number -= step_s;
  }
  const auto fractions = [&](const RotorResponse& response) {
    return by_delay ? rows_.flights().thrust_fractions(curve_, response) : rows_.flights().followed(wanted, response);
  };
  Fractions result = fractions(ahead);
  const Fractions less = fractions(behind);
  for (std::size_t k = 0; k < rotor_count; ++k) {
    for (std::size_t i = 0; i < result[k].size(); ++i) result[k][i] = (result[k][i] - less[k][i]) / (2 * step_s);
  }
  return result;
}

PINNQUAD_BODY BlockRegression RotationFit::linearized(const Turning& turning, const Wanted& wanted,
                                                      const RotorResponse& response, const std::vector<Part>& parts,
                                                      const std::array<double, 3>& effectiveness,
                                                      const std::array<double, 3>& weights) const {
  std::vector<Turning> slopes;
  for (const Part& part : parts) {
    const bool counts = effectiveness[0] != 0 || effectiveness[1] != 0 || effectiveness[2] != 0;
    if (counts) slopes.push_back(turning_of(slope(response, part, wanted)));
  }
  BlockRegression regression(of_response + parts.size(), 3 * instruments, rows_.blocks());
  std::vector<double> x(of_response + parts.size()), z(3 * instruments);
  std::vector<std::array<double, 6>> instrument(turning.sum.size());  // of each instant
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double weight = weights[axis];
    for (std::size_t i = 0; i < instrument.size(); ++i) {
      const AxisMotion& motion = motion_[axis][i];
      instrument[i] = {turning.about[axis][i] * weight, turning.sum[i] * weight,      motion.rate * weight,
                       motion.rate_product * weight,    motion.acceleration * weight, motion.across * weight};
    }
    std::fill(x.begin(), x.end(), 0.0);
    std::fill(z.begin(), z.end(), 0.0);
    double *const of_x = &x[axis * of_axis], *const of_z = &z[axis * instruments];
    of_z[instruments - 1] = weight;
    for (std::size_t place = 0; place < rows_.instants().size(); ++place) {
      const std::size_t i = rows_.instants()[place];
      for (std::size_t k = 0; k < shifts; ++k) {
        const auto& before = instrument[rows_.before(i, k)];
        std::copy(before.begin(), before.end(), of_z + k * before.size());
      }
      fill_axis(turning, axis, i, of_x);
      for (std::size_t k = 0; k < of_axis; ++k) of_x[k] *= weight;
      double y = motion_[axis][i].acceleration;
      for (std::size_t k = 0; k < slopes.size(); ++k) {
        const double of_part = effectiveness[axis] * slopes[k].about[axis][i];
        y += of_part * response.*parts[k].front();
        x[of_response + k] = of_part * weight;
      }
      regression.add(rows_.block(place), x.data(), weight * y, z.data());
    }
  }
  return regression;
}

PINNQUAD_BODY RotationFit::Turning RotationFit::turning_of(const Fractions& s) const {
  const std::size_t count = s[0].size();
  Turning turning{{Series(count), Series(count), Series(count)}, Series(count)};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) turning.about[axis][i] = rows_.signed_sum(s, axis, i);
    turning.sum[i] = InstrumentedFlights::sum(s, i);
  }
  return turning;
}

PINNQUAD_BODY void RotationFit::fill_axis(const Turning& turning, std::size_t axis, std::size_t i, double* x) const {
  const AxisMotion& motion = motion_[axis][i];
  x[0] = turning.about[axis][i];
  x[1] = turning.sum[i];
  x[2] = -motion.rate;
  x[3] = motion.rate_product;
  x[4] = motion.across;
}

PINNQUAD_BODY double RotationFit::root_mean_square(double squares) const {
  constexpr double least = 1e-6;  // exact rows of a law leave nothing
  return std::max(least, std::sqrt(std::max(0.0, squares) / static_cast<double>(rows_.instants().size())));
}

PINNQUAD_BODY RotationFit::Products RotationFit::products_of(const Turning& turning, std::size_t axis) const {
  Products sums = Products::Zero();
  Eigen::Matrix<double, Products::RowsAtCompileTime, 1> row;
  for (const std::size_t i : rows_.instants()) {
    fill_axis(turning, axis, i, row.data());
    row[Products::RowsAtCompileTime - 1] = motion_[axis][i].acceleration;
    sums.noalias() += row * row.transpose();
  }
  return sums;
}

PINNQUAD_BODY double RotationFit::left_by_least_squares(const Turning& turning, std::size_t axis,
                                                        const Products& any) const {
  constexpr int unknowns = static_cast<int>(of_axis);
  using Row = Eigen::Array<double, unknowns + 1, 1>;
  Row row, by_about = Row::Zero(), by_sum = Row::Zero();  // the response is in these two alone
  for (const std::size_t i : rows_.instants()) {
    fill_axis(turning, axis, i, row.data());
    row[unknowns] = motion_[axis][i].acceleration;
    by_about += row[0] * row;
    by_sum += row[1] * row;
  }
  Products sums = any;
  sums.col(0) = by_about.matrix();
  sums.col(1) = by_sum.matrix();
  sums.row(0) = by_about.matrix().transpose();
  sums.row(1) = by_sum.matrix().transpose();
  Eigen::VectorXd scale(unknowns);
  for (int k = 0; k < unknowns; ++k) scale[k] = sums(k, k) > 0 ? 1 / std::sqrt(sums(k, k)) : 0;
  const Eigen::MatrixXd a = scale.asDiagonal() * sums.topLeftCorner<unknowns, unknowns>() * scale.asDiagonal();
  const Eigen::VectorXd b = scale.asDiagonal() * sums.col(unknowns).head<unknowns>();
  return root_mean_square(sums(unknowns, unknowns) - b.dot(Eigen::VectorXd(solve_symmetric(a, b))));
}

PINNQUAD_BODY double RotationFit::deviation(const Turning& turning, std::size_t axis, const BlockSolution& solution,
                                            std::size_t first) const {
  double squares = 0;
  std::array<double, of_axis> x{};
  for (const std::size_t i : rows_.instants()) {
    fill_axis(turning, axis, i, x.data());
    double left = motion_[axis][i].acceleration;
    for (std::size_t k = 0; k < of_axis; ++k) left -= x[k] * solution.values()[first + k];
    squares += left * left;
  }
  return root_mean_square(squares);
}

}  // namespace pinnquad::detail
