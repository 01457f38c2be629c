// SPDX-License-Identifier: MIT
// Slopes of four commands by what they are made of, against central differences.
#pragma once

#include <doctest/doctest.h>

#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad::test {

/// `commands(x, u)`; `slopes` is rotor_count x `count`, row-major.
template <class Number, class Commands>
void check_slopes(Number* x, int count, const double* slopes, const Commands& commands) {
  constexpr double step = 1e-6;
  for (int k = 0; k < count; ++k) {
    double above[rotor_count], below[rotor_count];
    const double kept = x[k];
    x[k] = kept + step;
    commands(static_cast<const double*>(x), static_cast<double*>(above));
    x[k] = kept - step;
    commands(static_cast<const double*>(x), static_cast<double*>(below));
    x[k] = kept;
    for (int i = 0; i < rotor_count; ++i) {
      CAPTURE(i);
      CAPTURE(k);
      CHECK(slopes[i * count + k] == doctest::Approx((above[i] - below[i]) / (2 * step)).epsilon(1e-6));
    }
  }
}

}  // namespace pinnquad::test
