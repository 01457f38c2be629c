// SPDX-License-Identifier: MIT
#pragma once
// FAULT core/types.hpp alone includes Eigen
// FAULT includes <vector>, which does not fly
// FAULT includes the umbrella
#include <pinnquad/flight.hpp>

#include <Eigen/Dense>
#include <vector>
