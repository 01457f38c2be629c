// SPDX-License-Identifier: MIT
// The library under fast-math semantics, whatever the flags of the build: the pragma stands before pinnquad's header.
#include "core/finite_fast_math.hpp"

#include <cstdint>
#include <cstring>
#include <type_traits>

#if defined(__clang__)
#pragma float_control(precise, off)
#elif defined(__GNUC__)
#pragma GCC optimize("fast-math")
#endif

#include "pinnquad/core/finite.hpp"

namespace pinnquad::test {

bool fast_math_is_finite(float value) { return is_finite(value); }
bool fast_math_is_finite(double value) { return is_finite(value); }
bool fast_math_all_finite(const float* first, int count) { return all_finite(first, count); }
bool fast_math_all_finite(const double* first, int count) { return all_finite(first, count); }

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wfloat-equal"
#endif
bool fast_math_naive_is_number(double value) {
  const double copy = value;
  return copy == value;
}
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

}  // namespace pinnquad::test
