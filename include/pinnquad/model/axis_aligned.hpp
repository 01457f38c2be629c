// SPDX-License-Identifier: MIT
// A monotone model: an affine part, and a residual that is not shown the angular accelerations, three features in a row
// per tap, on which its outputs then cannot depend. Outputs are axis commands (outputs/axis_command_outputs.hpp). The
// affine command about an axis depends on the angular acceleration about that axis and on no other one; the collective
// depends on none. With slopes above 0 each axis command rises with the acceleration that is asked about its axis.
//   y_0 = b_0 + w_0 r,  y_axis = b_axis + w_axis r + sum over taps of slope_(tap,axis) wdot_(tap,axis)
// r: all features but the angular accelerations.
#pragma once

#include <cstddef>
#include <utility>

#include "pinnquad/features/windowed.hpp"
#include "pinnquad/model/predictor.hpp"

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Features split in two: three in a row from each of the places `First...`, ascending, and the others.
template <int FeatureCount, int... First>
struct Triples {
  static constexpr int count = int(sizeof...(First));
  static constexpr int others = FeatureCount - 3 * count;

  /// True where no three overlap and all are features.
  static constexpr bool fit() noexcept {
    int end = 0;
    bool fits = true;
    ((fits = fits && First >= end, end = First + 3), ...);
    return fits && end <= FeatureCount;
  }
  /// Calls `visit(feature, n)` for the n-th of the others.
  template <class Visit>
  static PINNQUAD_ALWAYS_INLINE constexpr void each_other(const Visit& visit) noexcept {
    int feature = 0, n = 0;
    const auto until = [&](int end) PINNQUAD_INLINE_LAMBDA {
      for (; feature < end; ++feature) visit(feature, n++);
      feature += 3;
    };
    (until(First), ...);
    until(FeatureCount);
  }
  /// Copies the others of `x`.
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void copy_others(const Scalar* x, Scalar* others_of_x) noexcept {
    each_other([&](int feature, int n) PINNQUAD_INLINE_LAMBDA { others_of_x[n] = x[feature]; });
  }
  /// Place in X of the n-th of the others.
  static PINNQUAD_ALWAYS_INLINE constexpr int other(int n) noexcept {
    ((n += n >= First ? 3 : 0), ...);
    return n;
  }
  /// The others of `x`, read where they stand.
  template <class Scalar>
  struct InPlace {
    const Scalar* x;
    PINNQUAD_ALWAYS_INLINE Scalar operator[](int n) const noexcept { return x[other(n)]; }
    /// For a PackedNetwork: where the n-th stands, and whether the next one stands behind it.
    PINNQUAD_ALWAYS_INLINE const Scalar* at(int n) const noexcept { return x + other(n); }
    static constexpr bool adjoins_next(int n) noexcept { return other(n + 1) == other(n) + 1; }
  };
  /// Calls `visit(place, n)` for the n-th three.
  template <class Visit>
  static PINNQUAD_ALWAYS_INLINE constexpr void each(const Visit& visit) noexcept {
    int n = 0;
    ((visit(First, n), ++n), ...);
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// `Inner` is shown all features but the threes from `First...` on. Parameters: those of `Inner`.
template <class Inner, int FeatureCount, int... First>
struct Masked : detail::PredictorBase<Masked<Inner, FeatureCount, First...>, typename Inner::Scalar, FeatureCount,
                                      Inner::outputs, Inner::parameter_count> {
  using Threes = detail::Triples<FeatureCount, First...>;
  static_assert(is_predictor<Inner>, "pinnquad: Masked is around a predictor (model/predictor.hpp)");
  static_assert(Threes::fit(), "pinnquad: Masked features are in threes, ascending, and do not overlap");
  static_assert(Inner::inputs == Threes::others,
                "pinnquad: a predictor inside Masked takes all features that are not masked");
  using Scalar = typename Inner::Scalar;
  using Masked::PredictorBase::forward;
  static constexpr detail::TemplateText<Inner, detail::Number<FeatureCount>, detail::Number<First>...> description{
      "pinnquad::Withheld"};

  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    if constexpr (is_network<Inner>) {
      detail::PortablePass<Inner>::forward_of(parameters, typename Threes::template InPlace<Scalar>{x}, y);
    } else {
      Scalar seen[Threes::others];
      Threes::copy_others(x, static_cast<Scalar*>(seen));
      Inner::forward(parameters, static_cast<const Scalar*>(seen), y);
    }
  }
  static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept {
    Scalar seen[Threes::others], by_seen[Inner::outputs * Threes::others];
    Threes::copy_others(x, static_cast<Scalar*>(seen));
    predictor_jacobian<Inner>(parameters, static_cast<const Scalar*>(seen), y, static_cast<Scalar*>(by_seen));
    for (int i = 0; i < Inner::outputs * FeatureCount; ++i) by_x[i] = Scalar(0);
    Threes::each_other([&](int feature, int n) PINNQUAD_INLINE_LAMBDA {
      for (int i = 0; i < Inner::outputs; ++i) by_x[i * FeatureCount + feature] = by_seen[i * Threes::others + n];
    });
  }

  /// `Inner` on the vector unit; a network reads its inputs where they stand.
  class Packed {
   public:
    constexpr void assign(const Scalar* parameters) noexcept { inner_.assign(parameters); }
    PINNQUAD_ALWAYS_INLINE void forward(const Scalar* x, Scalar* y) const noexcept {
      if constexpr (is_network<Inner>) {
        inner_.forward_of(typename Threes::template InPlace<Scalar>{x}, y);
      } else {
        Scalar seen[Threes::others];
        Threes::copy_others(x, static_cast<Scalar*>(seen));
        inner_.forward(static_cast<const Scalar*>(seen), y);
      }
    }
    bool finite() const noexcept { return inner_.finite(); }

   private:
    detail::PackedPredictor<Inner> inner_;
  };
};

/// `First...`: place of the angular acceleration of each tap, that of the present first. Parameters: slopes tap by tap,
/// axis by axis; weights of the other features row by row; intercepts.
template <class ScalarType, int FeatureCount, int... First>
struct AxisAligned
    : detail::PredictorBase<AxisAligned<ScalarType, FeatureCount, First...>, ScalarType, FeatureCount, 4,
                            3 * int(sizeof...(First)) + 4 * (FeatureCount - 3 * int(sizeof...(First))) + 4> {
  using Threes = detail::Triples<FeatureCount, First...>;
  static_assert(Threes::fit() && Threes::count > 0 && Threes::others > 0,
                "pinnquad: the angular accelerations of AxisAligned are features in threes, ascending, and not all");
  using Scalar = ScalarType;
  using AxisAligned::PredictorBase::forward;
  static constexpr detail::TemplateText<Scalar, detail::Number<FeatureCount>, detail::Number<First>...> description{
      "pinnquad::AxisAligned"};
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
    copy_slopes(parameters, by_x);
  }

