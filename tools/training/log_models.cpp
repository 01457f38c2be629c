// SPDX-License-Identifier: MIT
#include "training/log_kinds.hpp"

namespace programs {

const std::vector<LogModelKind>& log_model_kinds() {
  static const std::vector<LogModelKind> kinds = {log_constant(),     log_physics(), log_linear(),
                                                  log_linearized(),   log_ridge(),   log_ridge_causal(),
                                                  log_ridge_centred()};
  return kinds;
}

}  // namespace programs
