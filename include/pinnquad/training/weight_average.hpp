// SPDX-License-Identifier: MIT
// The mean of the weights that a training goes through, the last ones counting most: what it wanders about in its last
// steps. Less noise than any single step has, and no cost in flight.
#pragma once

#include <cstddef>

#include "pinnquad/data/settings.hpp"

namespace pinnquad {

/// a <- k a + (1 - k) w after each step; k = decay, less in the beginning (n / (n + 10) after n steps), so that where it
/// began is soon forgotten.
template <class NetworkType>
class WeightAverage {
 public:
  using Scalar = typename NetworkType::Scalar;

  /// Throws std::invalid_argument for a decay that is not one of 0 to 1.
  explicit WeightAverage(double decay = 0.995) : decay_(decay) {
    detail::expect_from_zero("WeightAverage::decay", decay);
    if (!(decay < 1)) detail::refuse_setting("WeightAverage::decay", "a number from 0 to below 1", decay);
  }

  void add(const NetworkType& network) noexcept {
    constexpr double soon = 10;
    const double warm = static_cast<double>(steps_) / (static_cast<double>(steps_) + soon);
    const auto keep = static_cast<Scalar>(decay_ < warm ? decay_ : warm);
    for (std::size_t i = 0; i < average_.parameters.size(); ++i) {
      average_.parameters[i] += (Scalar(1) - keep) * (network.parameters[i] - average_.parameters[i]);
    }
    ++steps_;
  }

  /// Zeros before the first step.
  const NetworkType& network() const noexcept { return average_; }
  long steps() const noexcept { return steps_; }

 private:
  double decay_;
  long steps_ = 0;
  NetworkType average_{};
};

}  // namespace pinnquad
