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
inline double student_t_975(double degrees_of_freedom) noexcept {
  const double z = 1.959963984540054, z2 = z * z, n = degrees_of_freedom;
  return z * (1 + (z2 + 1) / (4 * n) + ((5 * z2 + 16) * z2 + 3) / (96 * n * n) +
              (((3 * z2 + 19) * z2 + 17) * z2 - 15) / (384 * n * n * n) +
              ((((79 * z2 + 776) * z2 + 1482) * z2 - 1920) * z2 - 945) / (92160 * n * n * n * n));
}

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
  Estimate estimate(std::size_t unknown) const {
    if (!told(unknown)) return {};
    return estimate_of([unknown](const std::vector<double>& values) { return values[unknown]; });
  }
  /// Of a function of the unknowns, all of which are told.
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
  BlockRegression(std::size_t unknowns, std::size_t instruments, std::size_t blocks)
      : unknowns_(static_cast<Eigen::Index>(unknowns)),
        instruments_(static_cast<Eigen::Index>(instruments > 0 ? instruments : unknowns)),
        by_instruments_(instruments > 0) {
    if (unknowns == 0 || blocks == 0 || (instruments > 0 && instruments < unknowns)) {
      throw std::invalid_argument("block regression: expected an unknown, a block, an instrument per unknown");
    }
    const Eigen::Index zz = by_instruments_ ? instruments_ : 0;
    blocks_.assign(blocks, {RowMajor::Zero(instruments_, unknowns_), Eigen::VectorXd::Zero(instruments_),
                            RowMajor::Zero(zz, zz), 0});
  }

  /// A row: y, `unknowns` regressors and, unless it is least squares, as many instruments as there are. Zeros in front
  /// and behind cost nothing: rows of several equations with unknowns of their own are one regression.
  void add(std::size_t block, const double* regressors, double y, const double* instruments = nullptr) {
    Sums& sums = blocks_.at(block);
    const double* const z = by_instruments_ ? instruments : regressors;
    const Range of_x = without_zeros(regressors, unknowns_), of_z = without_zeros(z, instruments_);
    const Eigen::Map<const Eigen::RowVectorXd> x(regressors + of_x.first, of_x.count), all_z(z, instruments_);
    for (Eigen::Index k = of_z.first; k < of_z.first + of_z.count; ++k) {
      sums.zx.row(k).segment(of_x.first, of_x.count) += z[k] * x;
      sums.zy[k] += z[k] * y;
      if (!by_instruments_) continue;
      const Eigen::Index count = k - of_z.first + 1;
      sums.zz.row(k).segment(of_z.first, count) += z[k] * all_z.segment(of_z.first, count);
    }
    ++sums.rows;
  }

  /// Without intervals, and so without blocks, where they are not wanted: the blocks are most of the work.
  BlockSolution solve(bool with_intervals = true) const {
    Sums all = blocks_.front();
    for (std::size_t i = 1; i < blocks_.size(); ++i) {
      all.zx += blocks_[i].zx;
      all.zy += blocks_[i].zy;
      all.zz += blocks_[i].zz;
    }
    const std::vector<bool> told = told_apart(normal_of(all, {}));
    std::vector<std::vector<double>> left_out;
    for (const Sums& block : blocks_) {
      if (block.rows == 0 || !with_intervals) continue;
      Sums others = all;
      others.zx -= block.zx;
      others.zy -= block.zy;
      others.zz -= block.zz;
      left_out.push_back(solved(normal_of(others, told)));
    }
    return {solved(normal_of(all, told)), told, std::move(left_out)};
  }

 private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  struct Sums {
    RowMajor zx;
    Eigen::VectorXd zy;
    RowMajor zz;  ///< lower triangle
    std::size_t rows = 0;
  };
  struct Range {
    Eigen::Index first, count;
  };
  static Range without_zeros(const double* values, Eigen::Index count) noexcept {
    Eigen::Index first = 0;
    while (first < count && values[first] == 0) ++first;
    while (count > first && values[count - 1] == 0) --count;
    return {first, count - first};
  }
  /// a theta = b, symmetric; `scale` brings the diagonal of a to 1, or 0 where it is 0.
  struct Normal {
    Eigen::MatrixXd a;
    Eigen::VectorXd b, scale;
  };

  static Eigen::VectorXd inverse_roots(const Eigen::VectorXd& diagonal) {
    Eigen::VectorXd scale(diagonal.size());
    for (Eigen::Index i = 0; i < diagonal.size(); ++i) scale[i] = diagonal[i] > 0 ? 1 / std::sqrt(diagonal[i]) : 0;
    return scale;
  }

  /// Without the unknowns that are not `told`; empty takes all.
  Normal normal_of(const Sums& sums, const std::vector<bool>& told) const {
    Normal normal;
    if (by_instruments_) {
      const Eigen::VectorXd roots = inverse_roots(sums.zz.diagonal());
      Eigen::MatrixXd zz = sums.zz;
      zz.triangularView<Eigen::StrictlyUpper>() = sums.zz.transpose();
      zz = (roots.asDiagonal() * zz * roots.asDiagonal()).eval();
      const Eigen::MatrixXd weights = roots.asDiagonal() * detail::solve_symmetric(zz, roots.asDiagonal() * sums.zx);
      normal.a = detail::matrix_product(weights.transpose(), sums.zx);
      normal.b = detail::matrix_product(weights.transpose(), sums.zy);
    } else {
      normal.a = sums.zx;
      normal.b = sums.zy;
    }
    for (std::size_t i = 0; i < told.size(); ++i) {
      if (told[i]) continue;
      normal.a.row(static_cast<Eigen::Index>(i)).setZero();
      normal.a.col(static_cast<Eigen::Index>(i)).setZero();
      normal.b[static_cast<Eigen::Index>(i)] = 0;
    }
    normal.scale = inverse_roots(normal.a.diagonal());
    normal.a = (normal.scale.asDiagonal() * normal.a * normal.scale.asDiagonal()).eval();
    normal.b = (normal.scale.asDiagonal() * normal.b).eval();
    for (std::size_t i = 0; i < told.size(); ++i) {
      if (!told[i]) normal.a(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) = 1;
    }
    return normal;
  }

  std::vector<double> solved(const Normal& normal) const {
    const Eigen::VectorXd theta = normal.scale.asDiagonal() * detail::solve_symmetric(normal.a, normal.b);
    return {theta.data(), theta.data() + theta.size()};
  }

  /// True for an unknown that has a part of its own: elimination in their order.
  std::vector<bool> told_apart(const Normal& normal) const {
    constexpr double least_own_part = 1e-9;  // of its square: rounding leaves less
    Eigen::MatrixXd a = normal.a;
    std::vector<bool> told(static_cast<std::size_t>(unknowns_), true);
    for (Eigen::Index k = 0; k < unknowns_; ++k) {
      if (!(a(k, k) > least_own_part)) {
        told[static_cast<std::size_t>(k)] = false;
        continue;
      }
      const Eigen::RowVectorXd row = a.row(k);
      const Eigen::VectorXd column = a.col(k) / a(k, k);
      for (Eigen::Index i = k + 1; i < unknowns_; ++i) a.row(i) -= column[i] * row;
    }
    return told;
  }

  Eigen::Index unknowns_, instruments_;
  bool by_instruments_;
  std::vector<Sums> blocks_;
};

}  // namespace pinnquad
