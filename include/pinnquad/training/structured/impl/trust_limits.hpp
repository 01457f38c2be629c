// SPDX-License-Identifier: MIT
// Bodies of trust_limits.hpp.
#pragma once

#include "pinnquad/training/structured/trust_limits.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY JointDistribution fit_joint_distribution(const AskedModel& model, const RowSet& training,
                                                       double shrinkage) {
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

PINNQUAD_BODY double alarm_limit(std::vector<double> maxima, double blocks_per_alarm) {
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

/// Seconds from row to row, over all pieces: all time over all steps, so that no short piece counts for more. 0 where
/// no piece has two rows.
PINNQUAD_BODY double mean_period_s(const RowSet& rows) {
  double lasts_s = 0, steps = 0;
  for (const FlightRows& piece : rows.pieces()) {
    lasts_s += (*piece.flight)[piece.rows.end - 1].time_s - (*piece.flight)[piece.rows.begin].time_s;
    steps += static_cast<double>(piece.rows.size() - 1);
  }
  return steps > 0 ? lasts_s / steps : 0;
}

/// The command residual of a model that is as wrong as commands of 0 to 1 let it be, mean over the rows. A limit above
/// it never triggers.
PINNQUAD_BODY double greatest_command_residual(const RowSet& rows) {
  double sum = 0;
  for (const FlightRows& piece : rows.pieces()) {
    for (std::size_t row = piece.rows.begin; row < piece.rows.end; ++row) {
      for (const double u : (*piece.flight)[row].commands) sum += std::max(u, 1 - u) / rotor_count;
    }
  }
  return sum / static_cast<double>(rows.size());
}

}  // namespace detail

PINNQUAD_BODY std::vector<double> block_maxima(const std::vector<double>& values, std::size_t rows) {
  std::vector<double> maxima;
  for (std::size_t first = 0; rows > 0 && first + rows <= values.size(); first += rows) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    maxima.push_back(*std::max_element(begin, begin + static_cast<std::ptrdiff_t>(rows)));
  }
  return maxima;
}

PINNQUAD_BODY std::vector<double> command_residual_means(const std::vector<double>& errors, double factor) {
  std::vector<double> means;
  double mean = 0;
  for (const double error : errors) means.push_back(mean += factor * (error - mean));
  return means;
}

PINNQUAD_BODY detail::TrustSeries trust_series(const AskedModel& model, const detail::JointDistribution& distribution,
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

PINNQUAD_BODY FittedTrust fit_trust(const AskedModel& model, const RowSet& training, const RowSet& validation,
                                    const FittedTrust::Settings& settings) {
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
