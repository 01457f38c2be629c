// SPDX-License-Identifier: MIT
// Limits of trust (docs/trust.md): the joint distribution of a model's training rows, and limits of distance and
// command residual that validation flights pass with a chosen false-alarm rate.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/regression/ridge.hpp"
#include "pinnquad/training/asked_model.hpp"
#include "pinnquad/training/training_data.hpp"

namespace pinnquad {

namespace detail {

/// Mean and covariance of features: the whitening W has W covariance W' = 1.
struct JointDistribution {
  std::vector<double> mean;       ///< physical units
  std::vector<double> whitening;  ///< of x - mean; lower triangular, column after column

  /// Squared length of the sums of `term(weight, j)` over the columns j of the whitening.
  template <class Term>
  double squared_length(const Term& term) const {
    std::vector<double> white(mean.size());
    std::size_t at = 0;
    for (std::size_t j = 0; j < white.size(); ++j) {
      for (std::size_t i = j; i < white.size(); ++i) white[i] += term(whitening[at++], j);
    }
    double squared = 0;
    for (const double w : white) squared += w * w;
    return squared;
  }
  /// As the flight side works it out; of its training rows the mean is about the number of features.
  double squared_distance(const double* x) const {
    return squared_length([&](double w, std::size_t j) { return w * (x[j] - mean[j]); });
  }
  /// No features within the envelope have a greater squared distance: each row of |W| times the envelope's half-widths
  /// about the mean. A limit above it never triggers beside TrainingEnvelope.
  double greatest_squared_distance(const std::vector<double>& lower, const std::vector<double>& upper) const {
    return squared_length(
        [&](double w, std::size_t j) { return std::abs(w) * std::max(upper[j] - mean[j], mean[j] - lower[j]); });
  }
};

/// Takes the rows that have features. A feature that stands still is independent of the others, with the standard
/// deviation 1 that the scalers give it. Throws std::invalid_argument for a share outside (0, 1] or too small, and for
/// no more rows than features.
JointDistribution fit_joint_distribution(const AskedModel& model, const RowSet& training, double shrinkage);

/// Fewer say nothing of a tail.
inline constexpr std::size_t least_alarm_blocks = 8;

/// A limit that one block in `blocks_per_alarm` exceeds, judged by the maxima of n blocks of the same kind. If a new
/// block is as likely as each of the n to hold any rank among them, it exceeds the k-th greatest with the probability k
/// / (n + 1), whatever the distribution: k = floor((n + 1) / blocks_per_alarm). Where n is too small for k = 1 the tail
/// of the greatest m = max(4, n / 10) maxima is continued as a power law (Weissman 1978, exponent by Hill 1975): a
/// guess, on the side of few alarms where the tail is exponential. Throws std::invalid_argument for fewer than 8 blocks
/// and for maxima that are not above 0.
double alarm_limit(std::vector<double> maxima, double blocks_per_alarm);

/// The figures that have limits, row by row.
struct TrustSeries {
  std::vector<double> squared_distances;
  std::vector<double> errors;  ///< mean over the rotors of |command predicted - command flown|
};

}  // namespace detail

/// Limits and what they are limits of; values in double.
struct FittedTrust {
  /// The demands on the two limits, and how fast the command residual's mean forgets.
  struct Settings {
    double seconds_per_alarm = 1800;  ///< of calm flight, for each of the two; both together raise twice as many
    double block_s = 10;              ///< alarms less than this apart are one
    double command_residual_factor = 0.2;
    /// Share of the covariance that is replaced by independent features of the same standard deviation. Features that
    /// go together in all rows (one a linear map of others) leave it without an inverse. With this share no eigenvalue
    /// of the correlations is below it: a float's rounding stays below a hundredth of a deviation, and a row that
    /// breaks such a rule by a deviation is 30 deviations away.
    double shrinkage = 1e-3;
  };

  detail::JointDistribution distribution{};
  double squared_distance_limit = 0;  ///< of the squared distance
  double command_residual_factor = 0;
  double command_residual_limit = 0;
  double command_residual_cleared = 0;  ///< half-way from the usual mean to the limit
  double update_period_s = 0;           ///< of the rows that the command residual was fitted on
};

/// The greatest value of each `rows` values that follow each other; what is left at the end is no block.
std::vector<double> block_maxima(const std::vector<double>& values, std::size_t rows);

/// m <- m + factor (e - m), from 0: CommandResidualMonitor's means of a flight's errors.
std::vector<double> command_residual_means(const std::vector<double>& errors, double factor);

/// The figures of the rows that have features: `squared_distances`, and `errors`.
detail::TrustSeries trust_series(const AskedModel& model, const detail::JointDistribution& distribution,
                                 const RowSet& rows);

/// The distribution of the training rows, and limits by validation rows that the model was not trained on; each piece
/// of a flight is a flight of its own to the command residual. Throws std::invalid_argument for rows that are too few,
/// and for a limit that could never trigger: the tail of few blocks, continued too far.
FittedTrust fit_trust(const AskedModel& model, const RowSet& training, const RowSet& validation,
                      const FittedTrust::Settings& settings = {});

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/training/structured/impl/trust_limits.hpp"
#endif
