// SPDX-License-Identifier: MIT
// Jacobi's rotations and what is solved by them, against Eigen's own solver and decomposition.
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/regression/ridge.hpp"

using namespace pinnquad;
using namespace pinnquad::detail;

namespace {

Eigen::MatrixXd random_matrix(std::mt19937_64& engine, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd matrix(rows, columns);
  for (Eigen::Index i = 0; i < matrix.size(); ++i) matrix.data()[i] = uniform(engine, -1, 1);
  return matrix;
}

/// Of `rank`, without negative eigenvalues.
Eigen::MatrixXd gram(std::mt19937_64& engine, Eigen::Index size, Eigen::Index rank) {
  const Eigen::MatrixXd rows = random_matrix(engine, rank, size);
  return rows.transpose() * rows;
}

double most(const Eigen::MatrixXd& matrix) { return matrix.size() > 0 ? matrix.cwiseAbs().maxCoeff() : 0.0; }

}  // namespace

TEST_CASE("eigenvalues are Eigen's, eigenvectors are orthogonal and make the matrix again") {
  std::mt19937_64 engine(1);
  for (const Eigen::Index size : {1, 2, 3, 7, 21, 64}) {
    for (const Eigen::Index rank : {Eigen::Index{0}, size / 2, size}) {
      CAPTURE(size);
      CAPTURE(rank);
      const Eigen::MatrixXd a = gram(engine, size, rank);
      const pinnquad::detail::EigenPairs pairs = eigen_pairs(a);
      Eigen::VectorXd values = pairs.values;
      std::sort(values.data(), values.data() + size);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
      const double rounding = 1e-14 * static_cast<double>(size) * (1 + most(a));
      CHECK(most(values - solver.eigenvalues()) <= rounding);
      CHECK(most(pairs.vectors.transpose() * pairs.vectors - Eigen::MatrixXd::Identity(size, size)) <= rounding);
      CHECK(most(pairs.vectors * pairs.values.asDiagonal() * pairs.vectors.transpose() - a) <= rounding);
    }
  }
}

TEST_CASE("negative eigenvalues, equal ones, and a matrix that is diagonal") {
  std::mt19937_64 engine(2);
  const Eigen::MatrixXd any = random_matrix(engine, 9, 9), symmetric = any + any.transpose();
  Eigen::VectorXd values = eigen_pairs(symmetric).values;
  std::sort(values.data(), values.data() + 9);
  CHECK(most(values - Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric).eigenvalues()) < 1e-13);
  const pinnquad::detail::EigenPairs same = eigen_pairs(3.0 * Eigen::MatrixXd::Identity(5, 5));
  CHECK(most(same.values - Eigen::VectorXd::Constant(5, 3.0)) == 0);
  CHECK(most(same.vectors - Eigen::MatrixXd::Identity(5, 5)) == 0);
  CHECK(eigen_pairs(Eigen::MatrixXd(0, 0)).values.size() == 0);
}

TEST_CASE(
    "blocks along the diagonal: each has eigenvectors of its own, one that only its last unknown holds together too") {
  std::mt19937_64 engine(4);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(17, 17);
  a.block(1, 1, 5, 5) = gram(engine, 5, 3);
  a.block(6, 6, 10, 10) = gram(engine, 10, 10).diagonal().asDiagonal();
  for (Eigen::Index i = 6; i < 15; ++i) a(i, 15) = a(15, i) = 0.1;
  const pinnquad::detail::EigenPairs pairs = eigen_pairs(a);
  CHECK(most(pairs.vectors * pairs.values.asDiagonal() * pairs.vectors.transpose() - a) < 1e-13);
  CHECK(most(pairs.vectors.transpose() * pairs.vectors - Eigen::MatrixXd::Identity(17, 17)) < 1e-13);
  for (const Eigen::Index end : {1, 6, 16}) CHECK(most(pairs.vectors.bottomLeftCorner(17 - end, end)) == 0);
  CHECK((pairs.values[0] == 0 && pairs.values[16] == 0));
}

TEST_CASE("of all that come closest the one of least norm: Eigen's complete orthogonal decomposition") {
  std::mt19937_64 engine(3);
  for (const Eigen::Index size : {2, 5, 21, 40}) {
    for (const Eigen::Index rank : {size - 1, size / 2}) {
      CAPTURE(size);
      CAPTURE(rank);
      const Eigen::MatrixXd a = gram(engine, size, rank), b = random_matrix(engine, size, 3);
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> least(a);
      least.setThreshold(1e-10);
      REQUIRE(least.rank() == rank);
      const Eigen::MatrixXd expected = least.solve(b);
      CHECK(most(solve_symmetric(a, b) - expected) <= 1e-8 * (1 + most(expected)));
    }
  }
}
