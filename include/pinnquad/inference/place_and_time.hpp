// SPDX-License-Identifier: MIT
// Where and when: what a fallback may need to know and a network's features need not say.
#pragma once

#include "pinnquad/core/types.hpp"

namespace pinnquad {

/// Where and when a motion is wanted, for a fallback that needs to know (ground effect, density, wind).
template <class Real>
struct PlaceAndTime {
  Vector3<Real> position_m = Vector3<Real>::Zero();  ///< NED, of the vehicle's site
  Real time_s{0};
};

}  // namespace pinnquad
