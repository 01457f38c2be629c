// SPDX-License-Identifier: MIT
// Adam with coupled weight decay, and AdamW with decoupled weight decay.
// The contract of an optimiser: training/optimizer.hpp.
#pragma once

#include <cmath>

#include "pinnquad/nn/kernel/pack.hpp"
#include "pinnquad/schedule/settings.hpp"

namespace pinnquad {

/// Kingma and Ba 2015; PyTorch's `Adam(weight_decay=...)`.
/// g <- g + decay p;  m <- b1 m + (1 - b1) g;  v <- b2 v + (1 - b2) g^2;
/// p <- p - rate / (1 - b1^t) * m / (sqrt(v) / sqrt(1 - b2^t) + epsilon).
/// The decay applies to weights and biases alike, as in PyTorch.
struct Adam {
  double learning_rate = 1e-3;
  double beta_1 = 0.9;
  double beta_2 = 0.999;
  double epsilon = 1e-8;
  double weight_decay = 1e-5;

  /// Factors that are the same for all parameters of step t (from 1).
  struct Step {
    double rate;        ///< learning_rate / (1 - b1^t)
    double root_scale;  ///< 1 / sqrt(1 - b2^t)
  };
  Step begin(long t, double /*done*/ = 0) const {
    const double n = static_cast<double>(t);
    return {learning_rate / (1.0 - std::pow(beta_1, n)), 1.0 / std::sqrt(1.0 - std::pow(beta_2, n))};
  }

  /// Throws std::invalid_argument unless rate, epsilon and decay are finite numbers from 0 and both betas in [0, 1).
  constexpr void check() const {
    detail::expect_from_zero("Adam::learning_rate", learning_rate);
    detail::expect_from_zero("Adam::epsilon", epsilon);
    detail::expect_from_zero("Adam::weight_decay", weight_decay);
    if (!(beta_1 >= 0.0 && beta_1 < 1.0)) detail::refuse_setting("Adam::beta_1", "0 <= beta_1 < 1", beta_1);
    if (!(beta_2 >= 0.0 && beta_2 < 1.0)) detail::refuse_setting("Adam::beta_2", "0 <= beta_2 < 1", beta_2);
  }

  /// Updates `count` parameters (a multiple of the pack) and both moments in place.
  template <class Pack, class Scalar>
  void update(const Step& step, Scalar* parameters, const Scalar* gradient, Scalar* first, Scalar* second,
              int count) const noexcept {
    const Pack decay = Pack::broadcast(Scalar(weight_decay));
    const Pack b1 = Pack::broadcast(Scalar(beta_1));
    const Pack b2 = Pack::broadcast(Scalar(beta_2));
    const Pack one_less_b1 = Pack::broadcast(Scalar(1.0 - beta_1));
    const Pack one_less_b2 = Pack::broadcast(Scalar(1.0 - beta_2));
    const Pack rate = Pack::broadcast(Scalar(step.rate));
    const Pack root_scale = Pack::broadcast(Scalar(step.root_scale));
    const Pack smallest = Pack::broadcast(Scalar(epsilon));
    for (int i = 0; i < count; i += Pack::width) {
      const Pack p = Pack::load(parameters + i);
      const Pack g = Pack::multiply_add(decay, p, Pack::load(gradient + i));
      const Pack m = Pack::multiply_add(b1, Pack::load(first + i), one_less_b1 * g);
      const Pack v = Pack::multiply_add(b2, Pack::load(second + i), one_less_b2 * (g * g));
      m.store(first + i);
      v.store(second + i);
      const Pack denominator = Pack::multiply_add(Pack::square_root(v), root_scale, smallest);
      (p - rate * m / denominator).store(parameters + i);
    }
  }
};

/// Loshchilov and Hutter 2019; PyTorch's `AdamW`.
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
  Step begin(long t, double /*done*/ = 0) const {
    return {without_decay().begin(t), 1.0 - learning_rate * weight_decay};
  }

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
