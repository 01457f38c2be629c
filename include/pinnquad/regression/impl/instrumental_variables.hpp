// SPDX-License-Identifier: MIT
// Bodies of instrumental_variables.hpp.
#pragma once

#include "pinnquad/regression/instrumental_variables.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY Eigen::MatrixXd left_by(const Eigen::MatrixXd& sums, const std::vector<int>& by) {
  const auto count = static_cast<Eigen::Index>(by.size());
  Eigen::MatrixXd rows(1 + count, sums.cols()), own(1 + count, 1 + count);
  rows.row(0) = sums.row(0);
  for (Eigen::Index i = 0; i < count; ++i) rows.row(1 + i) = sums.row(1 + by[static_cast<std::size_t>(i)]);
  own.col(0) = rows.col(0);
  for (Eigen::Index i = 0; i < count; ++i) own.col(1 + i) = rows.col(1 + by[static_cast<std::size_t>(i)]);
  return sums - matrix_product(rows.transpose(), solve_symmetric(own, rows));
}

PINNQUAD_BODY std::vector<int> joined(std::vector<int> first, const std::vector<int>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

PINNQUAD_BODY Eigen::MatrixXd part_of(const Eigen::MatrixXd& all, const std::vector<int>& inputs) {
  std::vector<Eigen::Index> columns = {0};
  for (const int i : inputs) columns.push_back(1 + i);
  columns.push_back(all.cols() - 1);
  const auto size = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd part(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) {
      part(i, j) = all(columns[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]);
    }
  }
  return part;
}

PINNQUAD_BODY std::vector<bool> regressors(const RegressionSums& sums, const InstrumentRoles& roles) {
  std::vector<bool> taken(static_cast<std::size_t>(sums.inputs()), false);
  for (const int i : joined(roles.exact, roles.noisy)) taken[static_cast<std::size_t>(i)] = true;
  return taken;
}

PINNQUAD_BODY double fuller_k(const RegressionSums& sums, const InstrumentedProducts& products,
                              const InstrumentRoles& roles) {
  const double freedom = sums.rows() - 1 - static_cast<double>(roles.exact.size() + roles.instruments.size());
  if (!(freedom > 0)) return 1;
  const auto count = static_cast<Eigen::Index>(roles.noisy.size()) + 1;
  std::vector<int> first;  // exact regressors, then noisy ones
  for (std::size_t i = 0; i < roles.exact.size(); ++i) first.push_back(static_cast<int>(i));
  const Eigen::MatrixXd outer =
      left_by(part_of(products.all, joined(roles.exact, roles.noisy)), first).bottomRightCorner(count, count) /
      sums.rows();
  const Eigen::MatrixXd inner = part_of(products.left, roles.noisy).bottomRightCorner(count, count) / sums.rows();
  const auto whitening = whitening_of(inner);
  if (!whitening) return 1;
  return eigen_pairs(matrix_product(matrix_product(*whitening, outer), whitening->transpose())).values.minCoeff() -
         1 / freedom;
}

}  // namespace detail

PINNQUAD_BODY RegressionSums k_class_sums(const RegressionSums& sums, const InstrumentRoles& roles, double k) {
  const detail::InstrumentedProducts products(sums, roles);
  return sums.with(products.all - k * products.left);
}

PINNQUAD_BODY double fuller_k(const RegressionSums& sums, const InstrumentRoles& roles) {
  return detail::fuller_k(sums, detail::InstrumentedProducts(sums, roles), roles);
}

namespace detail {

/// k_class_sums() of Fuller's estimator.
PINNQUAD_BODY RegressionSums fuller_sums(const RegressionSums& sums, const InstrumentRoles& roles) {
  const InstrumentedProducts products(sums, roles);
  return sums.with(products.all - fuller_k(sums, products, roles) * products.left);
}

PINNQUAD_BODY AffineMap fit_k_class(const RegressionSums& sums, const InstrumentRoles& roles,
                                    const std::vector<WeightBound>& bounds) {
  return fit_bounded_ridge(sums, smallest_penalty(), regressors(sums, roles), bounds);
}

}  // namespace detail

