// SPDX-License-Identifier: MIT
#include "training/log_kinds.hpp"
#include "training/log_residual.hpp"

namespace programs {

LogModelKind log_ridge_residual_causal() {
  return {"ridge_residual_causal",
          "ridge + residual network, the last 160 ms",
          TimeReach::causal,
          true,
          needs_window,
          fit_log_residual<TimeReach::causal>,
          true};
}

}  // namespace programs
