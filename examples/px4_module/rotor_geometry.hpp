// SPDX-License-Identifier: MIT
// PX4's rotors (CA_ROTOR*) beside those of the airframe that the model was compiled for. Pure C++17; the glue reads the
// parameters.
#pragma once

#include <cmath>
#include <cstddef>

#include "pinnquad/dynamics/airframe.hpp"

namespace pinnquad_px4 {

/// CA_ROTORi_PX, _PY (FRD, from the centre of gravity) and _KM: positive for a rotor that turns counter-clockwise.
struct CaRotor {
  float x{0};
  float y{0};
  float moment{0};
};

struct CaGeometry {
  int count{0};  ///< CA_ROTOR_COUNT
  CaRotor rotors[pinnquad::rotor_count]{};
};

enum class GeometryFault { none, count, place, spin };

/// A parameter that does not fit, and the first rotor that it is about.
struct GeometryCheck {
  GeometryFault fault{GeometryFault::none};
  std::size_t rotor{0};

  bool fits() const noexcept { return fault == GeometryFault::none; }
};

/// Places fit to a tenth of the longest arm, at the scale of the longest arms: PX4's allocation knows no other (its own
/// SIH says 1 m for arms of 0.2 m). Spins have to agree rotor by rotor: in another order, each would get the command of
/// a neighbour.
template <class Scalar>
GeometryCheck check_geometry(const CaGeometry& px4, const pinnquad::Airframe<Scalar>& airframe) noexcept {
  constexpr Scalar tolerance = Scalar(0.1);
  if (px4.count != static_cast<int>(pinnquad::rotor_count)) return {GeometryFault::count, 0};
  Scalar longest(0), theirs(0);
  for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
    const Scalar x = airframe.rotors[i].x_m, y = airframe.rotors[i].y_m;
    const Scalar px = Scalar(px4.rotors[i].x), py = Scalar(px4.rotors[i].y);
    if (x * x + y * y > longest) longest = x * x + y * y;
    if (px * px + py * py > theirs) theirs = px * px + py * py;
  }
  if (!(theirs > Scalar(0))) return {GeometryFault::place, 0};  // NaN too
  const Scalar scale = std::sqrt(longest / theirs);
  for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
    const Scalar dx = scale * Scalar(px4.rotors[i].x) - airframe.rotors[i].x_m;
    const Scalar dy = scale * Scalar(px4.rotors[i].y) - airframe.rotors[i].y_m;
    if (!(dx * dx + dy * dy <= tolerance * tolerance * longest)) return {GeometryFault::place, i};
  }
  for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
    const bool counter_clockwise = airframe.rotors[i].spin == pinnquad::Spin::counter_clockwise;
    const float moment = px4.rotors[i].moment;
    if (!(counter_clockwise ? moment > 0 : moment < 0)) return {GeometryFault::spin, i};
  }
  return {};
}

}  // namespace pinnquad_px4