PINNQUAD_BODY AffineMap fit_instrumented(const RegressionSums& sums, const InstrumentRoles& roles, int regressor,
                                         const std::vector<detail::WeightBound>& bounds) {
  constexpr double largest_penalty = 1e6;
  const RegressionSums moved = detail::fuller_sums(sums, roles);
  AffineMap map = detail::fit_k_class(moved, roles, bounds);
  const auto held = static_cast<std::size_t>(regressor);
  const double slope = map.weights[held];
  const double variance = squared_error(sums, map) / sums.rows();
  const detail::RidgeSystem system(moved, 0, detail::regressors(moved, roles));
  Eigen::VectorXd others(system.a.rows());
  for (Eigen::Index i = 0; i < others.size(); ++i) {
    const int column = system.columns[static_cast<std::size_t>(i)];
    others[i] = column == regressor ? 0.0 : map.weights[static_cast<std::size_t>(column)];
  }
  const double count = std::max(1.0, static_cast<double>(others.size()) - 1);
  const double f = sums.rows() * others.dot(system.a * others) / (count * variance);
  const double penalty = f > 1 + 1 / largest_penalty ? 1 / (f - 1) : largest_penalty;
  return fit_bounded_ridge(moved, penalty, detail::regressors(moved, roles), {{{{regressor, 1.0}}, slope, true}});
}

namespace detail {

/// Least squares, instruments.
PINNQUAD_BODY std::array<double, 2> both_weights(const RegressionSums& sums, const InstrumentRoles& roles,
                                                 int regressor) {
  const auto at = static_cast<std::size_t>(regressor);
  return {fit_ridge(sums, smallest_penalty(), regressors(sums, roles)).weights[at],
          fit_k_class(fuller_sums(sums, roles), roles).weights[at]};
}

PINNQUAD_BODY double first_stage_strength(const RegressionSums& sums, const InstrumentRoles& roles, int regressor) {
  const auto variance = [&](double k) {
    const RidgeSystem system(k_class_sums(sums, roles, k), smallest_penalty(), regressors(sums, roles));
    Eigen::MatrixXd one = Eigen::MatrixXd::Zero(system.a.rows(), 1);
    const auto at = std::find(system.columns.begin(), system.columns.end(), regressor) - system.columns.begin();
    one(at, 0) = 1;
    return solve_symmetric(system.a, one)(at, 0);
  };
  const double partial = variance(0) / variance(1), count = static_cast<double>(roles.instruments.size());
  const double freedom = sums.rows() - 1 - static_cast<double>(roles.exact.size()) - count;
  return partial / count / std::max((1 - partial) / freedom, std::numeric_limits<double>::min());
}

}  // namespace detail

PINNQUAD_BODY InstrumentedWeight instrumented_weight(const std::vector<RegressionSums>& blocks, int output,
                                                     const InstrumentRoles& roles, int regressor) {
  constexpr double one_sided_99 = 2.326;
  if (blocks.size() < 3) {
    throw std::invalid_argument("instrumental variables: expected three blocks of rows or more, found " +
                                std::to_string(blocks.size()));
  }
  const RegressionSums all = detail::total(blocks).of_output(output);
  const auto [plain, instrumented] = detail::both_weights(all, roles, regressor);
  const double sign = instrumented < 0 ? -1 : 1;
  const auto numbers = [sign](const std::array<double, 2>& both) {
    return Eigen::Vector3d(both[0], both[1], sign * ((1 - tolerated_attenuation) * both[1] - both[0]));
  };
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
  const Eigen::Vector3d whole = numbers({plain, instrumented});
  for (const RegressionSums& block : blocks) {
    RegressionSums others = all;
    others -= block.of_output(output);
    const Eigen::Vector3d moved = numbers(detail::both_weights(others, roles, regressor)) - whole;
    sum += moved;
    squares += moved.cwiseAbs2();
  }
  const double count = static_cast<double>(blocks.size());
  const Eigen::Vector3d error = ((count - 1) / count * (squares - sum.cwiseAbs2() / count)).cwiseMax(0).cwiseSqrt();
  InstrumentedWeight found;
  found.least_squares = plain;
  found.instrumented = instrumented;
  found.least_squares_error = error[0];
  found.instrumented_error = error[1];
  found.strength = detail::first_stage_strength(all, roles, regressor);
  found.attenuation_t = error[2] > 0 ? whole[2] / error[2] : 0.0;
  found.errors_in_variables = found.attenuation_t > one_sided_99;
  return found;
}

}  // namespace pinnquad
