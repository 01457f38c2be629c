// SPDX-License-Identifier: MIT
// The model that the module is built with.
#pragma once

#include "models/demo_quadrotor.hpp"

using TrainedQuadModel = DemoQuadModel;
