// SPDX-License-Identifier: MIT
// Does a model command more torque where more angular acceleration is asked for? The derivative of the signed command
// sum about each axis by the angular acceleration about it, row by row: above 0 for any vehicle that turns the way it
// is told to.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/loss/context.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "training/model_predictions.hpp"

namespace programs {

using pinnquad::AxisSlopes;

/// Derivatives of all rows, per axis.
class DerivativeSigns {
 public:
  void add(const AxisSlopes& derivatives) {
    for (std::size_t axis = 0; axis < 3; ++axis) all_[axis].push_back(derivatives[axis]);
  }
  /// NaN where a derivative is not finite in a row, or there are no rows.
  DerivativeFigures figures() const {
    DerivativeFigures result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<double> values = all_[axis];
      if (values.empty() || !std::all_of(values.begin(), values.end(), [](double d) { return std::isfinite(d); })) {
        continue;
      }
      std::sort(values.begin(), values.end());
      const auto wrong = std::lower_bound(values.begin(), values.end(), 0.0) - values.begin();
      result.wrong_share[axis] = static_cast<double>(wrong) / static_cast<double>(values.size());
      result.least[axis] = values.front();
      result.median[axis] = values[values.size() / 2];
      if (values.front() < 0 || values.back() > 0) result.sees_acceleration = true;
    }
    return result;
  }

 private:
  std::array<std::vector<double>, 3> all_;
};

/// Over rows. `derivatives_of(sample)` gives a row's AxisSlopes.
template <class DerivativesOf>
DerivativeFigures derivative_figures(const pinnquad::RowSet& rows, const DerivativesOf& derivatives_of) {
  DerivativeSigns signs;
  for (std::size_t row = 0; row < rows.size(); ++row) signs.add(derivatives_of(rows[row]));
  return signs.figures();
}

/// Of a formula, by a central difference: exact where a rotor's thrust is proportional to its command.
/// `predict(sample)`: its commands.
template <class Predict>
class FormulaDerivatives {
 public:
  FormulaDerivatives(const pinnquad::GivenAirframe& airframe, Predict predict)
      : predict_(std::move(predict)),
        signs_{airframe.signs<pinnquad::Roll>(), airframe.signs<pinnquad::Pitch>(), airframe.signs<pinnquad::Yaw>()} {}

  AxisSlopes operator()(const pinnquad::Sample& sample) const {
    constexpr double step_rad_s2 = 1e-3;
    AxisSlopes result{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto sum_at = [&](double step) {
        pinnquad::Sample moved = sample;
        moved.angular_acceleration_rad_s2[static_cast<int>(axis)] += step;
        return pinnquad::signed_sum(signs_[axis], predict_(moved));
      };
      result[axis] = (sum_at(step_rad_s2) - sum_at(-step_rad_s2)) / (2 * step_rad_s2);
    }
    return result;
  }

 private:
  Predict predict_;
  std::array<std::array<double, pinnquad::rotor_count>, 3> signs_;
};

}  // namespace programs
