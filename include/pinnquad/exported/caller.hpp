// SPDX-License-Identifier: MIT
// What the code that flies a model does with its commands: what they mean to it, how often it asks, in which order its motors
// are. A model of other terms does not compile; a block of other terms does not open.
#pragma once

#include <cstdint>

#include "pinnquad/exported/model.hpp"

namespace pinnquad {

/// A caller that says nothing.
struct AnyCaller {};

/// In place of a period: however often.
struct AnyPeriod {};

/// Commands that mean `Meaning`, for the motors of `VehicleType` in its order, asked for every `PeriodType` (PeriodMicroseconds
/// of features/windowed.hpp, or AnyPeriod). A Shape may name one as its `Caller`: ModelView::open() then asks it.
template <CommandMeaning Meaning, class VehicleType, class PeriodType = AnyPeriod>
struct Caller {
  static_assert(is_airframe<VehicleType>, "pinnquad: a Caller's vehicle is not an airframe (dynamics/airframe.hpp)");
  static constexpr CommandMeaning command_meaning = Meaning;
  using Vehicle = VehicleType;
  using Period = PeriodType;
};

inline namespace PINNQUAD_INSTRUCTION_SET {

/// What a model's numbers mean where it flies. As made, nothing is said.
template <class Scalar>
struct ModelTerms {
  bool stated = false;  ///< false for a block of version 1
  CommandMeaning command_meaning = CommandMeaning::thrust;
  Scalar command_lower = Scalar(0);
  Scalar command_upper = Scalar(1);
  std::uint32_t sample_period_ns = 0;  ///< 0: not said
  std::uint32_t lag_removed_ns = 0;    ///< of the rotors, taken out of the commands before the training
};

}  // namespace PINNQUAD_INSTRUCTION_SET

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

constexpr std::uint32_t nanoseconds(double seconds) noexcept { return static_cast<std::uint32_t>(seconds * 1e9 + 0.5); }

/// The terms of an exported header. One of format 1 or 2 says nothing of them: its commands are those of its vehicle's curves.
template <class M>
constexpr ModelTerms<typename M::Scalar> header_terms() noexcept {
  using Scalar = typename M::Scalar;
  ModelTerms<Scalar> terms{};
  terms.stated = true;
  if constexpr (HasRecords<M>::value) {
    terms.command_meaning = M::command_meaning;
    terms.command_lower = static_cast<Scalar>(M::command_lower);
    terms.command_upper = static_cast<Scalar>(M::command_upper);
    terms.sample_period_ns = nanoseconds(M::sample_period_s);
    terms.lag_removed_ns = nanoseconds(M::lag_removed_s);
  } else {
    terms.command_meaning = command_meaning_of(M::Vehicle::template value<double>());
    terms.sample_period_ns = nanoseconds(WindowOf<typename M::Features>::period_s);
  }
  return terms;
}

template <class Caller>
inline constexpr bool says_something = !std::is_same_v<Caller, AnyCaller>;

/// The period that a caller keeps, 0 for any.
template <class Caller, class = void>
inline constexpr std::uint32_t caller_period_ns = 0;
template <class Caller>
inline constexpr std::uint32_t caller_period_ns<Caller, std::void_t<decltype(Caller::Period::seconds)>> =
    nanoseconds(Caller::Period::seconds);

constexpr bool same_period_ns(std::uint32_t a, std::uint32_t b) noexcept {
  const std::uint32_t difference = a < b ? b - a : a - b;
  return difference <= b / std::uint32_t(1.0 / period_tolerance);
}

template <class S, class = void>
struct CallerOf {
  using type = AnyCaller;
};
template <class S>
struct CallerOf<S, std::void_t<typename S::Caller>> {
  using type = typename S::Caller;
};

/// The caller's motors are the vehicle's, in its order.
template <class CallerType, class Vehicle>
constexpr void require_motor_order() noexcept {
  static_assert(same_signs(motor_torque_signs<Vehicle>(), motor_torque_signs<typename CallerType::Vehicle>()),
                "pinnquad: the caller's motors are in another order than the model's: a rotor sits or turns elsewhere "
                "(exported/caller.hpp)");
}

/// Checks, at compile time and by rule, that a model may be flown by a caller.
template <class Model, class CallerType>
constexpr bool require_caller() noexcept {
  if constexpr (says_something<CallerType>) {
    if constexpr (is_model<Model>) {
      require_motor_order<CallerType, typename Model::Vehicle>();
      constexpr auto terms = header_terms<Model>();
      constexpr std::uint32_t period = caller_period_ns<CallerType>;
      static_assert(terms.command_meaning == CallerType::command_meaning,
                    "pinnquad: the model's commands mean something else to the caller: thrust, pulse width or speed "
                    "(command_meaning)");
      static_assert(period == 0 || same_period_ns(terms.sample_period_ns, period),
                    "pinnquad: the model's sample period is not the caller's, or not said (sample_period_s)");
    } else if constexpr (IsMadeForShape<Model>::value) {
      using Shape = typename Model::Shape;
      require_motor_order<CallerType, typename Shape::Vehicle>();
      if constexpr (is_model<Shape>) require_caller<Shape, CallerType>();  // a block's terms are those of the header
      static_assert(is_model<Shape> || std::is_same_v<typename CallerOf<Shape>::type, CallerType>,
                    "pinnquad: a block flies for the caller that its shape names, so that open() can refuse it: "
                    "`using Caller = ...` in the Shape (exported/caller.hpp)");
    }
  }
  return true;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
