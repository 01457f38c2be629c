// SPDX-License-Identifier: MIT
// Gradients against central differences in double.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace pinnquad::test {

/// Tolerance of a gradient in double: |gradient - central difference| <= this * max|gradient|.
inline constexpr double gradient_tolerance = 1e-6;

/// Step of the central differences: truncation h^2 f'''/6 and rounding 1e-16 f / h are both near 1e-11 here, five
/// decades below gradient_tolerance.
inline constexpr double difference_step = 1e-5;

/// No ReLU input may be nearer to 0 than this: a parameter that moves by difference_step moves a pre-activation by that
/// times the gain of the layers between, and a hundredfold gain is more than small networks have.
inline constexpr double kink_margin = 1e-3;

/// d function() / d variables[i] for i in 0..count; function reads `variables`.
template <class Function>
std::vector<double> central_differences(const Function& function, double* variables, std::size_t count) {
  std::vector<double> result(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double original = variables[i];
    variables[i] = original + difference_step;
    const double above = function();
    variables[i] = original - difference_step;
    const double below = function();
    variables[i] = original;
    result[i] = (above - below) / (2.0 * difference_step);
  }
  return result;
}

/// max |a - b| / max |b| over `count` entries; infinite if either is not finite or b is all zero while a is not.
inline double gradient_error(const double* gradient, const double* reference, std::size_t count) {
  double difference = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(gradient[i]) || !std::isfinite(reference[i])) return std::numeric_limits<double>::infinity();
    difference = std::max(difference, std::fabs(gradient[i] - reference[i]));
    scale = std::max(scale, std::fabs(reference[i]));
  }
  if (difference == 0.0) return 0.0;
  return scale > 0.0 ? difference / scale : std::numeric_limits<double>::infinity();
}

}  // namespace pinnquad::test
