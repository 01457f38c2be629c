// SPDX-License-Identifier: MIT
// Answers made of answers (model/predictor.hpp): a model that is not one network exports, flies and tests itself as one that is.
// A ridge or any other affine map is Network<Scalar, InputSize<n>, Dense<m>>. Parameters of the parts stand one after the other.
#pragma once

#include "pinnquad/core/first_of.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/features/read_features.hpp"
#include "pinnquad/model/description.hpp"
#include "pinnquad/model/predictor.hpp"
#include "pinnquad/nn/jacobian.hpp"

namespace pinnquad {

inline namespace PINNQUAD_INSTRUCTION_SET {

/// y = answer(x) and dy/dx.
template <class Answer>
PINNQUAD_ALWAYS_INLINE void answer_jacobian(const typename Answer::Scalar* parameters, const typename Answer::Scalar* x,
                                            typename Answer::Scalar* y, typename Answer::Scalar* by_x) noexcept {
  if constexpr (is_network<Answer>) {
    JacobianPass<Answer>::run(parameters, x, y, by_x);
  } else {
    Answer::jacobian(parameters, x, y, by_x);
  }
}

/// What the compositions have in common: sizes, and parameters of their own.
template <class Derived, class ScalarType, int InputCount, int OutputCount, int ParameterCount>
struct PredictorBase {
  using Scalar = ScalarType;
  static constexpr int inputs = InputCount;
  static constexpr int outputs = OutputCount;
  static constexpr int parameter_count = ParameterCount;
  using Parameters = std::array<Scalar, static_cast<std::size_t>(ParameterCount)>;

  Parameters parameters{};

  PINNQUAD_ALWAYS_INLINE void forward(const Scalar* x, Scalar* y) const noexcept {
    Derived::forward(detail::first_of<Scalar>(parameters), x, y);
  }
};

/// The sum of two answers: an affine map and a network, a formula and its residual.
template <class First, class Second>
struct Sum : PredictorBase<Sum<First, Second>, typename First::Scalar, First::inputs, First::outputs,
                           First::parameter_count + Second::parameter_count> {
  static_assert(is_predictor<First> && is_predictor<Second>, "pinnquad: a Sum is of two answers (model/predictor.hpp)");
  static_assert(First::inputs == Second::inputs && First::outputs == Second::outputs &&
                    std::is_same_v<typename First::Scalar, typename Second::Scalar>,
                "pinnquad: the two answers of a Sum differ in inputs, outputs or Scalar");
  using Scalar = typename First::Scalar;
  using Sum::PredictorBase::forward;

  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    Second::forward(parameters + First::parameter_count, x, y);
    add_first(parameters, x, y);
  }
  static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept {
    Scalar other[Second::outputs], slopes[Second::outputs * Second::inputs];
    answer_jacobian<First>(parameters, x, y, by_x);
    answer_jacobian<Second>(parameters + First::parameter_count, x, static_cast<Scalar*>(other),
                            static_cast<Scalar*>(slopes));
    for (int i = 0; i < Second::outputs; ++i) y[i] += other[i];
    for (int i = 0; i < Second::outputs * Second::inputs; ++i) by_x[i] += slopes[i];
  }

 private:
  /// Out of line: its numbers are not on the stack beside a second answer that needs much of it.
  static PINNQUAD_NOINLINE void add_first(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    Scalar one[First::outputs];
    First::forward(parameters, x, static_cast<Scalar*>(one));
    for (int i = 0; i < First::outputs; ++i) y[i] += one[i];
  }
};

/// The mean of `Count` answers of one kind.
template <class Member, int Count>
struct Ensemble : PredictorBase<Ensemble<Member, Count>, typename Member::Scalar, Member::inputs, Member::outputs,
                                Count * Member::parameter_count> {
  static_assert(is_predictor<Member> && Count > 0,
                "pinnquad: an Ensemble is of one answer or more (model/predictor.hpp)");
  using Scalar = typename Member::Scalar;
  using Ensemble::PredictorBase::forward;

  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    for (int i = 0; i < Member::outputs; ++i) y[i] = Scalar(0);
    for (int member = 0; member < Count; ++member) {
      Scalar one[Member::outputs];
      Member::forward(parameters + member * Member::parameter_count, x, static_cast<Scalar*>(one));
      for (int i = 0; i < Member::outputs; ++i) y[i] += one[i] / Scalar(Count);
    }
  }
  static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept {
    constexpr int size = Member::outputs * Member::inputs;
    for (int i = 0; i < Member::outputs; ++i) y[i] = Scalar(0);
    for (int i = 0; i < size; ++i) by_x[i] = Scalar(0);
    for (int member = 0; member < Count; ++member) {
      Scalar one[Member::outputs], slopes[size];
      answer_jacobian<Member>(parameters + member * Member::parameter_count, x, static_cast<Scalar*>(one),
                              static_cast<Scalar*>(slopes));
      for (int i = 0; i < Member::outputs; ++i) y[i] += one[i] / Scalar(Count);
      for (int i = 0; i < size; ++i) by_x[i] += slopes[i] / Scalar(Count);
    }
  }
};

