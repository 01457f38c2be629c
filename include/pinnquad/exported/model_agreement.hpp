// SPDX-License-Identifier: MIT
// Compares what a model says twice: for the compiler (exported/model.hpp), for a block that is opened
// (exported/model_view.hpp) and for the program on the ground. A tolerance is what rounding makes.
#pragma once

#include <cstddef>
#include <limits>
#include <type_traits>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/model/axis_aligned.hpp"

namespace pinnquad {

/// Times that an exported model can state of its clock: a sample period, a lag that was removed. False for NaN.
inline constexpr double longest_clock_s = 4.0;
/// 0 to longest_clock_s.
PINNQUAD_ALWAYS_INLINE constexpr bool is_clock_time(double seconds) noexcept {
  return seconds >= 0.0 && seconds <= longest_clock_s;
}

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

/// Of an answer whose slopes have the signs of its rotors' torques, and whose residual stays between bounds among its
/// parameters: `at` is where they are, lower ones, then upper ones, -1 for a base without a residual. `known`: false
/// where the answer has no such structure, so that a header's word is all there is.
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

/// A stated bound of a residual against the standardised one among the parameters. The writer takes it from the
/// certificate, which rounds outward by 64 roundings of a double, and rounds outward to a Scalar.
template <class Scalar>
constexpr bool same_bound(Scalar stated, Scalar standardised, Scalar deviation) noexcept {
  using Limits = std::numeric_limits<Scalar>;
  const double bound = static_cast<double>(standardised) * static_cast<double>(deviation);
  const double difference = static_cast<double>(stated) - bound;
  constexpr double share = 8 * static_cast<double>(Limits::epsilon()) + 128 * std::numeric_limits<double>::epsilon();
  constexpr double least = 2 * static_cast<double>(Limits::denorm_min());
  const double rounding = share * (bound < 0 ? -bound : bound);
  return (difference < 0 ? -difference : difference) <= rounding + least;
}

/// A stated range of a residual against `bounds` among the parameters, as StatedStructure; read where there is a
/// residual. A pointer into an array that is compared with null is no constant to g++ -fsanitize=undefined.
template <class Scalar>
constexpr bool same_residual_range(const Scalar* lower, const Scalar* upper, bool has_residual, const Scalar* bounds,
                                   const Scalar* output_deviation, std::size_t outputs) noexcept {
  bool same = true;
  for (std::size_t i = 0; i < outputs; ++i) {
    const Scalar least = has_residual ? bounds[i] : Scalar(0);
    const Scalar most = has_residual ? bounds[outputs + i] : Scalar(0);
    same = same && same_bound(lower[i], least, output_deviation[i]) && same_bound(upper[i], most, output_deviation[i]);
  }
  return same;
}

/// A proven sign is the one by which the rotor makes the torque, or 0: nothing is said.
constexpr bool true_slope_sign(int stated, int torque_sign) noexcept { return stated == 0 || stated == torque_sign; }

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
