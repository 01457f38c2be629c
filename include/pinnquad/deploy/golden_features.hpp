// SPDX-License-Identifier: MIT
// The feature vectors that an export is tested with, before it arms: out of the rows that its model was trained on.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/data/flight_features.hpp"

namespace pinnquad {

/// `count` feature vectors, the first and the last of the rows among them, the rest evenly between: inside the envelope of a model
/// that was trained on these rows. Throws std::invalid_argument where no row has features, or for fewer than two.
template <class Model>
std::vector<typename Model::FeatureVector> golden_features(const RowSet& training, std::size_t count = 8) {
  std::vector<typename Model::FeatureVector> all, golden;
  each_features<typename Model::Features, typename Model::Scalar>(
      training, [&all](const Flight&, std::size_t, const auto& x) { all.push_back(x); });
  if (all.empty()) throw std::invalid_argument("golden_features: expected rows that have features, found none");
  if (count < 2)
    throw std::invalid_argument("golden_features: expected a count from 2, found " + std::to_string(count));
  for (std::size_t i = 0; i < count; ++i) golden.push_back(all[i * (all.size() - 1) / (count - 1)]);
  return golden;
}

}  // namespace pinnquad