/// Answers to the same inputs side by side: the outputs of the first head, then those of the next.
template <class... Part>
struct Heads;
template <class First, class... More>
struct Heads<First, More...>
    : PredictorBase<Heads<First, More...>, typename First::Scalar, First::inputs,
                    (First::outputs + ... + More::outputs), (First::parameter_count + ... + More::parameter_count)> {
  static_assert((is_predictor<First> && ... && is_predictor<More>),
                "pinnquad: Heads are answers (model/predictor.hpp)");
  static_assert(((First::inputs == More::inputs && std::is_same_v<typename First::Scalar, typename More::Scalar>)&&...),
                "pinnquad: Heads differ in inputs or Scalar");
  using Scalar = typename First::Scalar;
  using Heads::PredictorBase::forward;

  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    First::forward(parameters, x, y);
    if constexpr (sizeof...(More) > 0) {
      Heads<More...>::forward(parameters + First::parameter_count, x, y + First::outputs);
    }
  }
  static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept {
    answer_jacobian<First>(parameters, x, y, by_x);
    if constexpr (sizeof...(More) > 0) {
      Heads<More...>::jacobian(parameters + First::parameter_count, x, y + First::outputs,
                               by_x + First::outputs * First::inputs);
    }
  }
};

/// `Second` of what `First` gave: a network of several heads is Then<Network<...>, Heads<...>>, a trunk and what grows on it.
template <class First, class Second>
struct Then : PredictorBase<Then<First, Second>, typename First::Scalar, First::inputs, Second::outputs,
                            First::parameter_count + Second::parameter_count> {
  static_assert(is_predictor<First> && is_predictor<Second>, "pinnquad: Then is of two answers (model/predictor.hpp)");
  static_assert(First::outputs == Second::inputs && std::is_same_v<typename First::Scalar, typename Second::Scalar>,
                "pinnquad: the second answer of a Then takes what the first one gives, in the same Scalar");
  using Scalar = typename First::Scalar;
  using Then::PredictorBase::forward;

  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    Scalar between[First::outputs];
    First::forward(parameters, x, static_cast<Scalar*>(between));
    Second::forward(parameters + First::parameter_count, static_cast<const Scalar*>(between), y);
  }
  static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept {
    Scalar between[First::outputs], inner[First::outputs * First::inputs], outer[Second::outputs * Second::inputs];
    answer_jacobian<First>(parameters, x, static_cast<Scalar*>(between), static_cast<Scalar*>(inner));
    answer_jacobian<Second>(parameters + First::parameter_count, static_cast<const Scalar*>(between), y,
                            static_cast<Scalar*>(outer));
    for (int i = 0; i < Second::outputs; ++i) {
      for (int k = 0; k < First::inputs; ++k) {
        Scalar sum = Scalar(0);
        for (int j = 0; j < First::outputs; ++j) sum += outer[i * First::outputs + j] * inner[j * First::inputs + k];
        by_x[i * First::inputs + k] = sum;
      }
    }
  }
};

/// An answer that takes and gives physical units as a part of one: its scalers are parameters before its own, as means and
/// spreads of inputs, then of outputs.
template <class Inner>
struct Scaled : PredictorBase<Scaled<Inner>, typename Inner::Scalar, Inner::inputs, Inner::outputs,
                              2 * (Inner::inputs + Inner::outputs) + Inner::parameter_count> {
  static_assert(is_predictor<Inner>, "pinnquad: Scaled is of an answer (model/predictor.hpp)");
  using Scalar = typename Inner::Scalar;
  using Scaled::PredictorBase::forward;
  static constexpr int input_mean = 0;  ///< where they stand among the parameters
  static constexpr int input_spread = Inner::inputs;
  static constexpr int output_mean = 2 * Inner::inputs;
  static constexpr int output_spread = output_mean + Inner::outputs;
  static constexpr int own = output_spread + Inner::outputs;

  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    Scalar z[Inner::inputs];
    for (int i = 0; i < Inner::inputs; ++i) z[i] = (x[i] - parameters[i]) / parameters[input_spread + i];
    Inner::forward(parameters + own, static_cast<const Scalar*>(z), y);
    for (int i = 0; i < Inner::outputs; ++i) y[i] = y[i] * parameters[output_spread + i] + parameters[output_mean + i];
  }
  static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept {
    Scalar z[Inner::inputs];
    for (int i = 0; i < Inner::inputs; ++i) z[i] = (x[i] - parameters[i]) / parameters[input_spread + i];
    answer_jacobian<Inner>(parameters + own, static_cast<const Scalar*>(z), y, by_x);
    for (int i = 0; i < Inner::outputs; ++i) {
      y[i] = y[i] * parameters[output_spread + i] + parameters[output_mean + i];
      for (int k = 0; k < Inner::inputs; ++k) {
        by_x[i * Inner::inputs + k] *= parameters[output_spread + i] / parameters[input_spread + k];
      }
    }
  }
};

