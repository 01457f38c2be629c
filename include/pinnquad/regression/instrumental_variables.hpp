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

#include "pinnquad/core/body.hpp"
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
Eigen::MatrixXd left_by(const Eigen::MatrixXd& sums, const std::vector<int>& by);

std::vector<int> joined(std::vector<int> first, const std::vector<int>& second);

/// Rows and columns of 1, these inputs and the output.
Eigen::MatrixXd part_of(const Eigen::MatrixXd& all, const std::vector<int>& inputs);

std::vector<bool> regressors(const RegressionSums& sums, const InstrumentRoles& roles);

/// Of this output's fit; it is there to keep a system solvable, no more.
inline double smallest_penalty() { return usual_penalties().front(); }

/// Products of all columns, and what 1, exact regressors and instruments leave of them.
struct InstrumentedProducts {
  Eigen::MatrixXd all, left;

  InstrumentedProducts(const RegressionSums& sums, const InstrumentRoles& roles)
      : all(sums.products()), left(left_by(all, joined(roles.exact, roles.instruments))) {}
};

/// See fuller_k().
double fuller_k(const RegressionSums& sums, const InstrumentedProducts& products, const InstrumentRoles& roles);

}  // namespace detail

/// Sums of which least squares give the k-class estimate of one output:
///   (X' (1 - k M) X) W = X' (1 - k M) y,   M: what 1, exact regressors and instruments do not tell
/// k = 0: least squares; k = 1: two-stage least squares; fuller_k(): limited information. (Wooldridge, Econometric
/// Analysis of Cross Section and Panel Data, ch. 5; Davidson, MacKinnon, Econometric Theory and Methods, ch. 12.)
RegressionSums k_class_sums(const RegressionSums& sums, const InstrumentRoles& roles, double k);

/// k of Fuller's estimator (Econometrica 45, 1977), of one output: that of limited information maximum likelihood less
/// 1 / (rows - instruments). Two-stage least squares with weak or many instruments lean towards least squares; this
/// hardly. 1 where the rows are too few, or repeat each other.
double fuller_k(const RegressionSums& sums, const InstrumentRoles& roles);

namespace detail {

/// The estimate of one output, of sums that are k_class_sums() already.
AffineMap fit_k_class(const RegressionSums& sums, const InstrumentRoles& roles,
                      const std::vector<WeightBound>& bounds = {});

}  // namespace detail

/// The weights of one output: that of `regressor` by Fuller's estimator, under the bounds; the others around it,
/// shrunk. Free of a penalty they would carry what its errors leave: along columns that nearly repeat each other far
/// more than they are worth. Their penalty is 1 / (F - 1), F the statistic of all of them being 0: the ridge of a prior
/// whose variance is that of the weights less that of their errors (Lawless, Wang, Communications in Statistics 5,
/// 1976, have 1 / F). An instrument is among the inputs of the map with the weight 0.
AffineMap fit_instrumented(const RegressionSums& sums, const InstrumentRoles& roles, int regressor,
                           const std::vector<detail::WeightBound>& bounds = {});

namespace detail {

/// F of what the excluded instruments tell of one regressor when the fitted others are known: Shea's partial R^2
/// (Review of Economics and Statistics 79, 1997), by the diagonals of the inverted systems (Godfrey, ibid. 81, 1999).
double first_stage_strength(const RegressionSums& sums, const InstrumentRoles& roles, int regressor);

}  // namespace detail

/// The weight of `regressor`, one of the noisy, by both estimators, and whether least squares bend it: a test of
/// exogeneity by Hausman's contrast (Econometrica 46, 1978) of this weight alone. Rows of a flight follow each other,
/// so standard errors are those of the jackknife that leaves out whole blocks (Kuensch, Annals of Statistics 17, 1989):
/// sqrt((n - 1) / n sum (w_i - mean)^2). A block must be longer than the memory of the residuals. `output`: one of the
/// sums'. Throws std::invalid_argument for fewer than three blocks.
InstrumentedWeight instrumented_weight(const std::vector<RegressionSums>& blocks, int output,
                                       const InstrumentRoles& roles, int regressor);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/regression/impl/instrumental_variables.hpp"
#endif
