// SPDX-License-Identifier: MIT
//
// All headers, those of an autopilot and the shipped models with them, for a compiler that warns of what users warn of.
// The quickstart, and its main(), instantiate what flies.
#include <pinnquad/control/autopilot/recorded_controller.hpp>
#include <pinnquad/control/autopilot/take_off.hpp>
#include <pinnquad/pinnquad.hpp>

#include "../../examples/quickstart.cpp"
#include "crazyflie_2_1.hpp"
#include "structured_quadrotor.hpp"
