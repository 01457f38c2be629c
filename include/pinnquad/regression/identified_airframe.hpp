// SPDX-License-Identifier: MIT
// An identification as an airframe. Flights give ratios: accelerations per command. What they can't give is taken from
// another airframe and from the mass, and named:
//   thrust of a rotor T = A m,  J_x = y T / B_x,  J_y = x T / B_y   (x, y: the arms),  torque Q = B_z J_z
// J_z comes of the gyroscopic terms, J_z = J_y - G_x J_x = J_x + G_y J_y, where they tell it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/dynamics/rotor.hpp"
#include "pinnquad/regression/identification.hpp"
#include "pinnquad/regression/plausible_vehicle.hpp"

namespace pinnquad {

/// An airframe, and what of it the flights do not say.
struct IdentifiedAirframe {
  Airframe<double> value{};
  std::vector<std::string> assumed;  ///< "mass_kg", "rotor.x_m"
};

/// The airframe that answers commands as identified, of the mass, the arms, the spins and the propeller of `like`. A
/// number that is not told to within 50 % is that of `like`. None where thrust, roll or pitch are not told, where the
/// commands turn the vehicle against the airframe's signs, and where no quadrotor has the numbers
/// (implausible_number()).
std::optional<IdentifiedAirframe> identified_airframe(const Identification& found, const Airframe<double>& like);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/regression/impl/identified_airframe.hpp"
#endif
