// SPDX-License-Identifier: MIT
// Functions of a translation unit that is compiled as with -ffast-math (finite_fast_math.cpp).
#pragma once

namespace pinnquad::test {

bool fast_math_is_finite(float value);
bool fast_math_is_finite(double value);
bool fast_math_all_finite(const float* first, int count);
bool fast_math_all_finite(const double* first, int count);

/// `value == value`, the test that fast-math deletes: shows whether the translation unit really is compiled that way.
bool fast_math_naive_is_number(double value);

}  // namespace pinnquad::test
