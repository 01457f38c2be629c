// SPDX-License-Identifier: MIT
// Linear regression on measured columns: y = b + W x + e where some x carry errors of measurement. Least squares bend
// their weights towards 0. Instruments, columns that move with the true x and know nothing of its errors, do not. Takes
// sums over rows, in blocks of consecutive rows (regression/ridge.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/regression/ridge.hpp"

namespace pinnquad {

/// The inputs of a regression, each in one role or in none.
struct InstrumentRoles {
  std::vector<int> exact;        ///< regressors without errors: their own instruments
  std::vector<int> noisy;        ///< regressors with errors
  std::vector<int> instruments;  ///< no regressors
};

/// The weight of one noisy regressor, by both estimators, in units of y per x.
struct InstrumentedWeight {
  double least_squares = 0, instrumented = 0;
  double least_squares_error = 0, instrumented_error = 0;  ///< standard errors, of autocorrelated rows too
  /// Strength of the instruments for this regressor alone: F of the first stage. Below 10 they are weak (Staiger,
  /// Stock, Econometrica 65, 1997): then the interval says how little is known.
  double strength = 0;
  /// Of the null hypothesis that least squares keep at least 1 - tolerated_attenuation of the weight: large where they
  /// do not.
  double attenuation_t = 0;
  bool errors_in_variables = false;  ///< this hypothesis is rejected
};

/// Weights that are bent by less than this are not told from ones that are not: rotor lag, too, moves them by some
/// percent.
inline constexpr double tolerated_attenuation = 0.05;

namespace detail {

/// Errors of least squares of all columns by 1 and the inputs `by`: S - S_Z (S_ZZ)^-1 S_Z', sums of products.
inline Eigen::MatrixXd left_by(const Eigen::MatrixXd& sums, const std::vector<int>& by) {
  const auto count = static_cast<Eigen::Index>(by.size());
  Eigen::MatrixXd rows(1 + count, sums.cols()), own(1 + count, 1 + count);
  rows.row(0) = sums.row(0);
  for (Eigen::Index i = 0; i < count; ++i) rows.row(1 + i) = sums.row(1 + by[static_cast<std::size_t>(i)]);
  own.col(0) = rows.col(0);
  for (Eigen::Index i = 0; i < count; ++i) own.col(1 + i) = rows.col(1 + by[static_cast<std::size_t>(i)]);
  return sums - matrix_product(rows.transpose(), solve_symmetric(own, rows));
}

inline std::vector<int> joined(std::vector<int> first, const std::vector<int>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Rows and columns of 1, these inputs and the output.
inline Eigen::MatrixXd part_of(const Eigen::MatrixXd& all, const std::vector<int>& inputs) {
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

inline std::vector<bool> regressors(const RegressionSums& sums, const InstrumentRoles& roles) {
  std::vector<bool> taken(static_cast<std::size_t>(sums.inputs()), false);
  for (const int i : joined(roles.exact, roles.noisy)) taken[static_cast<std::size_t>(i)] = true;
  return taken;
}

/// Of this output's fit; it is there to keep a system solvable, no more.
inline double smallest_penalty() { return usual_penalties().front(); }

/// Products of all columns, and what 1, exact regressors and instruments leave of them.
struct InstrumentedProducts {
  Eigen::MatrixXd all, left;

  InstrumentedProducts(const RegressionSums& sums, const InstrumentRoles& roles)
      : all(sums.products()), left(left_by(all, joined(roles.exact, roles.instruments))) {}
};

/// See fuller_k().
inline double fuller_k(const RegressionSums& sums, const InstrumentedProducts& products, const InstrumentRoles& roles) {
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

/// Sums of which least squares give the k-class estimate of one output:
///   (X' (1 - k M) X) W = X' (1 - k M) y,   M: what 1, exact regressors and instruments do not tell
/// k = 0: least squares; k = 1: two-stage least squares; fuller_k(): limited information. (Wooldridge, Econometric
/// Analysis of Cross Section and Panel Data, ch. 5; Davidson, MacKinnon, Econometric Theory and Methods, ch. 12.)
inline RegressionSums k_class_sums(const RegressionSums& sums, const InstrumentRoles& roles, double k) {
  const detail::InstrumentedProducts products(sums, roles);
  return sums.with(products.all - k * products.left);
}

/// k of Fuller's estimator (Econometrica 45, 1977), of one output: that of limited information maximum likelihood less
/// 1 / (rows - instruments). Two-stage least squares with weak or many instruments lean towards least squares; this
/// hardly. 1 where the rows are too few, or repeat each other.
inline double fuller_k(const RegressionSums& sums, const InstrumentRoles& roles) {
  return detail::fuller_k(sums, detail::InstrumentedProducts(sums, roles), roles);
}

namespace detail {

/// k_class_sums() of Fuller's estimator.
inline RegressionSums fuller_sums(const RegressionSums& sums, const InstrumentRoles& roles) {
  const InstrumentedProducts products(sums, roles);
  return sums.with(products.all - fuller_k(sums, products, roles) * products.left);
}

/// The estimate of one output, of sums that are k_class_sums() already.
inline AffineMap fit_k_class(const RegressionSums& sums, const InstrumentRoles& roles,
                             const std::vector<WeightBound>& bounds = {}) {
  return fit_bounded_ridge(sums, smallest_penalty(), regressors(sums, roles), bounds);
}

}  // namespace detail

/// The weights of one output: that of `regressor` by Fuller's estimator, under the bounds; the others around it,
/// shrunk. Free of a penalty they would carry what its errors leave: along columns that nearly repeat each other far
/// more than they are worth. Their penalty is 1 / (F - 1), F the statistic of all of them being 0: the ridge of a prior
/// whose variance is that of the weights less that of their errors (Lawless, Wang, Communications in Statistics 5,
/// 1976, have 1 / F). An instrument is among the inputs of the map with the weight 0.
inline AffineMap fit_instrumented(const RegressionSums& sums, const InstrumentRoles& roles, int regressor,
                                  const std::vector<detail::WeightBound>& bounds = {}) {
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
inline std::array<double, 2> both_weights(const RegressionSums& sums, const InstrumentRoles& roles, int regressor) {
  const auto at = static_cast<std::size_t>(regressor);
  return {fit_ridge(sums, smallest_penalty(), regressors(sums, roles)).weights[at],
          fit_k_class(fuller_sums(sums, roles), roles).weights[at]};
}

/// F of what the excluded instruments tell of one regressor when the fitted others are known: Shea's partial R^2
/// (Review of Economics and Statistics 79, 1997), by the diagonals of the inverted systems (Godfrey, ibid. 81, 1999).
inline double first_stage_strength(const RegressionSums& sums, const InstrumentRoles& roles, int regressor) {
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

/// The weight of `regressor`, one of the noisy, by both estimators, and whether least squares bend it: a test of
/// exogeneity by Hausman's contrast (Econometrica 46, 1978) of this weight alone. Rows of a flight follow each other,
/// so standard errors are those of the jackknife that leaves out whole blocks (Kuensch, Annals of Statistics 17, 1989):
/// sqrt((n - 1) / n sum (w_i - mean)^2). A block must be longer than the memory of the residuals. `output`: one of the
/// sums'. Throws std::invalid_argument for fewer than three blocks.
inline InstrumentedWeight instrumented_weight(const std::vector<RegressionSums>& blocks, int output,
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
