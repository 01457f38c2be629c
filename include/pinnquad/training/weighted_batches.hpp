// SPDX-License-Identifier: MIT
// Batches in which a row comes as often as its weight says: an order for the Trainer, for datasets whose flights differ in weight.
#pragma once

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/core/random.hpp"

namespace pinnquad {

/// Each epoch draws as many rows as there are, row i in expectation n w_i / (w_1 + ... + w_n) times, by systematic resampling:
/// the number of times differs from that by less than one. Then they are shuffled. Without weights (none given, or all alike)
/// it is ShuffledBatches, with its bits.
/// Source of the resampling: Kitagawa, Monte Carlo filter and smoother (1996), with one draw per epoch.
class WeightedBatches {
 public:
  WeightedBatches() = default;
  /// One weight per row of the training data (TrainingData::weights). Throws std::invalid_argument, one line, for a weight that
  /// is no positive number.
  explicit WeightedBatches(std::vector<double> weights) : weights_(std::move(weights)) {
    bool alike = true;
    for (const double weight : weights_) {
      if (!(weight > 0 && std::isfinite(weight))) {
        throw std::invalid_argument("WeightedBatches: expected positive weights, found " + std::to_string(weight));
      }
      alike = alike && weight == weights_.front();
    }
    if (alike) weights_.clear();
  }

  template <class Engine>
  void arrange(std::vector<int>& order, Engine& engine) const {
    if (!weights_.empty()) draw(order, engine);
    shuffle(order, engine);
  }

 private:
  template <class Engine>
  void draw(std::vector<int>& order, Engine& engine) const {
    if (order.size() != weights_.size()) {
      throw std::invalid_argument("WeightedBatches: expected " + std::to_string(order.size()) +
                                  " weights as the data have rows, found " + std::to_string(weights_.size()));
    }
    const double step = std::accumulate(weights_.begin(), weights_.end(), 0.0) / static_cast<double>(weights_.size());
    const double offset = uniform(engine, 0, 1);
    double reached = 0;
    std::size_t drawn = 0;
    for (std::size_t row = 0; row < weights_.size(); ++row) {
      reached += weights_[row];
      while (drawn < order.size() && (static_cast<double>(drawn) + offset) * step < reached) {
        order[drawn++] = static_cast<int>(row);
      }
    }
    for (; drawn < order.size(); ++drawn) order[drawn] = static_cast<int>(weights_.size()) - 1;  // the sum's rounding
  }

  std::vector<double> weights_;
};

}  // namespace pinnquad
