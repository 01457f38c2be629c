// SPDX-License-Identifier: MIT
// A window as long as train makes it of logs.
#pragma once

#include "../past_model.hpp"

using TrainedQuadModel = pinnquad::autopilot::test::PastModelOf<9>;
