// SPDX-License-Identifier: MIT
// An optimiser whose learning rate follows a rate policy over the training: `Scheduled<AdamW, CosineDecay>`.
#pragma once

#include "pinnquad/schedule/rate.hpp"
#include "pinnquad/training/optimizer.hpp"

namespace pinnquad {

/// Step t of T (from 0) is taken with learning_rate * rate.factor(t / T); the Trainer's Progress tells t / T.
template <class Optimizer, class Rate>
struct Scheduled {
  static_assert(is_optimizer<Optimizer>,
                "pinnquad: Scheduled's first argument is not an optimiser; it needs begin() and update() "
                "(training/optimizer.hpp)");
  static_assert(is_rate<Rate>,
                "pinnquad: Scheduled's second argument is not a rate; it needs factor(done) (schedule/rate.hpp)");
  Optimizer optimizer{};
  Rate rate{};

  auto begin(long t, double done) const {
    Optimizer now = optimizer;
    now.learning_rate *= rate.factor(done);
    return now.begin(t);
  }
  template <class Pack, class Step, class Scalar>
  void update(const Step& step, Scalar* parameters, const Scalar* gradient, Scalar* first, Scalar* second,
              int count) const noexcept {
    optimizer.template update<Pack>(step, parameters, gradient, first, second, count);
  }
};

}  // namespace pinnquad
