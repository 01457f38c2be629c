// SPDX-License-Identifier: MIT
// Bodies of ridge.hpp.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Jacobi>

#include "pinnquad/regression/ridge.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY Eigen::MatrixXd matrix_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return a * b; }

PINNQUAD_BODY EigenPairs eigen_pairs(const Eigen::MatrixXd& a) {
  constexpr int most_sweeps = 60;  // a handful is usual: it converges quadratically
  const Eigen::Index size = a.rows();
  EigenPairs pairs{Eigen::VectorXd(size), Eigen::MatrixXd::Zero(size, size)};
  const double negligible = size > 0 ? std::numeric_limits<double>::epsilon() * a.cwiseAbs().maxCoeff() : 0.0;
  for (Eigen::Index first = 0, next = 0; first < size; first = next) {
    next = first + 1;
    for (Eigen::Index i = first; i < next; ++i) {
      for (Eigen::Index j = next; j < size; ++j) {
        if (a(i, j) != 0 || a(j, i) != 0) next = j + 1;
      }
    }
    const Eigen::Index count = next - first;
    Eigen::MatrixXd block = a.block(first, first, count, count), vectors = Eigen::MatrixXd::Identity(count, count);
    for (int sweep = 0, turned = 1; sweep < most_sweeps && turned > 0; ++sweep) {
      turned = 0;
      for (Eigen::Index p = 0; p < count; ++p) {
        for (Eigen::Index q = p + 1; q < count; ++q) {
          if (!(std::abs(block(p, q)) > negligible)) continue;
          Eigen::JacobiRotation<double> rotation;
          rotation.makeJacobi(block, p, q);
          block.applyOnTheLeft(p, q, rotation.adjoint());
          block.applyOnTheRight(p, q, rotation);
          vectors.applyOnTheRight(p, q, rotation);
          ++turned;
        }
      }
    }
    pairs.values.segment(first, count) = block.diagonal();
    pairs.vectors.block(first, first, count, count) = vectors;
  }
  return pairs;
}

PINNQUAD_BODY Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const double rounding = std::numeric_limits<double>::epsilon() * static_cast<double>(a.rows());
  const Eigen::LLT<Eigen::MatrixXd> factors(a);
  // Far above rounding: what is left of a variance that the other columns explain is a difference of equals.
  constexpr double enough = 1e4;
  if (factors.info() == Eigen::Success && factors.rcond() > enough * rounding) return factors.solve(b);
  const EigenPairs pairs = eigen_pairs(a);
  const double largest = a.rows() > 0 ? pairs.values.maxCoeff() : 0.0;
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(b.rows(), b.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    if (!(pairs.values[i] > enough * rounding * largest)) continue;
    const auto axis = pairs.vectors.col(i);
    for (Eigen::Index k = 0; k < b.cols(); ++k) x.col(k) += axis.dot(b.col(k)) / pairs.values[i] * axis;
  }
  return x;
}

PINNQUAD_BODY std::optional<Eigen::MatrixXd> whitening_of(const Eigen::MatrixXd& a) {
  const Eigen::LLT<Eigen::MatrixXd> factors(a);
  // Eigen takes NaN and infinity for positive; a row's reach its diagonal.
  if (factors.info() != Eigen::Success || !factors.matrixLLT().diagonal().allFinite()) return {};
  return factors.matrixL().solve(Eigen::MatrixXd::Identity(a.rows(), a.cols()));
}

PINNQUAD_BODY RegressionSums total(const std::vector<RegressionSums>& groups) {
  RegressionSums all = groups.front();
  for (std::size_t i = 1; i < groups.size(); ++i) all += groups[i];
  return all;
}

/// The normal equations A X = B of the features that are taken; `columns` are these.
struct RidgeSystem {
  std::vector<int> columns;
  Eigen::MatrixXd a, b;
  Eigen::VectorXd mean;

  RidgeSystem(const RegressionSums& sums, double penalty, const std::vector<bool>& taken) {
    if (!(sums.rows() > 0)) throw std::invalid_argument("ridge: expected at least one row, found none");
    if (!(penalty >= 0) || penalty > 1e12) {
      throw std::invalid_argument("ridge: expected a penalty from 0, found " + std::to_string(penalty));
    }
    for (int i = 0; i < sums.inputs(); ++i) {
      if (taken.empty() || taken[std::size_t(i)]) columns.push_back(i);
    }
    const Eigen::MatrixXd covariances = sums.covariances();
    mean = sums.means();
    const auto size = static_cast<Eigen::Index>(columns.size());
    a.resize(size, size);
    b.resize(size, sums.outputs());
    for (Eigen::Index i = 0; i < size; ++i) {
      const int row = columns[std::size_t(i)];
      for (Eigen::Index j = 0; j < size; ++j) a(i, j) = covariances(row, columns[std::size_t(j)]);
      a(i, i) += penalty;
      for (int k = 0; k < sums.outputs(); ++k) b(i, k) = covariances(row, sums.inputs() + k);
    }
  }

