// SPDX-License-Identifier: MIT
// Linear regression of rows that follow each other in time, y = x' theta + e, by least squares or by instruments, with
// intervals that hold where the errors of neighbouring rows are alike.
//   theta = (sum w x')^-1 sum w y;  w = x, or with instruments z (two-stage least squares)
//   w = (sum x z') (sum z z')^-1 z
// The rows stand in blocks of consecutive time. An interval is Student's t of blocks - 1 degrees of freedom times the
// deviation that leaving out one block at a time gives (the delete-one-block jackknife, Kuensch, The jackknife and the
// bootstrap for general stationary observations, 1989; t quantiles: Bester, Conley and Hansen, Inference with dependent
// data using cluster covariance estimators, 2011). Errors may be correlated in any way within a block, and of another
// size in each; those of two blocks should not be: a block is to be long against the time in which errors die out.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/regression/ridge.hpp"

namespace pinnquad {

/// A number found in data, and how far from it the truth may be.
struct Estimate {
  double value = 0;
  double half_width = std::numeric_limits<double>::infinity();  ///< of the 95 % interval
  double low() const noexcept { return value - half_width; }
  double high() const noexcept { return value + half_width; }
  bool holds(double truth) const noexcept { return std::abs(truth - value) <= half_width; }
  Estimate operator*(double factor) const noexcept { return {factor * value, std::abs(factor) * half_width}; }
};

/// The 97.5 % quantile of Student's t, by the expansion of Cornish and Fisher: to 0.1 % from 4 degrees of freedom on.
double student_t_975(double degrees_of_freedom) noexcept;

/// The unknowns of a regression, and what they are without each block in turn.
class BlockSolution {
 public:
  /// No unknown is told.
  explicit BlockSolution(std::size_t unknowns = 0) : values_(unknowns, 0.0), told_(unknowns, false) {}
  BlockSolution(std::vector<double> values, std::vector<bool> told, std::vector<std::vector<double>> left_out)
      : values_(std::move(values)), told_(std::move(told)), left_out_(std::move(left_out)) {}

  const std::vector<double>& values() const noexcept { return values_; }
  std::size_t blocks() const noexcept { return left_out_.size(); }
  /// False for an unknown that the rows do not tell from those before it, or not at all: it is 0.
  bool told(std::size_t unknown) const { return told_.at(unknown); }

  /// An infinite interval where it is not told, and with fewer than three blocks.
  Estimate estimate(std::size_t unknown) const;
  /// Estimate of a function of all unknowns.
  template <class Function>
  Estimate estimate_of(const Function& function) const {
    Estimate result;
    result.value = function(values_);
    const auto count = static_cast<double>(left_out_.size());
    if (count < 3) return result;
    double variance = 0;
    for (const std::vector<double>& others : left_out_) {
      const double apart = function(others) - result.value;
      variance += (count - 1) / count * apart * apart;
    }
    const double half_width = student_t_975(count - 1) * std::sqrt(variance);
    if (std::isfinite(half_width)) result.half_width = half_width;
    return result;
  }

 private:
  std::vector<double> values_;
  std::vector<bool> told_;
  std::vector<std::vector<double>> left_out_;
};

/// Sums over rows, block by block.
class BlockRegression {
 public:
  /// `instruments`: how many each row has, at least as many as unknowns; 0 for least squares.
  BlockRegression(std::size_t unknowns, std::size_t instruments, std::size_t blocks);

  /// A row: y, `unknowns` regressors and, unless it is least squares, as many instruments as there are. Zeros in front
  /// and behind cost nothing: rows of several equations with unknowns of their own are one regression.
  void add(std::size_t block, const double* regressors, double y, const double* instruments = nullptr);

  /// Without intervals, and so without blocks, where they are not wanted: the blocks are most of the work.
  BlockSolution solve(bool with_intervals = true);

 private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  /// Rows of matrices that are summed up: beyond their columns so many more, which are not read.
  static constexpr Eigen::Index step = 8;
  struct Sums {
    RowMajor zx;  ///< z x', and z y
    RowMajor zz;  ///< lower triangle
    std::size_t rows = 0;
  };
  struct Range {
    Eigen::Index first, end;
  };
  static Range without_zeros(const double* values, Eigen::Index count) noexcept;

  /// Adds the rows that wait to the sums of their block: together, and each sum in their order.
  void take_waiting();
  /// a theta = b, symmetric; `scale` brings the diagonal of a to 1, or 0 where it is 0.
  struct Normal {
    Eigen::MatrixXd a;
    Eigen::VectorXd b, scale;
  };

  static Eigen::VectorXd inverse_roots(const Eigen::VectorXd& diagonal);

  /// Without the unknowns that are not `told`; empty takes all.
  Normal normal_of(const Sums& sums, const std::vector<bool>& told) const;

  std::vector<double> solved(const Normal& normal) const;

  /// True for an unknown that has a part of its own: elimination in their order.
  std::vector<bool> told_apart(const Normal& normal) const;

  Eigen::Index unknowns_, instruments_;
  bool by_instruments_;
  std::vector<Sums> blocks_;
  // rows of one block that wait, x with y behind it, and where they are not zero
  RowMajor x_, z_;
  Eigen::Index waiting_ = 0;
  std::size_t block_ = 0;
  Range of_x_{0, 0}, of_z_{0, 0};
};

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/regression/impl/block_regression.hpp"
#endif
