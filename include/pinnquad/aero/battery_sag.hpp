// SPDX-License-Identifier: MIT
// A battery that gives out over a flight: all rotors lose thrust with its voltage.
#pragma once

#include "pinnquad/aero/effect.hpp"

namespace pinnquad {

/// Multiplies the thrust scale by (U / full)^2, U(t) = full - (full - empty) t / endurance: full before time 0, empty
/// after the endurance. At the same pulse width a motor's speed goes with its voltage, and thrust with the speed's
/// square; a controller of speed would not sag. Defaults: three lithium cells from 4.2 V, their full charge, to 3.5 V
/// under load; that and the endurance are ours. By time alone: the current is not known where the air is made.
struct BatterySag {
  double full_V{12.6};
  double empty_V{10.5};
  double endurance_s{900};

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE void surroundings(Surroundings<Scalar>& air) const noexcept {
    const Scalar share = air.time_s * Scalar(1 / endurance_s);
    const Scalar used = select(share < Scalar(0), Scalar(0), select(share > Scalar(1), Scalar(1), share));
    const Scalar voltage = Scalar(1) - used * Scalar((full_V - empty_V) / full_V);
    air.thrust_scale *= voltage * voltage;
  }

  /// `out_of_range` for voltages or an endurance that aren't positive, or an empty battery above the full one.
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    const bool holds =
        detail::plausible(full_V) && detail::plausible(empty_V) && empty_V <= full_V && detail::plausible(endurance_s);
    return holds ? Status::ok : Status::out_of_range;
  }
};

}  // namespace pinnquad