  /// The map of a solution X. A feature that is not taken has the weight 0.
  AffineMap map(const RegressionSums& sums, const Eigen::MatrixXd& solution) const {
    AffineMap map;
    map.inputs = sums.inputs();
    map.outputs = sums.outputs();
    map.weights.assign(std::size_t(map.inputs) * std::size_t(map.outputs), 0.0);
    for (int k = 0; k < map.outputs; ++k) {
      double at_mean = 0;
      for (std::size_t i = 0; i < columns.size(); ++i) {
        const double weight = solution(Eigen::Index(i), k);
        map.weights[std::size_t(k * map.inputs + columns[i])] = weight;
        at_mean += weight * mean[columns[i]];
      }
      map.intercept.push_back(mean[map.inputs + k] - at_mean);
    }
    return map;
  }
};

}  // namespace detail

PINNQUAD_BODY AffineMap fit_ridge(const RegressionSums& sums, double penalty, const std::vector<bool>& taken) {
  const detail::RidgeSystem system(sums, penalty, taken);
  return system.map(sums, detail::solve_symmetric(system.a, system.b));
}

PINNQUAD_BODY double squared_error(const RegressionSums& sums, const AffineMap& map) {
  const Eigen::MatrixXd covariances = sums.covariances();
  const Eigen::VectorXd mean = sums.means();
  const int n = map.inputs;
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const RowMajor> w(map.weights.data(), map.outputs, n);
  double sum = 0;
  for (int k = 0; k < map.outputs; ++k) {
    const Eigen::VectorXd of = w.row(k).transpose();
    const double bias = mean[n + k] - map.intercept[std::size_t(k)] - of.dot(mean.head(n));
    sum += covariances(n + k, n + k) - 2 * of.dot(covariances.col(n + k).head(n)) +
           of.dot(covariances.topLeftCorner(n, n) * of) + bias * bias;
  }
  return sum * sums.rows();
}

PINNQUAD_BODY std::vector<double> usual_penalties() {
  return {1e-7, 3e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 3e-1, 1.0, 3.0, 10.0};
}

PINNQUAD_BODY double choose_penalty(const std::vector<RegressionSums>& groups, const std::vector<double>& candidates,
                                    const std::vector<bool>& taken) {
  if (groups.size() < 2) {
    throw std::invalid_argument("ridge: expected two groups of rows or more, to leave one out in turn, found " +
                                std::to_string(groups.size()));
  }
  if (candidates.empty()) throw std::invalid_argument("ridge: expected a penalty to choose, found none");
  const RegressionSums all = detail::total(groups);
  std::vector<double> errors(candidates.size(), 0.0);  // mean squared, over all rows
  for (const RegressionSums& left_out : groups) {
    RegressionSums others = all;
    others -= left_out;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      errors[i] += squared_error(left_out, fit_ridge(others, candidates[i], taken)) / (all.rows() * all.outputs());
    }
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    const double error = errors[i], least = errors[best];
    if (error < least || (!(error > least) && candidates[i] > candidates[best])) best = i;
  }
  return candidates[best];
}

