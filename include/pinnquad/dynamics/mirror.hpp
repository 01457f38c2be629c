// SPDX-License-Identifier: MIT
// Whether a vehicle is its own mirror image about the x-z plane, and which rotor becomes which: then each motion and its
// mirror image are flown by mirrored commands. A polar vector changes its y, an axial one (rates, angular acceleration) its
// x and z, a rotor its side and its spin. Wind and what hangs on one side are not the airframe's: who knows of them does
// not mirror.
#pragma once

#include "pinnquad/dynamics/airframe.hpp"

namespace pinnquad {

/// partner[i]: the rotor that rotor i becomes.
struct RotorMirror {
  std::array<int, rotor_count> partner{};
  bool exists = false;  ///< false: the vehicle is crooked, and `partner` means nothing
};

namespace detail {
template <class Scalar>
constexpr bool close_to(Scalar a, Scalar b, Scalar tolerance) noexcept {
  return a - b <= tolerance && b - a <= tolerance;
}
}  // namespace detail

/// Places to a millimetre's tenth, axes and scales to a thousandth, products of inertia to a thousandth of the moments.
template <class Scalar>
constexpr RotorMirror mirror_of(const Airframe<Scalar>& airframe) noexcept {
  const Scalar place = Scalar(1e-4), share = Scalar(1e-3);
  RotorMirror mirror;
  const auto& [xy, xz, yz] = airframe.inertia_products_kg_m2;
  static_cast<void>(xz);
  const Scalar size = share * (airframe.inertia_kg_m2[0] + airframe.inertia_kg_m2[1]);
  mirror.exists = detail::close_to(xy, Scalar(0), size) && detail::close_to(yz, Scalar(0), size);
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const RotorMount<Scalar>& one = airframe.rotors[i];
    int found = -1;
    for (std::size_t k = 0; k < rotor_count; ++k) {
      const RotorMount<Scalar>& other = airframe.rotors[k];
      const bool same = detail::close_to(one.x_m, other.x_m, place) && detail::close_to(one.y_m, -other.y_m, place) &&
                        detail::close_to(one.z_m, other.z_m, place) && one.spin != other.spin &&
                        detail::close_to(one.axis[0], other.axis[0], share) &&
                        detail::close_to(one.axis[1], -other.axis[1], share) &&
                        detail::close_to(one.axis[2], other.axis[2], share) &&
                        detail::close_to(one.thrust_scale, other.thrust_scale, share) &&
                        detail::close_to(one.thrust_curve, other.thrust_curve, share) &&
                        detail::close_to(airframe.rise_time_constant_s(i), airframe.rise_time_constant_s(k), share) &&
                        detail::close_to(airframe.fall_time_constant_s(i), airframe.fall_time_constant_s(k), share);
      if (same) found = static_cast<int>(k);
    }
    mirror.exists = mirror.exists && found >= 0;
    mirror.partner[i] = found;
  }
  return mirror;
}

}  // namespace pinnquad