/// A formula that gives commands of `InputCount` features in physical units, for a vehicle: a Base of
/// outputs/residual_outputs.hpp with a `description`. One parameter: the share of it that counts.
template <class ScalarType, int InputCount, class Formula, class Vehicle>
struct Analytic
    : PredictorBase<Analytic<ScalarType, InputCount, Formula, Vehicle>, ScalarType, InputCount, rotor_count, 1> {
  static_assert(detail::SaysWhatItReads<Formula>::value,
                "pinnquad: a base says which features it reads, by name: `reads` (outputs/residual_outputs.hpp)");
  using Scalar = ScalarType;
  using Analytic::PredictorBase::forward;

  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    constexpr auto prepared = Formula::prepare(airframe_value<Vehicle, Scalar>());
    Formula::commands(x, prepared, y);
    for (int i = 0; i < rotor_count; ++i) y[i] *= parameters[0];
  }
  static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept {
    constexpr auto prepared = Formula::prepare(airframe_value<Vehicle, Scalar>());
    forward(parameters, x, y);
    for (int i = 0; i < rotor_count * InputCount; ++i) by_x[i] = Scalar(0);
    Formula::template slopes<InputCount>(x, prepared, by_x);
    for (int i = 0; i < rotor_count * InputCount; ++i) by_x[i] *= parameters[0];
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

namespace detail {

template <class... Part>
struct FormulasOfAll {
  static constexpr bool read(const NamedFeatures& features) noexcept {
    return (FormulasOf<Part>::read(features) && ...);
  }
};
template <class First, class Second>
struct FormulasOf<Sum<First, Second>> : FormulasOfAll<First, Second> {};
template <class Member, int Count>
struct FormulasOf<Ensemble<Member, Count>> : FormulasOf<Member> {};
template <class... Part>
struct FormulasOf<Heads<Part...>> : FormulasOfAll<Part...> {};
/// The second is asked what the first one said.
template <class First, class Second>
struct FormulasOf<Then<First, Second>> : FormulasOf<First> {};
template <class Inner>
struct FormulasOf<Scaled<Inner>> : FormulasOf<Inner> {};
template <class Scalar, int InputCount, class Formula, class Vehicle>
struct FormulasOf<Analytic<Scalar, InputCount, Formula, Vehicle>> {
  static constexpr bool read(const NamedFeatures& features) noexcept { return reads_of<Formula>(features); }
};

}  // namespace detail

template <class First, class Second>
struct Description<Sum<First, Second>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    detail::describe_list<First, Second>(sink, "pinnquad::Sum");
  }
};
template <class Inner>
struct Description<Scaled<Inner>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    detail::describe_list<Inner>(sink, "pinnquad::Scaled");
  }
};
template <class... Part>
struct Description<Heads<Part...>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    detail::describe_list<Part...>(sink, "pinnquad::Heads");
  }
};
template <class First, class Second>
struct Description<Then<First, Second>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    detail::describe_list<First, Second>(sink, "pinnquad::Then");
  }
};
template <class Member, int Count>
struct Description<Ensemble<Member, Count>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    detail::describe_sized(sink, "pinnquad::Ensemble", Count);
    detail::describe_list<Member>(sink, "");
  }
};
template <class Scalar, int InputCount, class Formula, class Vehicle>
struct Description<Analytic<Scalar, InputCount, Formula, Vehicle>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    detail::describe_sized(sink, "pinnquad::Analytic", InputCount);
    detail::describe_list<Scalar, Formula>(sink, "");
    sink.add(std::string_view(Vehicle::name));
  }
};

}  // namespace pinnquad
