// SPDX-License-Identifier: MIT
// How a vehicle turns by its commands: effectiveness, damping, imbalance and gyroscopic term of each axis, and the
// response of the rotors that all three share, by Gauss and Newton. The law: identification.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/core/types.hpp"
#include "pinnquad/regression/block_regression.hpp"
#include "pinnquad/regression/smoothed_flights.hpp"

namespace pinnquad::detail {

/// Instants of flights that have instruments, in blocks of time. Instruments of an instant are of a window earlier and
/// more, `shifts` instants of them.
class InstrumentedFlights {
 public:
  using Series = SmoothedFlights::Series;
  using Fractions = std::array<Series, rotor_count>;
  using Signs = std::array<std::array<double, rotor_count>, 3>;
  static constexpr std::size_t shifts = 4;

  InstrumentedFlights(const RowSet& rows, const Signs& signs, double window_s)
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

  const SmoothedFlights& flights() const noexcept { return flights_; }
  const std::vector<std::size_t>& instants() const noexcept { return instants_; }
  std::size_t blocks() const noexcept { return blocks_; }
  double duration_s() const noexcept { return static_cast<double>(instants_.size()) * flights_.step_s(); }
  /// The block of `instants()[place]`.
  std::size_t block(std::size_t place) const { return place * blocks_ / instants_.size(); }
  /// The instant of an instrument.
  std::size_t before(std::size_t instant, std::size_t shift) const { return instant - first_shift_ - shift; }

  /// Sum over all rotors, and signed about an axis.
  static double sum(const Fractions& s, std::size_t i) { return s[0][i] + s[1][i] + s[2][i] + s[3][i]; }
  double signed_sum(const Fractions& s, std::size_t axis, std::size_t i) const {
    double total = 0;
    for (std::size_t k = 0; k < rotor_count; ++k) total += signs_[axis][k] * s[k][i];
    return total;
  }

 private:
  SmoothedFlights flights_;
  Signs signs_;
  std::size_t first_shift_ = 0, blocks_ = 0;
  std::vector<std::size_t> instants_;
};

/// Unknowns: B, C, D, G, F of roll, of pitch, of yaw; then the free parts of the rotors' response.
class RotationFit {
 public:
  using Series = InstrumentedFlights::Series;
  using Fractions = InstrumentedFlights::Fractions;
  static constexpr std::size_t of_axis = 5;
  static constexpr std::size_t of_response = 3 * of_axis;  ///< the first unknown of the response

  /// Numbers of the response that move together; each part is an unknown.
  using Part = std::vector<double RotorResponse::*>;
  static std::vector<Part> lag() { return {{&RotorResponse::rise_s, &RotorResponse::fall_s}}; }
  static std::vector<Part> lag_and_delay() {
    return {{&RotorResponse::rise_s, &RotorResponse::fall_s}, {&RotorResponse::delay_s}};
  }
  static std::vector<Part> rise_fall_and_delay() {
    return {{&RotorResponse::rise_s}, {&RotorResponse::fall_s}, {&RotorResponse::delay_s}};
  }

  static constexpr double shortest_s = 5e-4, longest_s = 0.4, longest_delay_s = 0.3;  ///< a response is within

  RotationFit(const InstrumentedFlights& rows, double curve) : rows_(rows), curve_(curve) {
    const SmoothedFlights& flights = rows.flights();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      motion_[axis].reserve(flights.size());
      for (std::size_t i = 0; i < flights.size(); ++i) {
        motion_[axis].push_back({flights.rates()[axis][i], flights.rate_products()[axis][i],
                                 flights.velocity()[across[axis]][i], flights.angular_acceleration()[axis][i]});
      }
    }
  }

  /// The response of a grid under which least squares leave least of roll, pitch and yaw: where to begin. The noise
  /// that comes back through the controller is in it.
  RotorResponse nearest() const {
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

  /// Gauss and Newton from `response`, which becomes the solution's. No parts: the response stays.
  BlockSolution converge(RotorResponse& response, const std::vector<Part>& parts) const {
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

 private:
  static constexpr std::size_t shifts = InstrumentedFlights::shifts;
  static constexpr std::size_t instruments = 6 * shifts + 1;       // of an axis
  static constexpr std::array<std::size_t, 3> across = {1, 0, 1};  // the velocity that turns the vehicle about an axis

  static double within_bounds(double value_s, const Part& part) {
    if (part.front() == &RotorResponse::delay_s) return std::clamp(value_s, -longest_delay_s, longest_delay_s);
    return std::clamp(value_s, shortest_s, longest_s);
  }

  using Wanted = SmoothedFlights::Wanted;

  /// Slope of the fractions by a part of the response; `wanted`: under its delay.
  Fractions slope(const RotorResponse& at, const Part& part, const Wanted& wanted) const {
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

  /// Sums of the fractions at each instant: signed about each axis, and of all rotors.
  struct Turning {
    std::array<Series, 3> about;
    Series sum;
  };
  Turning turning_of(const Fractions& s) const {
    const std::size_t count = s[0].size();
    Turning turning{{Series(count), Series(count), Series(count)}, Series(count)};
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) turning.about[axis][i] = rows_.signed_sum(s, axis, i);
      turning.sum[i] = InstrumentedFlights::sum(s, i);
    }
    return turning;
  }

  /// The three axes, linear about `response`, each row by its axis' weight; `turning`: under it.
  BlockRegression linearized(const Turning& turning, const Wanted& wanted, const RotorResponse& response,
                             const std::vector<Part>& parts, const std::array<double, 3>& effectiveness,
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

  void fill_axis(const Turning& turning, std::size_t axis, std::size_t i, double* x) const {
    const AxisMotion& motion = motion_[axis][i];
    x[0] = turning.about[axis][i];
    x[1] = turning.sum[i];
    x[2] = -motion.rate;
    x[3] = motion.rate_product;
    x[4] = motion.across;
  }

  /// Root mean square of what is left of an axis, rad/s^2, of this sum of squares.
  double root_mean_square(double squares) const {
    constexpr double least = 1e-6;  // exact rows of a law leave nothing
    return std::max(least, std::sqrt(std::max(0.0, squares) / static_cast<double>(rows_.instants().size())));
  }

  /// Sums of products of the unknowns of an axis, and of what they make.
  using Products = Eigen::Matrix<double, static_cast<int>(of_axis) + 1, static_cast<int>(of_axis) + 1>;
  Products products_of(const Turning& turning, std::size_t axis) const {
    Products sums = Products::Zero();
    Eigen::Matrix<double, Products::RowsAtCompileTime, 1> row;
    for (const std::size_t i : rows_.instants()) {
      fill_axis(turning, axis, i, row.data());
      row[Products::RowsAtCompileTime - 1] = motion_[axis][i].acceleration;
      sums.noalias() += row * row.transpose();
    }
    return sums;
  }

  /// The same of what least squares leave; `any`: products_of() an axis under any response.
  double left_by_least_squares(const Turning& turning, std::size_t axis, const Products& any) const {
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

  /// The same of what the unknowns of an axis, from the `first` on, leave.
  double deviation(const Turning& turning, std::size_t axis, const BlockSolution& solution, std::size_t first) const {
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

  const InstrumentedFlights& rows_;
  double curve_;
  /// Motion about an axis at an instant; no response is in it.
  struct AxisMotion {
    double rate, rate_product, across, acceleration;
  };
  std::array<std::vector<AxisMotion>, 3> motion_;
};

}  // namespace pinnquad::detail
