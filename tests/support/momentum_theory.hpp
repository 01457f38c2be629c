// SPDX-License-Identifier: MIT
// A rotor at constant speed by blade elements and momentum, solved by bisection: no step of it is the library's.
#pragma once

#include <cmath>

namespace pinnquad::test {

/// Thrust over that in hover and induced velocity over the hover's, at speeds over the hover's induced velocity.
struct DiscFlow {
  double thrust_ratio;
  double induced;
};

/// Blade elements, C_T / C_Th = (theta / 3 (1 + 3/2 mu^2) - lambda / 2) / (theta / 3 - lambda_h / 2) with the pitch
/// that gives C_Th = 2 lambda_h^2 in hover; momentum, C_T = 2 lambda_i sqrt(mu^2 + lambda^2).
inline DiscFlow disc_flow(double solidity_times_slope, double inflow_ratio, double edgewise, double climb) {
  const double half = solidity_times_slope / 2, hover = 2 * inflow_ratio * inflow_ratio;
  const double third_of_pitch = hover / half + inflow_ratio / 2;
  const double mu = edgewise * inflow_ratio, mu_z = climb * inflow_ratio;
  const auto blades = [&](double lambda) { return half * (third_of_pitch * (1 + 1.5 * mu * mu) - lambda / 2); };
  double low = -100 * inflow_ratio, high = 100 * inflow_ratio;
  for (int i = 0; i < 200; ++i) {
    const double lambda = (low + high) / 2;
    const double momentum = 2 * (lambda - mu_z) * std::sqrt(mu * mu + lambda * lambda);
    (momentum < blades(lambda) ? low : high) = lambda;
  }
  return {blades(low) / hover, (low - mu_z) / inflow_ratio};
}

}  // namespace pinnquad::test
