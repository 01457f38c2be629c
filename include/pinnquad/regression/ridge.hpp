// SPDX-License-Identifier: MIT
// Ridge regression in closed form: y = b + W x that minimises mean |y_n - b - W x_n|^2 + penalty |W|^2, free or under
// bounds of its weights. The intercept is free of the penalty. Standardise the features (training/training_data.hpp):
// the penalty takes all alike. Fits take sums over rows: to leave a trajectory out is a subtraction, whatever its rows.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/core/types.hpp"

namespace pinnquad {

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
  RegressionSums(int inputs, int outputs);

  void add(const double* x, const double* y);
  RegressionSums& operator+=(const RegressionSums& other);
  RegressionSums& operator-=(const RegressionSums& other);

  /// The same rows with one of the outputs.
  RegressionSums of_output(int output) const { return of_column(1 + inputs_ + output); }
  /// The same rows with one of the inputs as the output.
  RegressionSums of_input(int input) const { return of_column(1 + input); }

  /// Sums of 1, x, y and their products, symmetric.
  Eigen::MatrixXd products() const;
  /// With these instead, of as many inputs and outputs; the lower triangle is read.
  RegressionSums with(const Eigen::MatrixXd& products) const;

  int inputs() const noexcept { return inputs_; }
  int outputs() const noexcept { return outputs_; }
  double rows() const;

  /// Means of x and of y, in this order.
  Eigen::VectorXd means() const;
  /// Covariances of x and y, divisor n.
  Eigen::MatrixXd covariances() const;

 private:
  RegressionSums of_column(int from) const;

  int inputs_, outputs_;
  Eigen::MatrixXd products_;  ///< lower triangle
};

namespace detail {

/// A B.
Eigen::MatrixXd matrix_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// A = V diag(values) V', V orthogonal: a column per eigenvalue, in no order.
struct EigenPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Eigenvalues and vectors of a symmetric matrix, by Jacobi's rotations: with Eigen's solver a unit that includes all
/// headers takes five seconds longer to compile, for a case that is rare. Blocks along the diagonal with nothing
/// between them, as equations without a common unknown make them, are turned one by one.
EigenPairs eigen_pairs(const Eigen::MatrixXd& a);

/// X of A X = B, of all that come closest to it the one of least norm: what A does not tell is 0. A: symmetric, no
/// eigenvalue below 0 but by rounding; its diagonal of one order of magnitude, or 0.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Lower triangular W with W A W' = 1: the inverse of Cholesky's factor. A: symmetric, its lower triangle is read.
/// Empty where A is not positive definite, by rounding too, or not finite.
std::optional<Eigen::MatrixXd> whitening_of(const Eigen::MatrixXd& a);

/// sum of factor x weight over `terms` >= least, or = least.
struct WeightBound {
  std::vector<std::pair<int, double>> terms;  ///< feature and factor
  double least = 0;
  bool pinned = false;
};

/// All rows of one group or more.
RegressionSums total(const std::vector<RegressionSums>& groups);

}  // namespace detail

/// The map of these rows. `taken`: of `inputs` entries, false for a feature that gets no weight; empty takes all. A
/// feature that stands still, or that the others repeat, does no harm, without a penalty too. Throws
/// std::invalid_argument for no rows and for a penalty that is no number from 0.
AffineMap fit_ridge(const RegressionSums& sums, double penalty, const std::vector<bool>& taken = {});

/// Sum of (y - map(x))^2 over the rows and outputs of these sums.
double squared_error(const RegressionSums& sums, const AffineMap& map);

/// Penalties that are tried: half decades, of features and outputs with standard deviation 1.
std::vector<double> usual_penalties();

/// The penalty that predicts best what was left out: each group of rows (a trajectory with its repeats) by the fit to
/// all others; of equals the largest. Throws std::invalid_argument for fewer than two groups or no candidate.
double choose_penalty(const std::vector<RegressionSums>& groups,
                      const std::vector<double>& candidates = usual_penalties(), const std::vector<bool>& taken = {});

/// The map to the one output of `sums` under the bounds. `taken` as for fit_ridge(). Each choice of bounds that hold
/// with equality is solved; of those that keep all bounds the one of least cost is taken, which is the minimum: the
/// cost is convex. Throws std::invalid_argument for no rows, several outputs, a penalty that is no number from 0, more
/// than 8 bounds, a bound of a feature that is not taken, and where no choice keeps all.
AffineMap fit_bounded_ridge(const RegressionSums& sums, double penalty, const std::vector<bool>& taken,
                            const std::vector<detail::WeightBound>& bounds);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/regression/impl/ridge.hpp"
#endif
