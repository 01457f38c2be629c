// SPDX-License-Identifier: MIT
// The kinds of models of logged flights, each defined where it is compiled (log_models_<what>.cpp).
#pragma once

#include "training/log_model.hpp"

namespace programs {

LogModelKind log_constant();
LogModelKind log_physics();
LogModelKind log_linear();
LogModelKind log_linearized();
LogModelKind log_ridge();
LogModelKind log_ridge_causal();
LogModelKind log_ridge_centred();
LogModelKind log_vanilla();
LogModelKind log_physics_informed();
LogModelKind log_structured();
LogModelKind log_structured_causal();
LogModelKind log_structured_centred();

}  // namespace programs