PINNQUAD_BODY AffineMap fit_bounded_ridge(const RegressionSums& sums, double penalty, const std::vector<bool>& taken,
                                          const std::vector<detail::WeightBound>& bounds) {
  constexpr std::size_t most_bounds = 8;
  if (sums.outputs() != 1) {
    throw std::invalid_argument("ridge: expected one output, found " + std::to_string(sums.outputs()));
  }
  if (bounds.size() > most_bounds) throw std::invalid_argument("ridge: expected 8 bounds at most");
  const detail::RidgeSystem system(sums, penalty, taken);
  const auto size = static_cast<Eigen::Index>(system.columns.size());
  const auto count = static_cast<Eigen::Index>(bounds.size());
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(size, 1 + count);  // the free fit, then each bound's
  right.col(0) = system.b;
  for (Eigen::Index k = 0; k < count; ++k) {
    for (const auto& [feature, factor] : bounds[std::size_t(k)].terms) {
      const auto column = std::find(system.columns.begin(), system.columns.end(), feature);
      if (column == system.columns.end()) {
        throw std::invalid_argument("ridge: a bound of feature " + std::to_string(feature) + ", not taken");
      }
      right(column - system.columns.begin(), 1 + k) = factor;
    }
  }
  const Eigen::MatrixXd solution = detail::solve_symmetric(system.a, right);
  const Eigen::MatrixXd by = right.rightCols(count), moved = solution.rightCols(count);
  const Eigen::VectorXd free = solution.col(0);
  constexpr double tolerance = 1e-9;  // of a bound that holds with equality, after rounding
  Eigen::VectorXd best;
  double least_cost = 0;
  for (std::size_t active = 0; active < (std::size_t{1} << bounds.size()); ++active) {
    std::vector<Eigen::Index> held;
    bool allowed = true;
    for (Eigen::Index k = 0; k < count; ++k) {
      const bool is_held = (active >> k & 1U) != 0;
      allowed = allowed && (is_held || !bounds[std::size_t(k)].pinned);
      if (is_held) held.push_back(k);
    }
    if (!allowed) continue;
    Eigen::VectorXd weights = free;
    if (!held.empty()) {
      const auto rows = static_cast<Eigen::Index>(held.size());
      Eigen::MatrixXd gram(rows, rows), missing(rows, 1);
      for (Eigen::Index i = 0; i < rows; ++i) {
        for (Eigen::Index j = 0; j < rows; ++j)
          gram(i, j) = by.col(held[std::size_t(i)]).dot(moved.col(held[std::size_t(j)]));
        missing(i, 0) = bounds[std::size_t(held[std::size_t(i)])].least - by.col(held[std::size_t(i)]).dot(free);
      }
      const Eigen::MatrixXd forces = detail::solve_symmetric(gram, missing);
      for (Eigen::Index i = 0; i < rows; ++i) weights += forces(i, 0) * moved.col(held[std::size_t(i)]);
    }
    bool keeps = true;
    for (Eigen::Index k = 0; k < count; ++k) {
      const double short_of = bounds[std::size_t(k)].least - by.col(k).dot(weights);
      const double scale = by.col(k).cwiseAbs().dot(weights.cwiseAbs()) + std::abs(bounds[std::size_t(k)].least);
      keeps = keeps && short_of <= tolerance * scale;
    }
    if (!keeps) continue;
    const double cost = weights.dot(system.a * weights) - 2 * weights.dot(right.col(0));
    if (best.size() == 0 || cost < least_cost) {
      best = weights;
      least_cost = cost;
    }
  }
  if (best.size() == 0 && size > 0) throw std::invalid_argument("ridge: no weights keep all bounds");
  return system.map(sums, best);
}

PINNQUAD_BODY void RegressionSums::add(const double* x, const double* y) {
  Eigen::VectorXd row(products_.rows());
  row[0] = 1;
  for (int i = 0; i < inputs_; ++i) row[1 + i] = x[i];
  for (int k = 0; k < outputs_; ++k) row[1 + inputs_ + k] = y[k];
  products_.selfadjointView<Eigen::Lower>().rankUpdate(row);
}

PINNQUAD_BODY RegressionSums RegressionSums::with(const Eigen::MatrixXd& products) const {
  RegressionSums other(inputs_, outputs_);
  other.products_ = products;
  return other;
}

PINNQUAD_BODY RegressionSums::RegressionSums(int inputs, int outputs)
    : inputs_(inputs),
      outputs_(outputs),
      products_(Eigen::MatrixXd::Zero(1 + inputs + outputs, 1 + inputs + outputs)) {}

PINNQUAD_BODY RegressionSums& RegressionSums::operator+=(const RegressionSums& other) {
  products_ += other.products_;
  return *this;
}

PINNQUAD_BODY RegressionSums& RegressionSums::operator-=(const RegressionSums& other) {
  products_ -= other.products_;
  return *this;
}

PINNQUAD_BODY Eigen::MatrixXd RegressionSums::products() const { return products_.selfadjointView<Eigen::Lower>(); }

PINNQUAD_BODY double RegressionSums::rows() const { return products_(0, 0); }

PINNQUAD_BODY Eigen::VectorXd RegressionSums::means() const {
  return products_.col(0).tail(inputs_ + outputs_) / rows();
}

PINNQUAD_BODY Eigen::MatrixXd RegressionSums::covariances() const {
  const Eigen::VectorXd mean = means();
  Eigen::MatrixXd all = products_.bottomRightCorner(inputs_ + outputs_, inputs_ + outputs_) / rows();
  all.triangularView<Eigen::StrictlyUpper>() = all.transpose();
  return all - mean * mean.transpose();
}

PINNQUAD_BODY RegressionSums RegressionSums::of_column(int from) const {
  RegressionSums one(inputs_, 1);
  const int to = 1 + inputs_;
  one.products_.topLeftCorner(to, to) = products_.topLeftCorner(to, to);
  for (int i = 0; i < to; ++i) one.products_(to, i) = from < i ? products_(i, from) : products_(from, i);
  one.products_(to, to) = products_(from, from);
  return one;
}

}  // namespace pinnquad
