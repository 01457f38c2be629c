// SPDX-License-Identifier: MIT
// Umbrella: everything that may fly, and nothing else.
// No heap, exceptions, RTTI, iostream, virtual calls, asserts or statics with run-time initialisation below this line.
#pragma once

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/dryden.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/rotor_drag.hpp"
#include "pinnquad/aero/rotor_ground_effect.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/control/tracking.hpp"
#include "pinnquad/control/trajectory.hpp"
#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/racer_5_inch.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"
#include "pinnquad/dynamics/linearized.hpp"
#include "pinnquad/inference/analytic_inverse.hpp"
#include "pinnquad/inference/guard.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"
#include "pinnquad/inference/self_test.hpp"
#include "pinnquad/nn/batch_norm.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "pinnquad/vehicle/inverse.hpp"
#include "pinnquad/version.hpp"
