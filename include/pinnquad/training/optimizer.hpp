// SPDX-License-Identifier: MIT
// The contract of an optimiser: `Step begin(long step, double done) const` once per batch, then per layer
//   template <class Pack> void update(const Step&, Scalar* parameters, const Scalar* gradient, Scalar* first,
//                                     Scalar* second, int count) const noexcept;
// on whole packs; `first` and `second` are the optimiser's to keep. Steps count from 1; done = share of all steps taken
// before this one, 0 <= done < 1.
#pragma once

#include <type_traits>
#include <utility>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/nn/kernel/pack_generic.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/schedule/settings.hpp"

namespace pinnquad {

namespace detail {
template <class T>
using StepOf = decltype(std::declval<const T&>().begin(1L, 0.0));
template <class T>
using UpdateOf = std::enable_if_t<noexcept(std::declval<const T&>().template update<GenericPack<double, 4>>(
    std::declval<const StepOf<T>&>(), static_cast<double*>(nullptr), static_cast<const double*>(nullptr),
    static_cast<double*>(nullptr), static_cast<double*>(nullptr), 4))>;
template <class T>
using LearningRateOf = decltype(std::declval<T&>().learning_rate *= 0.5);
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class T>
inline constexpr bool is_optimizer = is_detected<detail::UpdateOf, T>;

/// An optimiser whose learning rate follows a rate over the training: `Scheduled<AdamW, CosineDecay>`.
/// Step t of T (from 0) is the optimiser's with learning_rate * rate.factor(t / T) in place of learning_rate, in
/// begin() and in update(); t / T is the Trainer's Progress.
template <class Optimizer, class Rate>
struct Scheduled {
  static_assert(
      is_optimizer<Optimizer>,
      "pinnquad: Scheduled's first argument is not an optimiser; it needs begin() and update() const noexcept "
      "(training/optimizer.hpp)");
  static_assert(is_rate<Rate>,
                "pinnquad: Scheduled's second argument is not a rate; it needs factor(done) const noexcept "
                "(schedule/schedule.hpp)");
  static_assert(is_detected<detail::LearningRateOf, Optimizer>,
                "pinnquad: Scheduled's first argument has no member learning_rate that a rate could scale");
  Optimizer optimizer{};
  Rate rate{};

  /// The optimiser as it is in this step, and the result of its own begin().
  struct Step {
    Optimizer now;
    detail::StepOf<Optimizer> step;
  };
  Step begin(long t, double done) const {
    Optimizer now = optimizer;
    now.learning_rate *= rate.factor(done);
    return {now, now.begin(t, done)};
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
