// SPDX-License-Identifier: MIT
// `train --recipe wrench`: the residual wrench of a vehicle, from flights to a block and a header.
#pragma once

#include "training/train_run.hpp"

namespace programs {

/// The recipe's name. It is of another kind than the recipes of training/recipe.hpp: no inverse, so none to compare.
inline constexpr const char* wrench_recipe = "wrench";
inline constexpr const char* wrench_model_name = "TrainedWrench";

/// The exit code of the command.
int train_wrench(const TrainOptions& options);

}  // namespace programs
