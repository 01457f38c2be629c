// SPDX-License-Identifier: MIT
// Compiled once per instruction set; PREDICT names its table.
#include "compiled.hpp"

const pinnquad::CompiledPrediction<float> PREDICT =
    pinnquad::compiled_prediction<pinnquad::InverseDynamics<pinnquad::test::SmallModel>>();
