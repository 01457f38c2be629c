// SPDX-License-Identifier: MIT
// The affine part of a monotone model. Outputs are axis commands (outputs/axis_command_outputs.hpp). The command about
// an axis depends on the angular acceleration about that axis and on no other one; the collective depends on none. With
// slopes above 0 each axis command rises with the acceleration that is asked about its axis.
//   y_0 = b_0 + w_0 r,  y_axis = b_axis + w_axis r + sum over taps of slope_(tap,axis) wdot_(tap,axis)
// r: all features but the angular accelerations.
#pragma once

#include <utility>

#include "pinnquad/features/windowed.hpp"
#include "pinnquad/model/masked.hpp"
#include "pinnquad/model/saturated.hpp"

namespace pinnquad {

inline namespace PINNQUAD_INSTRUCTION_SET {

/// `First...`: place of the angular acceleration of each tap, that of the present first. Parameters: slopes tap by tap,
/// axis by axis; weights of the other features row by row; intercepts.
template <class ScalarType, int FeatureCount, int... First>
struct AxisAligned : PredictorBase<AxisAligned<ScalarType, FeatureCount, First...>, ScalarType, FeatureCount, 4,
                                   3 * int(sizeof...(First)) + 4 * (FeatureCount - 3 * int(sizeof...(First))) + 4> {
  using Threes = detail::Triples<FeatureCount, First...>;
  static_assert(Threes::fit() && Threes::count > 0 && Threes::others > 0,
                "pinnquad: the angular accelerations of AxisAligned are features in threes, ascending, and not all");
  using Scalar = ScalarType;
  using AxisAligned::PredictorBase::forward;
  static constexpr int taps = Threes::count;
  static constexpr int slopes = 0;  ///< places among the parameters
  static constexpr int weights = 3 * taps;
  static constexpr int intercepts = weights + 4 * Threes::others;

  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    if constexpr (Threes::others <= detail::held_inputs) {  // read once: no copy on the stack
      detail::multiply_held<4, Threes::others>(parameters + weights, Threes::others, parameters + intercepts,
                                               typename Threes::template InPlace<Scalar>{x}, y,
                                               detail::Activate<void>{});
    } else {
      Scalar seen[Threes::others];
      Threes::copy_others(x, static_cast<Scalar*>(seen));
      multiply_row_major<4, Threes::others>(parameters + weights, parameters + intercepts,
                                            static_cast<const Scalar*>(seen), y);
    }
    Threes::each([&](int place, int tap) PINNQUAD_INLINE_LAMBDA {
      for (int axis = 0; axis < 3; ++axis) {
        y[1 + axis] = multiply_add(parameters[slopes + 3 * tap + axis], x[place + axis], y[1 + axis]);
      }
    });
  }
  static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept {
    forward(parameters, x, y);
    for (int i = 0; i < 4 * FeatureCount; ++i) by_x[i] = Scalar(0);
    Threes::each_other([&](int feature, int n) PINNQUAD_INLINE_LAMBDA {
      for (int i = 0; i < 4; ++i) by_x[i * FeatureCount + feature] = parameters[weights + i * Threes::others + n];
    });
    Threes::each([&](int place, int tap) PINNQUAD_INLINE_LAMBDA {
      for (int axis = 0; axis < 3; ++axis) {
        by_x[(1 + axis) * FeatureCount + place + axis] = parameters[slopes + 3 * tap + axis];
      }
    });
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

template <class Scalar, int FeatureCount, int... First>
struct Description<AxisAligned<Scalar, FeatureCount, First...>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    sink.add(std::string_view("pinnquad::AxisAligned<"));
    Description<Scalar>::add(sink);
    detail::describe_numbers(sink, FeatureCount, First...);
  }
};

namespace detail {

/// Taps at which a feature set has the angular acceleration: the present, and all or none of a window's others.
template <class Features>
constexpr int angular_acceleration_taps() noexcept {
  if constexpr (is_windowed<Features>) {
    if (angular_acceleration_at<Features>(1) >= 0) return Features::Window::taps;
  }
  return 1;
}

/// The parts of a monotone model of a feature set.
template <class Features, class Taps = std::make_integer_sequence<int, angular_acceleration_taps<Features>()>>
struct MonotoneParts;
template <class Features, int... Tap>
struct MonotoneParts<Features, std::integer_sequence<int, Tap...>> {
  static_assert(Features::angular_acceleration >= 0,
                "pinnquad: a model that is monotone in the angular acceleration needs a feature set that holds it");
  template <class Scalar>
  using Base = AxisAligned<Scalar, Features::size, angular_acceleration_at<Features>(Tap)...>;
  template <class Residual>
  using Bound = Saturated<Masked<Residual, Features::size, angular_acceleration_at<Features>(Tap)...>>;
  /// Features that are no angular acceleration.
  static constexpr int others = Features::size - 3 * int(sizeof...(Tap));
};

}  // namespace detail

/// Number of features that the residual is shown: all but the angular accelerations.
template <class Features>
inline constexpr int residual_inputs = detail::MonotoneParts<Features>::others;

/// The affine part, of all features of the set.
template <class Features, class Scalar = float>
using MonotoneBase = typename detail::MonotoneParts<Features>::template Base<Scalar>;

/// The part that is added to it: `Residual`, a predictor of residual_inputs<Features> features, between bounds.
template <class Features, class Residual>
using MonotoneResidual = typename detail::MonotoneParts<Features>::template Bound<Residual>;

/// Both: monotone in each axis' angular acceleration where the slopes are above 0, whatever its other weights are. For
/// AxisCommandOutputs; exported/certificate.hpp says what is proven of it.
template <class Features, class Residual>
using MonotonePredictor = Sum<MonotoneBase<Features, typename Residual::Scalar>, MonotoneResidual<Features, Residual>>;

}  // namespace pinnquad
