// SPDX-License-Identifier: MIT
// 9,000 standardised samples of a smooth function, as many as the paper's training block has.
#pragma once

#include <cmath>
#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/training/training_data.hpp"
#include "support/paper_network.hpp"

namespace pinnquad::bench {

using PaperTrainingData = TrainingData<float, PaperNetwork::inputs, PaperNetwork::outputs>;

/// Features are normal, output k is a sine of features k and k + 4: learnable, of unit order.
inline PaperTrainingData smooth_training_set(int samples = 9000, std::uint64_t seed = 3) {
  std::mt19937_64 engine(seed);
  PaperTrainingData data;
  for (int row = 0; row < samples; ++row) {
    PaperInput x{};
    for (float& v : x) v = static_cast<float>(standard_normal(engine));
    data.features.insert(data.features.end(), x.begin(), x.end());
    for (std::size_t k = 0; k < PaperNetwork::outputs; ++k) data.outputs.push_back(std::sin(x[k] + 0.5f * x[k + 4]));
  }
  return data;
}

}  // namespace pinnquad::bench
