// SPDX-License-Identifier: MIT
// A vehicle with other effects than those that the module assumes.
#pragma once

#include "pinnquad/aero/drag.hpp"
#include "pinnquad/flight.hpp"

using FlownVehicle = pinnquad::Quadrotor<float, pinnquad::LinearDamping>;
