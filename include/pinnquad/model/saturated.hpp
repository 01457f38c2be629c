// SPDX-License-Identifier: MIT
// A predictor whose outputs stay between bounds for every input: a residual is never larger than it was in training.
#pragma once

#include "pinnquad/model/predictor.hpp"

namespace pinnquad {

inline namespace PINNQUAD_INSTRUCTION_SET {

/// y = clip(Inner(x)), output by output. Parameters: lower bounds, upper bounds, then those of `Inner`. NaN stays NaN.
template <class Inner>
struct Saturated : PredictorBase<Saturated<Inner>, typename Inner::Scalar, Inner::inputs, Inner::outputs,
                                 2 * Inner::outputs + Inner::parameter_count> {
  static_assert(is_predictor<Inner>, "pinnquad: Saturated is around a predictor (model/predictor.hpp)");
  using Scalar = typename Inner::Scalar;
  using Saturated::PredictorBase::forward;
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

 private:
  static PINNQUAD_ALWAYS_INLINE void clip(const Scalar* parameters, Scalar* y) noexcept {
    for (int i = 0; i < Inner::outputs; ++i) {
      const Scalar least = parameters[lower + i], most = parameters[upper + i];
      y[i] = y[i] < least ? least : (y[i] > most ? most : y[i]);
    }
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

template <class Inner>
struct Description<Saturated<Inner>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    detail::describe_list<Inner>(sink, "pinnquad::Bounded");
  }
};

}  // namespace pinnquad
