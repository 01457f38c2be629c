// SPDX-License-Identifier: MIT
// Where the training rows lie, all features taken together: their mean, and the factor that makes their covariance the
// identity. What inference/joint_distance.hpp measures by in flight.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

#include "pinnquad/regression/symmetric_system.hpp"
#include "pinnquad/training/training_data.hpp"

namespace pinnquad {

/// Share of the covariance that is replaced by independent features of the same spread. Features that go together in
/// all rows (one a linear map of others) leave it without an inverse; with this share no eigenvalue of the correlations
/// is below it, so that a float's rounding stays below a hundredth of a deviation, and what breaks such a rule by a
/// deviation is 30 deviations away.
inline constexpr double usual_shrinkage = 1e-3;

template <int Size>
struct JointDistribution {
  static constexpr std::size_t factor_size = std::size_t(Size) * (std::size_t(Size) + 1) / 2;
  std::array<double, std::size_t(Size)> mean{};  ///< physical units
  std::array<double, factor_size> whitening{};   ///< of x - mean; lower triangular, column after column

  /// As the flight side works it out; of its training rows the mean is about Size.
  template <class Scalar>
  double squared_distance(const std::array<Scalar, std::size_t(Size)>& x) const noexcept {
    std::array<double, std::size_t(Size)> white{};
    std::size_t at = 0;
    for (std::size_t j = 0; j < x.size(); ++j) {
      for (std::size_t i = j; i < x.size(); ++i) white[i] += whitening[at++] * (static_cast<double>(x[j]) - mean[j]);
    }
    double squared = 0;
    for (const double w : white) squared += w * w;
    return squared;
  }
};

/// Of the rows that have features. A feature that stands still is independent of the others, with the spread 1 that the
/// scalers give it. Throws std::invalid_argument for a share outside (0, 1] or too small, and for no more rows than
/// features.
template <class Features>
JointDistribution<Features::size> fit_joint_distribution(const RowSet& training, double shrinkage = usual_shrinkage) {
  constexpr auto size = static_cast<std::size_t>(Features::size);
  if (!(shrinkage > 0 && shrinkage <= 1)) {
    throw std::invalid_argument("joint distribution: expected a shrinkage above 0 and up to 1, found " +
                                std::to_string(shrinkage));
  }
  const auto columns = detail::feature_statistics<Features>(training);
  DynamicMatrix correlation = DynamicMatrix::Zero(Features::size, Features::size);  // its lower triangle
  std::size_t rows = 0;
  each_features<Features, double>(training, [&](const Flight&, std::size_t, const auto& x) {
    ++rows;
    Vector<double, Features::size> z;
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
  const std::optional<DynamicMatrix> factor = whitening_of(correlation);
  if (!factor) {
    throw std::invalid_argument("joint distribution: expected a larger shrinkage, the correlations have no inverse");
  }
  JointDistribution<Features::size> result;
  std::size_t at = 0;
  for (std::size_t j = 0; j < size; ++j) {
    result.mean[j] = columns[j].mean;
    for (std::size_t i = j; i < size; ++i)
      result.whitening[at++] = (*factor)(Eigen::Index(i), Eigen::Index(j)) / columns[j].scale();
  }
  return result;
}

}  // namespace pinnquad
