// SPDX-License-Identifier: MIT
// Adam with decoupled weight decay (Loshchilov and Hutter 2019; PyTorch's `AdamW`).
#pragma once

#include "pinnquad/training/adam.hpp"

namespace pinnquad {

/// p <- (1 - learning_rate decay) p, then Adam's step without decay: the decay does not pass through the moments.
/// It applies to all parameters alike, as in PyTorch.
struct AdamW {
  double learning_rate = 1e-3;
  double beta_1 = 0.9;
  double beta_2 = 0.999;
  double epsilon = 1e-8;
  double weight_decay = 1e-2;

  struct Step {
    Adam::Step adam;
    double decay;  ///< 1 - learning_rate decay
  };
  Step begin(long t) const { return {without_decay().begin(t), 1.0 - learning_rate * weight_decay}; }

  /// Throws std::invalid_argument for numbers that Adam refuses too.
  constexpr void check() const {
    without_decay().check();
    detail::expect_from_zero("AdamW::weight_decay", weight_decay);
  }

  /// Updates `count` parameters (a multiple of the pack) and both moments in place.
  template <class Pack, class Scalar>
  void update(const Step& step, Scalar* parameters, const Scalar* gradient, Scalar* first, Scalar* second,
              int count) const noexcept {
    const Pack decay = Pack::broadcast(Scalar(step.decay));
    for (int i = 0; i < count; i += Pack::width) (decay * Pack::load(parameters + i)).store(parameters + i);
    without_decay().template update<Pack>(step.adam, parameters, gradient, first, second, count);
  }

 private:
  constexpr Adam without_decay() const noexcept { return {learning_rate, beta_1, beta_2, epsilon, 0.0}; }
};

}  // namespace pinnquad
