// SPDX-License-Identifier: MIT
#include "training/log_kinds.hpp"

namespace programs {

const std::vector<ModelKind>& log_model_kinds() {
  static const std::vector<ModelKind> kinds = {
      log_constant(),   log_last_commands(),     log_physics(),           log_linear(),  log_linearized(),
      log_ridge(),      log_ridge_causal(),      log_ridge_centred(),     log_vanilla(), log_physics_informed(),
      log_structured(), log_structured_causal(), log_structured_centred()};
  return kinds;
}

}  // namespace programs
