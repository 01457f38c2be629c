// SPDX-License-Identifier: MIT
// The part of a model between its scalers: a Network, or anything else that makes outputs of features.
// Contract of a predictor: `Scalar`, `inputs`, `outputs`, `parameter_count`, `Parameters` (one flat array), a member
// `parameters`, a `description` (model/description.hpp), and
//   static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept
//   static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept
// by_x: outputs x inputs, row-major. A Network's Jacobian is JacobianPass (nn/jacobian.hpp). A Network runs on the
// vector unit, any other predictor as it is written, unless it has a class `Packed`, its parameters as the vector unit
// wants them, with assign(parameters), forward(x, y) and finite() of a PackedNetwork (nn/packed_network.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "pinnquad/core/first_of.hpp"
#include "pinnquad/model/description.hpp"
#include "pinnquad/nn/jacobian.hpp"

namespace pinnquad {

namespace detail {
template <class T, class Scalar = typename T::Scalar>
using PredictorMembers =
    std::void_t<typename T::Parameters, decltype(T::inputs), decltype(T::outputs), decltype(T::parameter_count),
                decltype(std::declval<T&>().parameters),
                std::enable_if_t<noexcept(T::forward(std::declval<const Scalar*>(), std::declval<const Scalar*>(),
                                                     std::declval<Scalar*>()))>>;
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file, but for its Jacobian.
template <class T>
inline constexpr bool is_predictor = is_detected<detail::PredictorMembers, T>;

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Sizes and parameters of a predictor that is no Network: its class derives from this one.
template <class Derived, class ScalarType, int InputCount, int OutputCount, int ParameterCount>
struct PredictorBase {
  using Scalar = ScalarType;
  static constexpr int inputs = InputCount;
  static constexpr int outputs = OutputCount;
  static constexpr int parameter_count = ParameterCount;
  using Parameters = std::array<Scalar, static_cast<std::size_t>(ParameterCount)>;

  Parameters parameters{};

  PINNQUAD_ALWAYS_INLINE void forward(const Scalar* x, Scalar* y) const noexcept {
    Derived::forward(first_of<Scalar>(parameters), x, y);
  }
};

/// Where the numbers around a predictor are: its scalers, and the envelope of its training rows.
template <class Scalar>
struct Scales {
  const Scalar* input_mean;
  const Scalar* input_deviation;
  const Scalar* output_mean;
  const Scalar* output_deviation;
  const Scalar* lower;  ///< of the envelope
  const Scalar* upper;
};

/// A predictor inside another one's Packed that has none itself: as it is written.
template <class Predictor>
class AsWritten {
  using Scalar = typename Predictor::Scalar;

 public:
  constexpr void assign(const Scalar* parameters) noexcept {
    for (int i = 0; i < Predictor::parameter_count; ++i) parameters_[i] = parameters[i];
  }
  PINNQUAD_ALWAYS_INLINE void forward(const Scalar* x, Scalar* y) const noexcept {
    Predictor::forward(static_cast<const Scalar*>(parameters_), x, y);
  }
  bool finite() const noexcept { return all_finite(parameters_, Predictor::parameter_count); }

