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
      double left = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Turning turning = turning_of(s, axis);
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
    const BlockSolution found = linearized(s, wanted, response, parts, effectiveness, weights).solve(false);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      effectiveness[axis] = found.values()[axis * of_axis];
      weights[axis] = 1 / deviation(turning_of(s, axis), axis, found, axis * of_axis);
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
  return linearized(s, wanted, response, parts, effectiveness, weights).solve();
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

PINNQUAD_BODY BlockRegression RotationFit::linearized(const Fractions& s, const Wanted& wanted,
                                                      const RotorResponse& response, const std::vector<Part>& parts,
                                                      const std::array<double, 3>& effectiveness,
                                                      const std::array<double, 3>& weights) const {
  std::vector<Fractions> slopes;
  slopes.reserve(parts.size());
  for (const Part& part : parts) slopes.push_back(slope(response, part, wanted));
  BlockRegression regression(of_response + parts.size(), 3 * instruments, rows_.blocks());
  std::vector<double> x(of_response + parts.size()), z(3 * instruments);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Turning turning = turning_of(s, axis);
    std::vector<Series> about;
    for (const Fractions& slope_of_part : slopes) about.push_back(turning_of(slope_of_part, axis).about);
    std::fill(x.begin(), x.end(), 0.0);
    std::fill(z.begin(), z.end(), 0.0);
    for (std::size_t place = 0; place < rows_.instants().size(); ++place) {
      const std::size_t i = rows_.instants()[place];
      fill_axis(turning, axis, i, &x[axis * of_axis]);
      fill_instruments(turning, axis, i, &z[axis * instruments]);
      double y = rows_.flights().angular_acceleration()[axis][i];
      for (std::size_t k = 0; k < parts.size(); ++k) {
        x[of_response + k] = effectiveness[axis] * about[k][i];
        y += x[of_response + k] * response.*parts[k].front();
      }
      for (double& value : x) value *= weights[axis];
      for (double& value : z) value *= weights[axis];
      regression.add(rows_.block(place), x.data(), weights[axis] * y, z.data());
    }
  }
  return regression;
}

PINNQUAD_BODY RotationFit::Turning RotationFit::turning_of(const Fractions& s, std::size_t axis) const {
  const std::size_t count = s[0].size();
  Turning turning{Series(count), Series(count)};
  for (std::size_t i = 0; i < count; ++i) {
    turning.about[i] = rows_.signed_sum(s, axis, i);
    turning.sum[i] = InstrumentedFlights::sum(s, i);
  }
  return turning;
}

PINNQUAD_BODY void RotationFit::fill_axis(const Turning& turning, std::size_t axis, std::size_t i, double* x) const {
  x[0] = turning.about[i];
  x[1] = turning.sum[i];
  x[2] = -rows_.flights().rates()[axis][i];
  x[3] = rows_.flights().rate_products()[axis][i];
  x[4] = rows_.flights().velocity()[across[axis]][i];
}

PINNQUAD_BODY void RotationFit::fill_instruments(const Turning& turning, std::size_t axis, std::size_t i,
                                                 double* z) const {
  const SmoothedFlights& flights = rows_.flights();
  for (std::size_t k = 0; k < shifts; ++k) {
    const std::size_t before = rows_.before(i, k);
    *z++ = turning.about[before];
    *z++ = turning.sum[before];
    *z++ = flights.rates()[axis][before];
    *z++ = flights.rate_products()[axis][before];
    *z++ = flights.angular_acceleration()[axis][before];
    *z++ = flights.velocity()[across[axis]][before];
  }
  *z = 1;
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
    row[Products::RowsAtCompileTime - 1] = rows_.flights().angular_acceleration()[axis][i];
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
    row[unknowns] = rows_.flights().angular_acceleration()[axis][i];
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
    double left = rows_.flights().angular_acceleration()[axis][i];
    for (std::size_t k = 0; k < of_axis; ++k) left -= x[k] * solution.values()[first + k];
    squares += left * left;
  }
  return root_mean_square(squares);
}

}  // namespace pinnquad::detail
