// SPDX-License-Identifier: MIT
// Does a model of any kind command more torque where more angular acceleration is wanted? Asked from outside, so that
// all kinds are asked alike: the angular acceleration of every row is moved, and with it that of a window's other taps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "pinnquad/data/row_set.hpp"
#include "pinnquad/evaluation/summary.hpp"
#include "training/derivatives.hpp"
#include "training/judgement.hpp"
#include "training/trained_network.hpp"

namespace programs {

/// Per axis, over the rows that a model answers: roll, pitch, yaw.
struct LogSlopes {
  /// Least d(signed command sum) / d(angular acceleration), 1 / (rad/s^2).
  std::array<double, 3> least = {pinnquad::not_a_number, pinnquad::not_a_number, pinnquad::not_a_number};
  std::array<double, 3> median = least;
  std::array<double, 3> wrong_share = least;  ///< of the rows: where it is below 0
  bool applicable = false;                    ///< false: the model does not look at the angular acceleration
};

namespace detail {

/// Copies of the flights of a row set with the angular acceleration about one axis moved.
class MovedRows {
 public:
  MovedRows(const pinnquad::RowSet& rows, int axis, double by_rad_s2) {
    flights_.reserve(rows.pieces().size());  // the row set points at them
    for (const pinnquad::FlightRows& piece : rows.pieces()) {
      flights_.push_back(*piece.flight);
      for (pinnquad::Sample& sample : flights_.back()) sample.angular_acceleration_rad_s2[axis] += by_rad_s2;
      rows_.add(flights_.back(), piece.rows);
    }
  }
  MovedRows(const MovedRows&) = delete;
  MovedRows& operator=(const MovedRows&) = delete;
  const pinnquad::RowSet& rows() const { return rows_; }

 private:
  std::vector<pinnquad::Flight> flights_;
  pinnquad::RowSet rows_;
};

inline double root_mean_square(const pinnquad::RowSet& rows, int axis) {
  double squares = 0;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const double v = rows[row].angular_acceleration_rad_s2[axis];
    squares += v * v;
  }
  return std::sqrt(squares / static_cast<double>(rows.size()));
}

}  // namespace detail

/// By a central difference over a tenth of the angular acceleration's root mean square. `signs`: of the command sums.
inline LogSlopes log_slopes(const TrainedNetwork& model, const pinnquad::RowSet& rows,
                            const std::array<std::array<double, pinnquad::rotor_count>, 3>& signs) {
  constexpr double share_of_spread = 0.1, still_rad_s2 = 1e-3;
  LogSlopes result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int i = static_cast<int>(axis);
    const double step = std::max(still_rad_s2, share_of_spread * detail::root_mean_square(rows, i));
    const Predictions above = model.predictions(detail::MovedRows(rows, i, step).rows());
    const Predictions below = model.predictions(detail::MovedRows(rows, i, -step).rows());
    std::vector<double> slopes;
    std::size_t wrong = 0;
    for (std::size_t row = 0; row < above.size(); ++row) {
      const double slope =
          (pinnquad::signed_sum(signs[axis], above[row]) - pinnquad::signed_sum(signs[axis], below[row])) / (2 * step);
      if (!std::isfinite(slope)) continue;
      slopes.push_back(slope);
      if (slope < 0) ++wrong;
    }
    if (slopes.empty()) continue;
    std::sort(slopes.begin(), slopes.end());
    result.least[axis] = slopes.front();
    result.median[axis] = slopes[slopes.size() / 2];
    result.wrong_share[axis] = static_cast<double>(wrong) / static_cast<double>(slopes.size());
    if (slopes.front() < 0 || slopes.back() > 0) result.applicable = true;
  }
  return result;
}

}  // namespace programs
