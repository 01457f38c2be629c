// SPDX-License-Identifier: MIT
// A symmetric system of equations without negative eigenvalues, as least squares makes them: by Cholesky's factors, or by
// eigenvalues (the singular values of such a matrix) where it has not full rank. And what makes a covariance the identity.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Jacobi>

#include <cmath>
#include <limits>
#include <optional>

#include "pinnquad/regression/regression_sums.hpp"

namespace pinnquad {

/// A = V diag(values) V', V orthogonal: a column per eigenvalue, in no order.
struct EigenPairs {
  Eigen::VectorXd values;
  DynamicMatrix vectors;
};

/// Of a symmetric matrix, by Jacobi's rotations: Eigen's solver is faster when it runs, and takes each translation unit that fits
/// a ridge four seconds longer to compile, for a case that is rare.
inline EigenPairs eigen_pairs(DynamicMatrix a) {
  constexpr int most_sweeps = 60;  // a handful is usual: it converges quadratically
  const Eigen::Index size = a.rows();
  DynamicMatrix vectors = DynamicMatrix::Identity(size, size);
  const double negligible = size > 0 ? std::numeric_limits<double>::epsilon() * a.cwiseAbs().maxCoeff() : 0.0;
  for (int sweep = 0, turned = 1; sweep < most_sweeps && turned > 0; ++sweep) {
    turned = 0;
    for (Eigen::Index p = 0; p < size; ++p) {
      for (Eigen::Index q = p + 1; q < size; ++q) {
        if (!(std::abs(a(p, q)) > negligible)) continue;
        Eigen::JacobiRotation<double> rotation;
        rotation.makeJacobi(a, p, q);
        a.applyOnTheLeft(p, q, rotation.adjoint());
        a.applyOnTheRight(p, q, rotation);
        vectors.applyOnTheRight(p, q, rotation);
        ++turned;
      }
    }
  }
  return {a.diagonal(), vectors};
}

/// X of A X = B, of all that come closest to it the one of least norm: what A does not tell is 0. A: symmetric, no eigenvalue
/// below 0 but by rounding; its diagonal of one order of magnitude, or 0.
inline DynamicMatrix solve_symmetric(const DynamicMatrix& a, const DynamicMatrix& b) {
  const double rounding = std::numeric_limits<double>::epsilon() * static_cast<double>(a.rows());
  const Eigen::LLT<DynamicMatrix> factors(a);
  // Far above rounding: what is left of a variance that the other columns explain is a difference of equals.
  constexpr double enough = 1e4;
  if (factors.info() == Eigen::Success && factors.rcond() > enough * rounding) return factors.solve(b);
  const EigenPairs pairs = eigen_pairs(a);
  const double largest = a.rows() > 0 ? pairs.values.maxCoeff() : 0.0;
  DynamicMatrix x = DynamicMatrix::Zero(b.rows(), b.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    if (!(pairs.values[i] > enough * rounding * largest)) continue;
    const auto axis = pairs.vectors.col(i);
    for (Eigen::Index k = 0; k < b.cols(); ++k) x.col(k) += axis.dot(b.col(k)) / pairs.values[i] * axis;
  }
  return x;
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
