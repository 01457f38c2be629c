// SPDX-License-Identifier: MIT
// Place and time of a motion: a fallback may depend on them where a network's features do not.
#pragma once

#include <cstdint>

#include "pinnquad/core/types.hpp"

namespace pinnquad {

/// A flight stack's clock in seconds. After 30 days doubles are 5e-10 s apart, floats 0.25 s.
constexpr double seconds_of(std::uint64_t time_us) noexcept { return 1e-6 * static_cast<double>(time_us); }

/// For a fallback with effects of place or time (ground effect, density, wind). Effects read the time in their
/// vehicle's scalar: in float it must count from the flight's start.
template <class Real>
struct PlaceAndTime {
  Vector3<Real> position_m = Vector3<Real>::Zero();  ///< NED, of the vehicle's site
  Real time_s{0};
};

}  // namespace pinnquad
