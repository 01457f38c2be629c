// SPDX-License-Identifier: MIT
// The feature vectors that an export is tested with, before it arms: out of the rows that its model was trained on;
// and, of a model whose residual is bounded, beyond each bound, so that a bound that was changed fails the self test.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/training/asked_model.hpp"

namespace pinnquad {
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
