// SPDX-License-Identifier: MIT
// The vehicle whose flights train the models of this folder, and the flight that they are trained on.
#pragma once

#include <random>

#include "pinnquad/aero/drag.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/outputs/wrench_outputs.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad::test {

using Flown = Quadrotor<double, QuadraticDrag>;

inline Flown flown_vehicle() {
  return Flown(airframe_value<PaperQuadrotor, double>(), paper_site<double>(), QuadraticDrag{});
}

}  // namespace pinnquad::test
