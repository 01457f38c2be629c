// SPDX-License-Identifier: MIT
// Bodies of block_regression.hpp.
#pragma once

#include "pinnquad/regression/block_regression.hpp"

namespace pinnquad {

PINNQUAD_BODY double student_t_975(double degrees_of_freedom) noexcept {
  const double z = 1.959963984540054, z2 = z * z, n = degrees_of_freedom;
  return z * (1 + (z2 + 1) / (4 * n) + ((5 * z2 + 16) * z2 + 3) / (96 * n * n) +
              (((3 * z2 + 19) * z2 + 17) * z2 - 15) / (384 * n * n * n) +
              ((((79 * z2 + 776) * z2 + 1482) * z2 - 1920) * z2 - 945) / (92160 * n * n * n * n));
}

PINNQUAD_BODY Estimate BlockSolution::estimate(std::size_t unknown) const {
  if (!told(unknown)) return {};
  return estimate_of([unknown](const std::vector<double>& values) { return values[unknown]; });
}

PINNQUAD_BODY BlockRegression::BlockRegression(std::size_t unknowns, std::size_t instruments, std::size_t blocks)
    : unknowns_(static_cast<Eigen::Index>(unknowns)),
      instruments_(static_cast<Eigen::Index>(instruments > 0 ? instruments : unknowns)),
      by_instruments_(instruments > 0) {
  if (unknowns == 0 || blocks == 0 || (instruments > 0 && instruments < unknowns)) {
    throw std::invalid_argument("block regression: expected an unknown, a block, an instrument per unknown");
  }
  constexpr Eigen::Index rows = 16;
  const Eigen::Index zz = by_instruments_ ? instruments_ : 0;
  x_ = RowMajor::Zero(rows, unknowns_ + 1 + step);
  z_ = RowMajor::Zero(rows, instruments_ + step);
  blocks_.assign(blocks, {RowMajor::Zero(instruments_, x_.cols()), RowMajor::Zero(zz, zz + step), 0});
}

PINNQUAD_BODY void BlockRegression::add(std::size_t block, const double* regressors, double y,
                                        const double* instruments) {
  ++blocks_.at(block).rows;
  const double* const z = by_instruments_ ? instruments : regressors;
  const Range of_x = without_zeros(regressors, unknowns_), of_z = without_zeros(z, instruments_);
  if (waiting_ == x_.rows() || block != block_ || of_x.first != of_x_.first || of_z.first != of_z_.first) {
    take_waiting();
    block_ = block;
    of_x_ = of_x;
    of_z_ = of_z;
  }
  of_x_.end = unknowns_ + 1;
  of_z_.end = std::max(of_z_.end, of_z.end);
  std::copy_n(regressors, unknowns_, x_.row(waiting_).data());
  x_(waiting_, unknowns_) = y;
  std::copy_n(z, instruments_, z_.row(waiting_).data());
  ++waiting_;
}

PINNQUAD_BODY void BlockRegression::take_waiting() {
  using Columns = Eigen::Array<double, 1, step>;
  Sums& sums = blocks_[block_];
  const auto sum_up = [this](RowMajor& to, Eigen::Index k, const RowMajor& rows, const Range& range) {
    for (Eigen::Index first = range.first; first < range.end; first += step) {
      Eigen::Map<Columns> place(&to(k, first));
      Columns sum = place;
      const double *z = &z_(0, k), *x = &rows(0, first);
      for (Eigen::Index i = 0; i < waiting_; ++i, z += z_.cols(), x += rows.cols()) {
        sum += *z * Eigen::Map<const Columns>(x);
      }
      place = sum;
    }
  };
  for (Eigen::Index k = of_z_.first; k < of_z_.end; ++k) {
    sum_up(sums.zx, k, x_, of_x_);
    if (by_instruments_) sum_up(sums.zz, k, z_, {of_z_.first, k + 1});
  }
  waiting_ = 0;
}

PINNQUAD_BODY BlockSolution BlockRegression::solve(bool with_intervals) {
  take_waiting();
  Sums all = blocks_.front();
  for (std::size_t i = 1; i < blocks_.size(); ++i) {
    all.zx += blocks_[i].zx;
    all.zz += blocks_[i].zz;
  }
  const std::vector<bool> told = told_apart(normal_of(all, {}));
  std::vector<std::vector<double>> left_out;
  for (const Sums& block : blocks_) {
    if (block.rows == 0 || !with_intervals) continue;
    Sums others = all;
    others.zx -= block.zx;
    others.zz -= block.zz;
    left_out.push_back(solved(normal_of(others, told)));
  }
  return {solved(normal_of(all, told)), told, std::move(left_out)};
}

PINNQUAD_BODY BlockRegression::Range BlockRegression::without_zeros(const double* values, Eigen::Index count) noexcept {
  Eigen::Index first = 0;
  while (first < count && values[first] == 0) ++first;
  while (count > first && values[count - 1] == 0) --count;
  return {first, count};
}

PINNQUAD_BODY Eigen::VectorXd BlockRegression::inverse_roots(const Eigen::VectorXd& diagonal) {
  Eigen::VectorXd scale(diagonal.size());
  for (Eigen::Index i = 0; i < diagonal.size(); ++i) scale[i] = diagonal[i] > 0 ? 1 / std::sqrt(diagonal[i]) : 0;
  return scale;
}

PINNQUAD_BODY BlockRegression::Normal BlockRegression::normal_of(const Sums& sums,
                                                                 const std::vector<bool>& told) const {
  Normal normal;
  const Eigen::MatrixXd zx = sums.zx.leftCols(unknowns_);
  const Eigen::VectorXd zy = sums.zx.col(unknowns_);
  if (by_instruments_) {
    Eigen::MatrixXd zz = sums.zz.leftCols(instruments_);
    const Eigen::VectorXd roots = inverse_roots(zz.diagonal());
    zz.triangularView<Eigen::StrictlyUpper>() = zz.transpose().eval();
    zz = (roots.asDiagonal() * zz * roots.asDiagonal()).eval();
    const Eigen::MatrixXd weights = roots.asDiagonal() * detail::solve_symmetric(zz, roots.asDiagonal() * zx);
    normal.a = detail::matrix_product(weights.transpose(), zx);
    normal.b = detail::matrix_product(weights.transpose(), zy);
  } else {
    normal.a = zx;
    normal.b = zy;
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

PINNQUAD_BODY std::vector<double> BlockRegression::solved(const Normal& normal) const {
  const Eigen::VectorXd theta = normal.scale.asDiagonal() * detail::solve_symmetric(normal.a, normal.b);
  return {theta.data(), theta.data() + theta.size()};
}

PINNQUAD_BODY std::vector<bool> BlockRegression::told_apart(const Normal& normal) const {
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

}  // namespace pinnquad
