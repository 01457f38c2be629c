// SPDX-License-Identifier: MIT
// A choice written once for one scalar and for the lanes of several (core/lanes.hpp): a comparison of scalars is a
// bool, one of lanes a mask, and select() chooses by either. A branch asks any_of() or all_of() whether it is taken.
#pragma once

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/status.hpp"

namespace pinnquad {

namespace detail {
/// Types that go with a scalar: its comparisons, time, refusals. Those of lanes have a value per lane.
template <class Scalar>
struct LaneTypes {
  using Mask = bool;
  using Wide = double;
  using Outcome = Status;
};
}  // namespace detail

/// Result of a comparison: bool, or one truth per lane.
template <class Scalar>
using Mask = typename detail::LaneTypes<Scalar>::Mask;

/// Time: double also beside float, in which a millisecond is lost after a few hours.
template <class Scalar>
using Wide = typename detail::LaneTypes<Scalar>::Wide;

/// Status, or one per lane.
template <class Scalar>
using Outcome = typename detail::LaneTypes<Scalar>::Outcome;

/// condition ? yes : no; both are worked out. Of lanes each takes its own.
template <class Value>
PINNQUAD_ALWAYS_INLINE constexpr Value select(bool condition, const Value& yes, const Value& no) noexcept {
  return condition ? yes : no;
}

/// True where one lane is.
PINNQUAD_ALWAYS_INLINE constexpr bool any_of(bool condition) noexcept { return condition; }
/// True where all lanes are.
PINNQUAD_ALWAYS_INLINE constexpr bool all_of(bool condition) noexcept { return condition; }

namespace detail {
/// The first fault stays: `status`, or `fault` where that is ok and the condition is true.
template <class Result, class Condition, class Fault>
PINNQUAD_ALWAYS_INLINE constexpr Result refused_where(const Condition& condition, const Fault& fault,
                                                      const Result& status) noexcept {
  return select(condition && status == Status::ok, Result(fault), status);
}
}  // namespace detail

}  // namespace pinnquad
