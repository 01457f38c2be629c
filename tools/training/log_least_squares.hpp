// SPDX-License-Identifier: MIT
// The equations behind the models of logged flights that are solved in closed form. Compiled once: what decomposes
// matrices takes longer to compile than all else here.
#pragma once

#include <string>
#include <vector>

#include "pinnquad/dynamics/rotor.hpp"
#include "pinnquad/nn/scaler.hpp"
#include "pinnquad/regression/ridge.hpp"
#include "pinnquad/training/structured/closed_form.hpp"

namespace programs {

/// Ridge regression of standardised features and outputs, its penalty by leaving out each group in turn. Throws
/// std::invalid_argument for no rows. One group alone: no penalty.
pinnquad::AffineMap solved_ridge(const std::vector<pinnquad::RegressionSums>& groups);

/// Ordinary least squares.
pinnquad::AffineMap solved_least_squares(const std::vector<pinnquad::RegressionSums>& groups);

/// Physics with parameters that are fitted: thrust along -z by the specific force (mass over thrust coefficient), the
/// velocity along z and its square (inflow, drag) and the battery; the torque about each axis by the angular
/// acceleration (inertia over effectiveness), the product of the other two rates (gyroscopic), the rate (damping) and
/// the velocity across (flapping); each with a trim. `names`: of the features; what is not there is left out. Sums:
/// standardised features, and as targets the wrench that the commands make by `allocation`. The map: to standardised
/// commands.
pinnquad::AffineMap solved_physics(const pinnquad::RegressionSums& sums, const std::vector<std::string>& names,
                                   const pinnquad::AllocationMatrix<double>& allocation,
                                   const pinnquad::Scaler<double, pinnquad::rotor_count>& commands);

}  // namespace programs
