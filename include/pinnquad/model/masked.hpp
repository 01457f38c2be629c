// SPDX-License-Identifier: MIT
// A predictor that is not shown the angular accelerations: three features in a row from each place of a list, one place
// per tap. Its outputs cannot depend on them, whatever its weights are.
#pragma once

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
struct Masked : PredictorBase<Masked<Inner, FeatureCount, First...>, typename Inner::Scalar, FeatureCount,
                              Inner::outputs, Inner::parameter_count> {
  using Threes = detail::Triples<FeatureCount, First...>;
  static_assert(is_predictor<Inner>, "pinnquad: Masked is around a predictor (model/predictor.hpp)");
  static_assert(Threes::fit(), "pinnquad: Masked features are in threes, ascending, and do not overlap");
  static_assert(Inner::inputs == Threes::others,
                "pinnquad: a predictor inside Masked takes all features that are not masked");
  using Scalar = typename Inner::Scalar;
  using Masked::PredictorBase::forward;

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
};

}  // namespace PINNQUAD_INSTRUCTION_SET

namespace detail {

/// The end of a description with numbers in a list: ", number, number, ...>".
template <class Sink, class... Number>
constexpr void describe_numbers(Sink& sink, Number... number) {
  ((sink.add(std::string_view(", ")), sink.add(number)), ...);
  sink.add(std::string_view(">"));
}
}  // namespace detail

template <class Inner, int FeatureCount, int... First>
struct Description<Masked<Inner, FeatureCount, First...>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    sink.add(std::string_view("pinnquad::Withheld<"));
    Description<Inner>::add(sink);
    detail::describe_numbers(sink, FeatureCount, First...);
  }
};

}  // namespace pinnquad
