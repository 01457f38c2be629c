// SPDX-License-Identifier: MIT
// Bounds that a model's numbers keep: for the compiler (exported/model.hpp), for a block that is opened
// (exported/model_view.hpp) and for the program on the ground.
#pragma once

#include <cstddef>
#include <type_traits>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/model/axis_aligned.hpp"

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// No row of a training lies further from the mean than this many standard deviations: sqrt(n - 1) at most of n rows
/// (Samuelson), and a block counts them in 32 bits. Twice that, for the margin.
inline constexpr double furthest_deviations = 131072.0;

/// lower <= upper, and both where a training on features of that mean and standard deviation can have been. False for
/// NaN.
template <class Scalar>
constexpr bool is_envelope(const Scalar* mean, const Scalar* deviation, const Scalar* lower, const Scalar* upper,
                           std::size_t size) noexcept {
  bool sound = true;
  for (std::size_t i = 0; i < size; ++i) {
    const double centre = static_cast<double>(mean[i]), magnitude = centre < 0 ? -centre : centre;
    const double reach = furthest_deviations * static_cast<double>(deviation[i]) + magnitude;
    const double below = centre - static_cast<double>(lower[i]), above = static_cast<double>(upper[i]) - centre;
    sound = sound && lower[i] <= upper[i] && below <= reach && above <= reach;
  }
  return sound;
}

/// lower[i] <= x[i] <= upper[i] for all i; false for NaN.
template <class Scalar>
constexpr bool inside_envelope(const Scalar* lower, const Scalar* x, const Scalar* upper, std::size_t size) noexcept {
  bool inside = true;
  for (std::size_t i = 0; i < size; ++i) inside = inside && lower[i] <= x[i] && x[i] <= upper[i];
  return inside;
}

/// A predictor whose base is affine and whose residual stays between bounds among its parameters: `at` is where they
/// are, lower ones, then upper ones, -1 for a base without a residual. `known`: false for any other predictor.
template <class Answer>
struct StatedStructure {
  static constexpr bool known = false;
};
template <class Scalar, int FeatureCount, int... First>
struct StatedStructure<AxisAligned<Scalar, FeatureCount, First...>> {
  static constexpr bool known = true;
  static constexpr int at = -1;
};
template <class Scalar, int FeatureCount, int... First, class Residual>
struct StatedStructure<Sum<AxisAligned<Scalar, FeatureCount, First...>, Saturated<Residual>>> {
  static constexpr bool known = true;
  static constexpr int at = AxisAligned<Scalar, FeatureCount, First...>::parameter_count;
  using Inner = Residual;  ///< its parameters follow the bounds
};

template <class Answer, class = void>
inline constexpr bool has_bounded_residual = false;
template <class Answer>
inline constexpr bool has_bounded_residual<Answer, std::void_t<typename StatedStructure<Answer>::Inner>> = true;

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
