// SPDX-License-Identifier: MIT
//
// A function that is no template, from the library that this project compiled: its header only declares it here.
#include <cmath>
#include <cstdio>
#include <pinnquad/regression/ridge.hpp>

#ifndef PINNQUAD_COMPILED
#error "pinnquad::compiled does not define PINNQUAD_COMPILED"
#endif

int main() {
  pinnquad::RegressionSums sums(1, 1);
  for (const double x : {0.0, 1.0, 3.0}) {
    const double y = 1 + 2 * x;
    sums.add(&x, &y);
  }
  const pinnquad::AffineMap map = pinnquad::fit_ridge(sums, 0);
  const double x = 5;
  std::printf("%.6f\n", map(&x)[0]);
  return std::abs(map(&x)[0] - 11) < 1e-9 ? 0 : 1;
}
