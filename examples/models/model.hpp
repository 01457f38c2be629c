// SPDX-License-Identifier: MIT
// The shipped model under the names that `pinnquad train` gives a model of yours: -Iexamples/models stands for -Idemo_out.
#pragma once

#include "demo_quadrotor.hpp"

using TrainedQuadModel = DemoQuadModel;
