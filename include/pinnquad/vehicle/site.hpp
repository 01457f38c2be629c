// SPDX-License-Identifier: MIT
// The place of a flight: its height above sea level, the ground, gravity.
#pragma once

#include "pinnquad/dynamics/airframe.hpp"

namespace pinnquad {

/// The place of a flight on earth.
template <class Scalar>
struct Site {
  Scalar elevation_m{0};  ///< of the NED origin above sea level
  Scalar ground_z_m{0};   ///< NED z of the vehicle's centre where the rotors' height above ground counts as zero
  Scalar gravity_m_s2{standard_gravity_m_s2<Scalar>};
};

/// The site of the paper's simulator: home at 122 m, ground 0.877 m below the origin.
template <class Scalar>
constexpr Site<Scalar> paper_site() noexcept {
  Site<Scalar> site{};
  site.elevation_m = Scalar(122);
  site.ground_z_m = Scalar(0.877);
  return site;
}

}  // namespace pinnquad
