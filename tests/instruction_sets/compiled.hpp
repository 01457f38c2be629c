// SPDX-License-Identifier: MIT
// One model, compiled for three machines, in one program.
#pragma once

#include "../support/small_model.hpp"
#include "pinnquad/inference/compiled_prediction.hpp"

extern const pinnquad::CompiledPrediction<float> predict_baseline, predict_avx2, predict_avx512;
