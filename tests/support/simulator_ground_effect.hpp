// SPDX-License-Identifier: MIT
// Cheeseman and Bennett's ground effect as the reference simulator computes it: its pole at Z/R = 0.25 included. The
// library holds the ratio below Z/R = 0.5; this one is for rows of the simulator, and for ratios above 2.
#pragma once

#include "pinnquad/aero/ground_effect.hpp"

namespace pinnquad::test {

struct SimulatorCheesemanBennett {
  template <class Scalar>
  Scalar thrust_ratio(Scalar height_over_radius, const Airframe<Scalar>&) const noexcept {
    if (height_over_radius <= Scalar(0.25)) return Scalar(1);
    const Scalar q = Scalar(0.25) / height_over_radius;
    return Scalar(1) / (Scalar(1) - q * q);
  }
};
using SimulatorGroundEffect = GroundEffect<SimulatorCheesemanBennett>;

}  // namespace pinnquad::test