  /// A layer of all features: most of its slopes by the angular accelerations are 0, and add nothing.
  class Packed : PackedNetwork<Network<Scalar, InputSize<FeatureCount>, Dense<4>>> {
    using Layer = PackedNetwork<Network<Scalar, InputSize<FeatureCount>, Dense<4>>>;

   public:
    using Layer::finite;
    using Layer::forward;
    constexpr void assign(const Scalar* parameters) noexcept {
      Scalar all[static_cast<std::size_t>(4 * FeatureCount + 4)] = {};
      copy_slopes(parameters, all);
      for (int i = 0; i < 4; ++i) all[4 * FeatureCount + i] = parameters[intercepts + i];
      Layer::assign(all);
    }
  };

 private:
  /// dy/dx, row-major.
  static PINNQUAD_ALWAYS_INLINE constexpr void copy_slopes(const Scalar* parameters, Scalar* by_x) noexcept {
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

/// The base and what is added to it: `Residual`, a predictor of residual_inputs<Features> features, between bounds;
/// monotone in each axis' angular acceleration where the slopes are above 0, whatever its other weights are. For
/// AxisCommandOutputs; exported/certificate.hpp says what is proven of it.
template <class Features, class Residual>
using MonotonePredictor = Sum<MonotoneBase<Features, typename Residual::Scalar>,
                              typename detail::MonotoneParts<Features>::template Bound<Residual>>;

}  // namespace pinnquad
