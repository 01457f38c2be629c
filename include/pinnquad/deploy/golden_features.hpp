// SPDX-License-Identifier: MIT
// The feature vectors that an export is tested with, before it arms: out of the rows that its model was trained on;
// and, of a model whose residual is bounded, beyond each bound, so that a bound that was changed fails the self test.
#pragma once

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/training/asked_model.hpp"

namespace pinnquad {
namespace detail {

/// Feature vectors inside the envelope at which a bounded residual would leave its bounds. Deterministic: no number is
/// drawn.
class BoundSearch {
 public:
  using Vector = std::vector<double>;

  explicit BoundSearch(const AskedModel& model) : model_(model), outputs_(model.residual_lower.size()) {}

  /// One vector for each bound that none before it passes, as far as one is found; `most` of them.
  std::vector<Vector> beyond(const std::vector<Vector>& rows, std::size_t most) const;

 private:
  static constexpr double enough = 0.05;  ///< of the residual's range

  bool has_range(std::size_t bound) const;

  /// How far beyond each bound the residual is without it, in shares of its range.
  Vector passed(const Vector& x) const;

  /// The row at which the residual is nearest to the bound.
  Vector nearest(const std::vector<Vector>& rows, std::size_t bound) const;

  /// The search climbs for the bound first, then for the others that no vector passes.
  double height(const Vector& x, std::size_t bound, const std::vector<bool>& missing) const;

  /// From there, one feature after the other to a border of the envelope, the one that gains most first; then back
  /// along the line, as far as no bound that it passes is lost.
  Vector climbed(const Vector& start, std::size_t bound, const std::vector<bool>& missing) const;

  Vector between(const Vector& from, const Vector& to, double share) const;

  const AskedModel& model_;
  std::size_t outputs_;
};

}  // namespace detail

/// `count` feature vectors, inside the envelope of a model that was trained on these rows. Of a model with a bounded
/// residual first those at which it is clipped, all but two at most; then rows, the first and the last among them, the
/// rest evenly between. Throws std::invalid_argument where no row has features, or for fewer than two.
std::vector<std::vector<double>> golden_features(const AskedModel& model, const RowSet& training,
                                                 std::size_t count = 8);
/// Golden features of a model of types.
template <class Model>
std::vector<typename Model::FeatureVector> golden_features(const Model& model, const RowSet& training,
                                                           std::size_t count = 8) {
  std::vector<typename Model::FeatureVector> golden;
  for (const std::vector<double>& x : golden_features(AskedModel(model), training, count)) {
    golden.push_back(detail::as_features<typename Model::FeatureVector>(x.data()));
  }
  return golden;
}

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/golden_features.hpp"
#endif
