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

#include "pinnquad/regression/ridge.hpp"
#include "pinnquad/training/asked_model.hpp"
#include "pinnquad/training/training_data.hpp"

namespace pinnquad {

/// The demands on the two limits, and how fast the command residual's mean forgets.
struct TrustSettings {
  double seconds_per_alarm = 1800;  ///< of calm flight, for each of the two; both together raise twice as many
  double block_s = 10;              ///< alarms less than this apart are one
  double command_residual_factor = 0.2;
  /// Share of the covariance that is replaced by independent features of the same standard deviation. Features that go
  /// together in all rows (one a linear map of others) leave it without an inverse. With this share no eigenvalue of
  /// the correlations is below it: a float's rounding stays below a hundredth of a deviation, and a row that breaks
  /// such a rule by a deviation is 30 deviations away.
  double shrinkage = 1e-3;
};

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

/// Of the rows that have features. A feature that stands still is independent of the others, with the standard
/// deviation 1 that the scalers give it. Throws std::invalid_argument for a share outside (0, 1] or too small, and for
/// no more rows than features.
inline JointDistribution fit_joint_distribution(const AskedModel& model, const RowSet& training,
                                                double shrinkage = TrustSettings{}.shrinkage) {
  const std::size_t size = model.units.size();
  if (!(shrinkage > 0 && shrinkage <= 1)) {
    throw std::invalid_argument("joint distribution: expected a shrinkage above 0 and up to 1, found " +
                                std::to_string(shrinkage));
  }
  const auto columns = feature_statistics(model, training);
  const auto count = static_cast<Eigen::Index>(size);
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Zero(count, count);  // its lower triangle
  std::size_t rows = 0;
  model.each_exact_row(training, [&](const Flight&, std::size_t, const double* x) {
    ++rows;
    Eigen::VectorXd z(count);
    for (std::size_t i = 0; i < size; ++i) z[Eigen::Index(i)] = (x[i] - columns[i].mean) / columns[i].scale();
    correlation.selfadjointView<Eigen::Lower>().rankUpdate(z);
  });
  if (rows <= size) {
    throw std::invalid_argument("joint distribution: expected more rows than the " + std::to_string(size) +
                                " features, found " + std::to_string(rows));
  }
  correlation *= (1 - shrinkage) / static_cast<double>(rows);
  for (std::size_t i = 0; i < size; ++i) {
    double& own = correlation(Eigen::Index(i), Eigen::Index(i));
    own = columns[i].still() ? 1.0 : own + shrinkage;
  }
  const std::optional<Eigen::MatrixXd> factor = whitening_of(correlation);
  if (!factor) {
    throw std::invalid_argument("joint distribution: expected a larger shrinkage, the correlations have no inverse");
  }
  JointDistribution result;
  for (std::size_t j = 0; j < size; ++j) {
    result.mean.push_back(columns[j].mean);
    for (std::size_t i = j; i < size; ++i) {
      result.whitening.push_back((*factor)(Eigen::Index(i), Eigen::Index(j)) / columns[j].scale());
    }
  }
  return result;
}

/// Fewer say nothing of a tail.
inline constexpr std::size_t least_alarm_blocks = 8;

/// A limit that one block in `blocks_per_alarm` exceeds, judged by the maxima of n blocks of the same kind. If a new
/// block is as likely as each of the n to hold any rank among them, it exceeds the k-th greatest with the probability k
/// / (n + 1), whatever the distribution: k = floor((n + 1) / blocks_per_alarm). Where n is too small for k = 1 the tail
/// of the greatest m = max(4, n / 10) maxima is continued as a power law (Weissman 1978, exponent by Hill 1975): a
/// guess, on the side of few alarms where the tail is exponential. Throws std::invalid_argument for fewer than 8 blocks
/// and for maxima that are not above 0.
inline double alarm_limit(std::vector<double> maxima, double blocks_per_alarm) {
  constexpr std::size_t least_tail = 4;
  if (maxima.size() < least_alarm_blocks) {
    throw std::invalid_argument("alarm limit: expected at least " + std::to_string(least_alarm_blocks) +
                                " blocks of rows, found " + std::to_string(maxima.size()));
  }
  std::sort(maxima.begin(), maxima.end(), std::greater<>());
  const auto count = static_cast<double>(maxima.size());
  const double rank = std::floor((count + 1) / blocks_per_alarm);
  if (rank >= 1) return maxima[std::min(maxima.size(), static_cast<std::size_t>(rank)) - 1];
  const std::size_t tail = std::max(least_tail, maxima.size() / 10);
  const double start = maxima[tail];
  if (!(start > 0)) throw std::invalid_argument("alarm limit: expected values above 0");
  double exponent = 0;
  for (std::size_t i = 0; i < tail; ++i) exponent += std::log(maxima[i] / start) / static_cast<double>(tail);
  return start * std::pow(blocks_per_alarm * static_cast<double>(tail) / count, exponent);
}

/// The figures that have limits, row by row.
struct TrustSeries {
  std::vector<double> squared_distances;
  std::vector<double> errors;  ///< mean over the rotors of |command predicted - command flown|
};

/// Seconds from row to row, over all pieces: all time over all steps, so that no short piece counts for more. 0 where
/// no piece has two rows.
inline double mean_period_s(const RowSet& rows) {
  double lasts_s = 0, steps = 0;
  for (const FlightRows& piece : rows.pieces()) {
    lasts_s += (*piece.flight)[piece.rows.end - 1].time_s - (*piece.flight)[piece.rows.begin].time_s;
    steps += static_cast<double>(piece.rows.size() - 1);
  }
  return steps > 0 ? lasts_s / steps : 0;
}

/// The command residual of a model that is as wrong as commands of 0 to 1 let it be, mean over the rows. A limit above
/// it never triggers.
inline double greatest_command_residual(const RowSet& rows) {
  double sum = 0;
  for (const FlightRows& piece : rows.pieces()) {
    for (std::size_t row = piece.rows.begin; row < piece.rows.end; ++row) {
      for (const double u : (*piece.flight)[row].commands) sum += std::max(u, 1 - u) / rotor_count;
    }
  }
  return sum / static_cast<double>(rows.size());
}

}  // namespace detail