 private:
  Scalar parameters_[static_cast<unsigned>(Predictor::parameter_count)] = {};
};

template <class Predictor, class = void>
struct PackedForm {
  static constexpr bool is_own = false;
  using type = AsWritten<Predictor>;
};
template <class Predictor>
struct PackedForm<Predictor, std::enable_if_t<is_network<Predictor>>> {
  static constexpr bool is_own = true;
  using type = PackedNetwork<Predictor>;
};
template <class Predictor>
struct PackedForm<Predictor, std::void_t<typename Predictor::Packed>> {
  static constexpr bool is_own = true;
  using type = typename Predictor::Packed;
};
/// True for a predictor that the vector unit may run.
template <class Predictor>
inline constexpr bool is_packable = PackedForm<Predictor>::is_own;
/// A predictor as the vector unit wants it.
template <class Predictor>
using PackedPredictor = typename PackedForm<Predictor>::type;

/// A standardised input no further out than its range of the training rows.
template <class Scalar>
constexpr Scalar saturated(const Scales<Scalar>& scales, int input, Scalar standardised) noexcept {
  const Scalar least = (scales.lower[input] - scales.input_mean[input]) / scales.input_deviation[input];
  const Scalar most = (scales.upper[input] - scales.input_mean[input]) / scales.input_deviation[input];
  return standardised < least ? least : (most < standardised ? most : standardised);
}

/// Means and standard deviations of an exported header.
template <class Model>
constexpr Scales<typename Model::Scalar> scales_in_header() noexcept {
  return {Model::input.mean.data(),     Model::input.standard_deviation.data(),
          Model::output.mean.data(),    Model::output.standard_deviation.data(),
          Model::envelope_lower.data(), Model::envelope_upper.data()};
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// y = predictor(x) and dy/dx, both standardised.
template <class Predictor>
PINNQUAD_ALWAYS_INLINE void predictor_jacobian(const typename Predictor::Scalar* parameters,
                                               const typename Predictor::Scalar* x, typename Predictor::Scalar* y,
                                               typename Predictor::Scalar* by_x) noexcept {
  if constexpr (is_network<Predictor>) {
    JacobianPass<Predictor>::run(parameters, x, y, by_x);
  } else {
    Predictor::jacobian(parameters, x, y, by_x);
  }
}

/// The sum of two predictors: an affine base and a residual network. Parameters of the first, then of the second.
template <class First, class Second>
struct Sum : detail::PredictorBase<Sum<First, Second>, typename First::Scalar, First::inputs, First::outputs,
                                   First::parameter_count + Second::parameter_count> {
  static_assert(is_predictor<First> && is_predictor<Second>,
                "pinnquad: a Sum is of two predictors (model/predictor.hpp)");
  static_assert(First::inputs == Second::inputs && First::outputs == Second::outputs &&
                    std::is_same_v<typename First::Scalar, typename Second::Scalar>,
                "pinnquad: the two predictors of a Sum differ in inputs, outputs or Scalar");
  using Scalar = typename First::Scalar;
  using Sum::PredictorBase::forward;
  static constexpr detail::TemplateText<First, Second> description{"pinnquad::Sum"};

  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    Second::forward(parameters + First::parameter_count, x, y);
    add_first(parameters, x, y);
  }
  static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept {
    Scalar other[Second::outputs], slopes[Second::outputs * Second::inputs];
    predictor_jacobian<First>(parameters, x, y, by_x);
    predictor_jacobian<Second>(parameters + First::parameter_count, x, static_cast<Scalar*>(other),
                               static_cast<Scalar*>(slopes));
    for (int i = 0; i < Second::outputs; ++i) y[i] += other[i];
    for (int i = 0; i < Second::outputs * Second::inputs; ++i) by_x[i] += slopes[i];
  }

  /// Both on the vector unit.
  class Packed {
   public:
    constexpr void assign(const Scalar* parameters) noexcept {
      first_.assign(parameters);
      second_.assign(parameters + First::parameter_count);
    }
    PINNQUAD_ALWAYS_INLINE void forward(const Scalar* x, Scalar* y) const noexcept {
      Scalar one[First::outputs];  // first: its chains fill what the network's leave idle
      first_.forward(x, static_cast<Scalar*>(one));
      second_.forward(x, y);
      for (int i = 0; i < First::outputs; ++i) y[i] += one[i];
    }
    bool finite() const noexcept { return first_.finite() && second_.finite(); }

   private:
    detail::PackedPredictor<First> first_;
    detail::PackedPredictor<Second> second_;
  };

 private:
  /// Out of line: its numbers are not on the stack beside a second predictor that needs much of it.
  static PINNQUAD_NOINLINE void add_first(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    Scalar one[First::outputs];
    First::forward(parameters, x, static_cast<Scalar*>(one));
    for (int i = 0; i < First::outputs; ++i) y[i] += one[i];
  }
};

/// y = clip(Inner(x)), output by output: for every input a residual stays between the bounds that it had in training.
/// Parameters: lower bounds, upper bounds, then those of `Inner`. NaN stays NaN.
template <class Inner>
struct Saturated : detail::PredictorBase<Saturated<Inner>, typename Inner::Scalar, Inner::inputs, Inner::outputs,
                                         2 * Inner::outputs + Inner::parameter_count> {
  static_assert(is_predictor<Inner>, "pinnquad: Saturated is around a predictor (model/predictor.hpp)");
  using Scalar = typename Inner::Scalar;
  using Saturated::PredictorBase::forward;
  static constexpr detail::TemplateText<Inner> description{"pinnquad::Bounded"};
  static constexpr int lower = 0;  ///< places among the parameters
  static constexpr int upper = Inner::outputs;
  static constexpr int own = 2 * Inner::outputs;

  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    Inner::forward(parameters + own, x, y);
    clip(parameters, y);
  }
  /// The derivative of an output that is clipped, or on its bound, is 0.
  static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept {
    predictor_jacobian<Inner>(parameters + own, x, y, by_x);
    for (int i = 0; i < Inner::outputs; ++i) {
      if (y[i] > parameters[lower + i] && y[i] < parameters[upper + i]) continue;
      for (int k = 0; k < Inner::inputs; ++k) by_x[i * Inner::inputs + k] = Scalar(0);
    }
    clip(parameters, y);
  }

  /// `Inner` on the vector unit, between the same bounds.
  class Packed {
   public:
    constexpr void assign(const Scalar* parameters) noexcept {
      for (int i = 0; i < own; ++i) bounds_[i] = parameters[i];
      inner_.assign(parameters + own);
    }
    PINNQUAD_ALWAYS_INLINE void forward(const Scalar* x, Scalar* y) const noexcept {
      inner_.forward(x, y);
      clip(bounds_, y);
    }
    bool finite() const noexcept { return all_finite(bounds_, own) && inner_.finite(); }

   private:
    detail::PackedPredictor<Inner> inner_;
    Scalar bounds_[static_cast<std::size_t>(own)] = {};
  };

 private:
  static PINNQUAD_ALWAYS_INLINE void clip(const Scalar* parameters, Scalar* y) noexcept {
    for (int i = 0; i < Inner::outputs; ++i) {
      const Scalar least = parameters[lower + i], most = parameters[upper + i];
      y[i] = y[i] < least ? least : (y[i] > most ? most : y[i]);
    }
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

}  // namespace pinnquad
