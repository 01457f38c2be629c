// SPDX-License-Identifier: MIT
// A symmetric system of equations without negative eigenvalues, as least squares makes them: by Cholesky's factors, or by
// eigenvalues (the singular values of such a matrix) where it has not full rank. And what makes a covariance the identity.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <limits>
#include <optional>

#include "pinnquad/identification/regression_sums.hpp"

namespace pinnquad {

/// X of A X = B, of all that come closest to it the one of least norm: what A does not tell is 0. A: symmetric, no eigenvalue
/// below 0 but by rounding; its diagonal of one order of magnitude, or 0.
inline DynamicMatrix solve_symmetric(const DynamicMatrix& a, const DynamicMatrix& b) {
  const double rounding = std::numeric_limits<double>::epsilon() * static_cast<double>(a.rows());
  const Eigen::LLT<DynamicMatrix> factors(a);
  // Far above rounding: what is left of a variance that the other columns explain is a difference of equals.
  constexpr double enough = 1e4;
  if (factors.info() == Eigen::Success && factors.rcond() > enough * rounding) return factors.solve(b);
  const Eigen::SelfAdjointEigenSolver<DynamicMatrix> solver(a);
  const double largest = a.rows() > 0 ? solver.eigenvalues().maxCoeff() : 0.0;
  const DynamicMatrix in_axes = solver.eigenvectors().transpose() * b;
  DynamicMatrix scaled = DynamicMatrix::Zero(b.rows(), b.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const double value = solver.eigenvalues()[i];
    if (value > enough * rounding * largest) scaled.row(i) = in_axes.row(i) / value;
  }
  return solver.eigenvectors() * scaled;
}

/// Lower triangular W with W A W' = 1: the inverse of Cholesky's factor. A: symmetric, its lower triangle is read. Empty where
/// A is not positive definite, by rounding too, or not finite.
inline std::optional<DynamicMatrix> whitening_of(const DynamicMatrix& a) {
  const Eigen::LLT<DynamicMatrix> factors(a);
  // Eigen takes NaN and infinity for positive; a row's reach its diagonal.
  if (factors.info() != Eigen::Success || !factors.matrixLLT().diagonal().allFinite()) return {};
  return factors.matrixL().solve(DynamicMatrix::Identity(a.rows(), a.cols()));
}

}  // namespace pinnquad
