// SPDX-License-Identifier: MIT
// A structured model in the Crazyflie's app.
#pragma once

#include "models/structured_quadrotor.hpp"

using TrainedQuadModel = StructuredQuadModel;
