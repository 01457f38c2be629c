// SPDX-License-Identifier: MIT
// An airframe with nothing equal: tilted rotors of different strength, curve, height and lag, and products of inertia.
#pragma once

#include <cmath>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"

namespace pinnquad::test {

template <class Scalar>
Airframe<Scalar> uneven_airframe() {
  Airframe<Scalar> a = PaperQuadrotor::value<Scalar>();
  a.inertia_kg_m2 = {Scalar(0.0190), Scalar(0.0215), Scalar(0.0309)};
  a.inertia_products_kg_m2 = {Scalar(1.1e-3), Scalar(-2.3e-3), Scalar(0.7e-3)};
  const double tilt[4][2] = {{0.15, -0.1}, {-0.05, 0.2}, {0.1, 0.12}, {-0.2, -0.03}};  // along x and y
  const double scale[4] = {1.0, 0.93, 1.06, 0.9}, curve[4] = {0.0, 0.35, 0.7, 1.0},
               height[4] = {-0.03, 0.0, 0.02, 0.05};
  const double rise[4] = {0.004, 0.02, 0.0, 0.05}, fall[4] = {0.008, 0.03, 0.02, 0.05};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    RotorMount<Scalar>& r = a.rotors[i];
    r.x_m *= Scalar(1.0 + 0.1 * static_cast<double>(i));
    r.z_m = Scalar(height[i]);
    const double down = std::sqrt(1.0 - tilt[i][0] * tilt[i][0] - tilt[i][1] * tilt[i][1]);
    r.axis = {Scalar(tilt[i][0]), Scalar(tilt[i][1]), Scalar(-down)};
    r.thrust_scale = Scalar(scale[i]);
    r.thrust_curve = Scalar(curve[i]);
    r.rise_time_constant_s = Scalar(rise[i]);
    r.fall_time_constant_s = Scalar(fall[i]);
  }
  return a;
}

}  // namespace pinnquad::test
