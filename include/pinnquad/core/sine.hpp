// SPDX-License-Identifier: MIT
// The sine of a phase in turns, inline and without libm: the same bits everywhere, and no call that would spill every register
// of a simulation step.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "pinnquad/core/attributes.hpp"

namespace pinnquad {

namespace detail {
/// Taylor coefficients of sin(2 pi r) / r in r^2; ten terms leave 3e-16 at a quarter turn.
constexpr std::array<double, 10> sine_series() noexcept {
  constexpr double two_pi = 6.283185307179586;
  std::array<double, 10> c{two_pi};
  for (std::size_t k = 1; k < c.size(); ++k) {
    c[k] = -c[k - 1] * two_pi * two_pi / double(2 * k * (2 * k + 1));
  }
  return c;
}
}  // namespace detail

/// sin(2 pi turns), within 4 units in the last place of 1. NaN for NaN and Inf. A whole number of turns gives exactly 0.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE Scalar sine_of_turns(Scalar turns) noexcept {
  using std::floor;
  constexpr std::array<double, 10> c = detail::sine_series();
  const Scalar half(0.5), quarter(0.25);
  Scalar r = turns - floor(turns + half);  // -1/2 .. 1/2, exact
  r = r > quarter ? half - r : (r < -quarter ? -half - r : r);
  const Scalar x = r * r, x2 = x * x, x4 = x2 * x2;
  const auto pair = [&](std::size_t k) noexcept { return Scalar(c[k]) + Scalar(c[k + 1]) * x; };
  return r * ((pair(0) + pair(2) * x2) + ((pair(4) + pair(6) * x2) + pair(8) * x4) * x4);
}

}  // namespace pinnquad