/// Limits and what they are limits of; values in double.
struct FittedTrust {
  detail::JointDistribution distribution{};
  double squared_distance_limit = 0;  ///< of the squared distance
  double command_residual_factor = 0;
  double command_residual_limit = 0;
  double command_residual_cleared = 0;  ///< half-way from the usual mean to the limit
  double update_period_s = 0;           ///< of the rows that the command residual was fitted on
};

/// The greatest value of each `rows` values that follow each other; what is left at the end is no block.
inline std::vector<double> block_maxima(const std::vector<double>& values, std::size_t rows) {
  std::vector<double> maxima;
  for (std::size_t first = 0; rows > 0 && first + rows <= values.size(); first += rows) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    maxima.push_back(*std::max_element(begin, begin + static_cast<std::ptrdiff_t>(rows)));
  }
  return maxima;
}

/// m <- m + factor (e - m), from 0: CommandResidualMonitor's means of a flight's errors.
inline std::vector<double> command_residual_means(const std::vector<double>& errors, double factor) {
  std::vector<double> means;
  double mean = 0;
  for (const double error : errors) means.push_back(mean += factor * (error - mean));
  return means;
}

/// The figures of the rows that have features: `squared_distances`, and `errors`.
inline detail::TrustSeries trust_series(const AskedModel& model, const detail::JointDistribution& distribution,
                                        const RowSet& rows) {
  detail::TrustSeries series;
  model.each_row(rows, [&](const Flight& flight, std::size_t row, const double* x) {
    series.squared_distances.push_back(distribution.squared_distance(x));
    const Commands<double> predicted = model.predict(x);
    double error = 0;
    for (std::size_t i = 0; i < rotor_count; ++i)
      error += std::abs(predicted[i] - flight[row].commands[i]) / rotor_count;
    series.errors.push_back(error);
  });
  return series;
}

/// The distribution of the training rows, and limits by validation rows that the model was not trained on; each piece
/// of a flight is a flight of its own to the command residual. Throws std::invalid_argument for rows that are too few,
/// and for a limit that could never trigger: the tail of few blocks, continued too far.
inline FittedTrust fit_trust(const AskedModel& model, const RowSet& training, const RowSet& validation,
                             const TrustSettings& settings = {}) {
  FittedTrust trust;
  trust.distribution = detail::fit_joint_distribution(model, training, settings.shrinkage);
  trust.command_residual_factor = settings.command_residual_factor;
  trust.update_period_s = detail::mean_period_s(validation);
  const auto rows = trust.update_period_s > 0
                        ? static_cast<std::size_t>(std::max(1.0, std::round(settings.block_s / trust.update_period_s)))
                        : std::size_t(1);
  std::vector<double> distances, residuals, usual;
  for (const FlightRows& piece : validation.pieces()) {
    if (piece.rows.size() < 2) continue;
    const auto series = trust_series(model, trust.distribution, RowSet(*piece.flight, piece.rows));
    const std::vector<double> means = command_residual_means(series.errors, settings.command_residual_factor);
    const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(distances, block_maxima(series.squared_distances, rows));
    append(residuals, block_maxima(means, rows));
    append(usual, means);
  }
  const auto text = [](double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.3g", value);
    return std::string(digits);
  };
  const std::string found = text(static_cast<double>(validation.size()) * trust.update_period_s) + " s (" +
                            std::to_string(residuals.size()) + " whole blocks of " + text(settings.block_s) + " s)";
  if (residuals.size() < detail::least_alarm_blocks) {
    throw std::invalid_argument("limits of trust: expected at least " +
                                text(static_cast<double>(detail::least_alarm_blocks) * settings.block_s) +
                                " s of validation rows, found " + found + ": more or longer flights make more");
  }
  const double blocks_per_alarm = settings.seconds_per_alarm / settings.block_s;
  trust.squared_distance_limit = detail::alarm_limit(distances, blocks_per_alarm);
  trust.command_residual_limit = detail::alarm_limit(residuals, blocks_per_alarm);
  const auto require_below = [&](const char* what, double limit, double greatest, const char* of) {
    if (limit < greatest) return;
    throw std::invalid_argument(std::string("limits of trust: expected a limit of the ") + what + " below " +
                                text(greatest) + ", " + of + ", found " + text(limit) + " by validation rows of " +
                                found + ": it could never trigger; more or longer flights make a better one");
  };
  require_below("command residual", trust.command_residual_limit, detail::greatest_command_residual(validation),
                "the most that commands of 0 to 1 can be wrong by");
  require_below("squared distance", trust.squared_distance_limit,
                trust.distribution.greatest_squared_distance(model.envelope_lower, model.envelope_upper),
                "the most within the envelope");
  double sum = 0;
  for (const double mean : usual) sum += mean;
  trust.command_residual_cleared = (sum / static_cast<double>(usual.size()) + trust.command_residual_limit) / 2;
  return trust;
}

}  // namespace pinnquad
