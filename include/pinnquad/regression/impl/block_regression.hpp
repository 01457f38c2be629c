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
  const Eigen::Index zz = by_instruments_ ? instruments_ : 0;
  blocks_.assign(blocks, {RowMajor::Zero(instruments_, unknowns_), Eigen::VectorXd::Zero(instruments_),
                          RowMajor::Zero(zz, zz), 0});
}

PINNQUAD_BODY void BlockRegression::add(std::size_t block, const double* regressors, double y,
                                        const double* instruments) {
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

PINNQUAD_BODY BlockSolution BlockRegression::solve(bool with_intervals) const {
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

PINNQUAD_BODY BlockRegression::Range BlockRegression::without_zeros(const double* values, Eigen::Index count) noexcept {
  Eigen::Index first = 0;
  while (first < count && values[first] == 0) ++first;
  while (count > first && values[count - 1] == 0) --count;
  return {first, count - first};
}

PINNQUAD_BODY Eigen::VectorXd BlockRegression::inverse_roots(const Eigen::VectorXd& diagonal) {
  Eigen::VectorXd scale(diagonal.size());
  for (Eigen::Index i = 0; i < diagonal.size(); ++i) scale[i] = diagonal[i] > 0 ? 1 / std::sqrt(diagonal[i]) : 0;
  return scale;
}

PINNQUAD_BODY BlockRegression::Normal BlockRegression::normal_of(const Sums& sums,
                                                                 const std::vector<bool>& told) const {
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
