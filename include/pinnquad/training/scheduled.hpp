// SPDX-License-Identifier: MIT
// An optimiser whose learning rate follows a rate policy over the training: `Scheduled<AdamW, CosineDecay>`.
#pragma once

#include "pinnquad/data/settings.hpp"
#include "pinnquad/schedule/rate.hpp"
#include "pinnquad/training/optimizer.hpp"

namespace pinnquad {

namespace detail {
template <class T, class = void>
struct HasLearningRate : std::false_type {};
template <class T>
struct HasLearningRate<T, std::void_t<decltype(std::declval<T&>().learning_rate *= 0.5)>> : std::true_type {};
}  // namespace detail

/// Step t of T (from 0) is taken by the optimiser with learning_rate * rate.factor(t / T) in place of learning_rate, in begin()
/// and in update(); the Trainer's Progress tells t / T.
template <class Optimizer, class Rate>
struct Scheduled {
  static_assert(
      is_optimizer<Optimizer>,
      "pinnquad: Scheduled's first argument is not an optimiser; it needs begin() and update() const noexcept "
      "(training/optimizer.hpp)");
  static_assert(is_rate<Rate>,
                "pinnquad: Scheduled's second argument is not a rate; it needs factor(done) const noexcept "
                "(schedule/rate.hpp)");
  static_assert(detail::HasLearningRate<Optimizer>::value,
                "pinnquad: Scheduled's first argument has no member learning_rate that a rate could scale");
  Optimizer optimizer{};
  Rate rate{};

  /// The optimiser as it is in this step, and what its own begin() gave.
  struct Step {
    Optimizer now;
    typename detail::BeginsStep<Optimizer>::Step step;
  };
  Step begin(long t, double done) const {
    Optimizer now = optimizer;
    now.learning_rate *= rate.factor(done);
    if constexpr (follows_progress<Optimizer>) {
      return {now, now.begin(t, done)};
    } else {
      return {now, now.begin(t)};
    }
  }
  template <class Pack, class Scalar>
  void update(const Step& step, Scalar* parameters, const Scalar* gradient, Scalar* first, Scalar* second,
              int count) const noexcept {
    step.now.template update<Pack>(step.step, parameters, gradient, first, second, count);
  }

  /// Throws std::invalid_argument if a number of the optimiser or of the rate makes no sense.
  constexpr void check() const {
    check_settings(optimizer);
    check_settings(rate);
  }
};

}  // namespace pinnquad
