// SPDX-License-Identifier: MIT
// The kinds of models that logs are compared by, each defined where it is compiled (log_models_<what>.cpp).
#pragma once

#include "training/model_kind.hpp"

namespace programs {

ModelKind log_constant();
ModelKind log_last_commands();
ModelKind log_physics();
ModelKind log_linear();
ModelKind log_linearized();
ModelKind log_ridge();
ModelKind log_ridge_causal();
ModelKind log_ridge_centred();
ModelKind log_vanilla();
ModelKind log_physics_informed();
ModelKind log_structured();
ModelKind log_structured_causal();
ModelKind log_structured_centred();

}  // namespace programs
