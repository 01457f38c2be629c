// SPDX-License-Identifier: MIT
// What least squares ask of rows, in sums that are added and taken away: each row is seen once, and one trajectory is left out
// of many by a subtraction. And what they give: an affine map.
#pragma once

#include <cstddef>
#include <vector>

#include "pinnquad/core/types.hpp"

namespace pinnquad {

using DynamicMatrix = Eigen::MatrixXd;

/// y = intercept + weights x.
struct AffineMap {
  int inputs = 0, outputs = 0;
  std::vector<double> weights;    ///< outputs x inputs, row-major
  std::vector<double> intercept;  ///< outputs

  std::vector<double> operator()(const double* x) const {
    std::vector<double> y = intercept;
    for (std::size_t k = 0; k < y.size(); ++k) {
      for (int i = 0; i < inputs; ++i) y[k] += weights[k * std::size_t(inputs) + std::size_t(i)] * x[i];
    }
    return y;
  }
};

/// Sums of 1, x, y and their products over rows: all that least squares ask of them.
class RegressionSums {
 public:
  RegressionSums(int inputs, int outputs)
      : inputs_(inputs),
        outputs_(outputs),
        products_(DynamicMatrix::Zero(1 + inputs + outputs, 1 + inputs + outputs)) {}

  void add(const double* x, const double* y) {
    Eigen::VectorXd row(products_.rows());
    row[0] = 1;
    for (int i = 0; i < inputs_; ++i) row[1 + i] = x[i];
    for (int k = 0; k < outputs_; ++k) row[1 + inputs_ + k] = y[k];
    products_.selfadjointView<Eigen::Lower>().rankUpdate(row);
  }
  RegressionSums& operator+=(const RegressionSums& other) {
    products_ += other.products_;
    return *this;
  }
  RegressionSums& operator-=(const RegressionSums& other) {
    products_ -= other.products_;
    return *this;
  }

  /// The same rows with one of the outputs.
  RegressionSums of_output(int output) const {
    RegressionSums one(inputs_, 1);
    const int from = 1 + inputs_ + output, to = 1 + inputs_;
    one.products_.topLeftCorner(to, to) = products_.topLeftCorner(to, to);
    one.products_.row(to).head(to) = products_.row(from).head(to);
    one.products_(to, to) = products_(from, from);
    return one;
  }

  int inputs() const noexcept { return inputs_; }
  int outputs() const noexcept { return outputs_; }
  double rows() const { return products_(0, 0); }

  /// Means of x and of y, in this order.
  Eigen::VectorXd means() const { return products_.col(0).tail(inputs_ + outputs_) / rows(); }
  /// Covariances of x and y, divisor n.
  DynamicMatrix covariances() const {
    const Eigen::VectorXd mean = means();
    DynamicMatrix all = products_.bottomRightCorner(inputs_ + outputs_, inputs_ + outputs_) / rows();
    all.triangularView<Eigen::StrictlyUpper>() = all.transpose();
    return all - mean * mean.transpose();
  }

 private:
  int inputs_, outputs_;
  DynamicMatrix products_;  ///< lower triangle
};

}  // namespace pinnquad
