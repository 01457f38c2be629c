// SPDX-License-Identifier: MIT
// An answer that is not shown some of the features: three in a row from each place of a list, an angular acceleration
// of every tap. What it says can't depend on them, whatever its weights are.
#pragma once

#include "pinnquad/model/composition.hpp"

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Features in threes from the places `First...`, ascending, and the others.
template <int FeatureCount, int... First>
struct Triples {
  static constexpr int count = int(sizeof...(First));
  static constexpr int others = FeatureCount - 3 * count;

  /// No three overlap, all are features.
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
  /// Writes the others of `x` one after the other.
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void copy_others(const Scalar* x, Scalar* others_of_x) noexcept {
    each_other([&](int feature, int n) PINNQUAD_INLINE_LAMBDA { others_of_x[n] = x[feature]; });
  }
  /// The n-th of the others as a feature.
  static PINNQUAD_ALWAYS_INLINE constexpr int other(int n) noexcept {
    ((n += n >= First ? 3 : 0), ...);
    return n;
  }
  /// The others of `x` where they stand, [n] the n-th of them.
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

/// `Inner` of all features but the threes from `First...` on.
template <class Inner, int FeatureCount, int... First>
struct Masked : PredictorBase<Masked<Inner, FeatureCount, First...>, typename Inner::Scalar, FeatureCount,
                             Inner::outputs, Inner::parameter_count> {
  using Threes = detail::Triples<FeatureCount, First...>;
  static_assert(is_predictor<Inner>, "pinnquad: features are Masked of an answer (model/predictor.hpp)");
  static_assert(Threes::fit(), "pinnquad: what is Masked are features in threes, ascending, that do not overlap");
  static_assert(Inner::inputs == Threes::others,
                "pinnquad: an answer from which features are Masked takes all the others");
  using Scalar = typename Inner::Scalar;
  using Masked::PredictorBase::forward;

  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    if constexpr (is_network<Inner>) {
      PortablePass<Inner>::forward_of(parameters, typename Threes::template InPlace<Scalar>{x}, y);
    } else {
      Scalar seen[Threes::others];
      Threes::copy_others(x, static_cast<Scalar*>(seen));
      Inner::forward(parameters, static_cast<const Scalar*>(seen), y);
    }
  }
  static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept {
    Scalar seen[Threes::others], by_seen[Inner::outputs * Threes::others];
    Threes::copy_others(x, static_cast<Scalar*>(seen));
    answer_jacobian<Inner>(parameters, static_cast<const Scalar*>(seen), y, static_cast<Scalar*>(by_seen));
    for (int i = 0; i < Inner::outputs * FeatureCount; ++i) by_x[i] = Scalar(0);
    Threes::each_other([&](int feature, int n) PINNQUAD_INLINE_LAMBDA {
      for (int i = 0; i < Inner::outputs; ++i) by_x[i * FeatureCount + feature] = by_seen[i * Threes::others + n];
    });
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

namespace detail {

/// Asked of the features that are left.
template <class Inner, int FeatureCount, int... First>
struct FormulasOf<Masked<Inner, FeatureCount, First...>> {
  static constexpr bool read(const NamedFeatures& features) noexcept {
    using Threes = Triples<FeatureCount, First...>;
    const char* names[Threes::others]{};
    const char* units[Threes::others]{};
    for (int n = 0; n < Threes::others; ++n) {
      names[n] = features.names[Threes::other(n)];
      units[n] = features.units[Threes::other(n)];
    }
    return FormulasOf<Inner>::read({names, units, Threes::others});
  }
};

/// ", number, number, ...>": what a description of numbers in a list ends with.
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
