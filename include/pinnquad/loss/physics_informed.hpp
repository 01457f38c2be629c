// SPDX-License-Identifier: MIT
// Eq. (5): a base loss plus terms, each with a schedule of its own for its weight.
#pragma once

#include <tuple>

#include "pinnquad/loss/local_monotonicity.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/schedule/settings.hpp"

namespace pinnquad {

/// A loss term and the schedule of its weight lambda.
template <class LossType, class ScheduleType>
struct Weighted {
  static_assert(is_loss<LossType>,
                "pinnquad: Weighted's first argument is not a loss; it needs evaluate(context, batch, weight, "
                "gradient) const (loss/loss.hpp)");
  static_assert(is_schedule<ScheduleType>,
                "pinnquad: Weighted's second argument is not a schedule; it needs weight(epoch, epochs) const noexcept "
                "(schedule/schedule.hpp)");
  LossType loss{};
  ScheduleType schedule{};
};

namespace detail {
template <class T>
struct IsWeighted : std::false_type {};
template <class LossType, class ScheduleType>
struct IsWeighted<Weighted<LossType, ScheduleType>> : std::true_type {};
}  // namespace detail

/// L = base + sum_i lambda_i(epoch) L_i. Values and gradients are added in this order: base, first term, second term,
/// ...
template <class Base, class... Terms>
struct PhysicsInformed {
  static_assert(is_loss<Base>,
                "pinnquad: PhysicsInformed's first argument is not a loss; it needs evaluate(context, batch, weight, "
                "gradient) const (loss/loss.hpp)");
  static_assert((detail::IsWeighted<Terms>::value && ...),
                "pinnquad: a term of PhysicsInformed is not Weighted<Loss, Schedule> (loss/physics_informed.hpp)");
  Base base{};
  std::tuple<Terms...> terms{};

  template <class Context, class Batch, class Gradient>
  typename Batch::Scalar evaluate(const Context& context, const Batch& batch, typename Batch::Scalar weight,
                                  Gradient& gradient) const {
    using Scalar = typename Batch::Scalar;
    const auto weighted = [&](const auto& term) {
      const Scalar lambda = Scalar(term.schedule.weight(context.progress.epoch, context.progress.epochs));
      return lambda * term.loss.evaluate(context, batch, weight * lambda, gradient);
    };
    Scalar value = base.evaluate(context, batch, weight, gradient);
    // a comma has an order of evaluation, a plus has none: the terms add to the gradient as they are evaluated
    std::apply([&](const auto&... term) { ((value += weighted(term)), ...); }, terms);
    return value;
  }

  /// Throws std::invalid_argument if a number of the base, a term or a schedule makes no sense.
  constexpr void check() const {
    check_settings(base);
    std::apply([](const auto&... term) { ((check_settings(term.loss), check_settings(term.schedule)), ...); }, terms);
  }
};

/// The paper's loss: Mse and local monotonicity about roll, pitch and yaw under one kind of schedule.
template <class Schedule, class Form = Standardised>
using PaperLoss = PhysicsInformed<Mse, Weighted<LocalMonotonicity<Roll, Form>, Schedule>,
                                  Weighted<LocalMonotonicity<Pitch, Form>, Schedule>,
                                  Weighted<LocalMonotonicity<Yaw, Form>, Schedule>>;

}  // namespace pinnquad
