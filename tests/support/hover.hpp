// SPDX-License-Identifier: MIT
// A trajectory that stays in one place.
#pragma once

#include "pinnquad/control/trajectory.hpp"

namespace pinnquad::test {

template <class Scalar>
struct Hover {
  Vector3<Scalar> position_m = Vector3<Scalar>::Zero();  ///< NED
  Scalar yaw_rad = Scalar(0);

  TrajectoryPoint<Scalar> sample(Scalar /*time_s*/) const noexcept {
    TrajectoryPoint<Scalar> point;
    point.position_m = position_m;
    point.yaw_rad = yaw_rad;
    return point;
  }
};

}  // namespace pinnquad::test
