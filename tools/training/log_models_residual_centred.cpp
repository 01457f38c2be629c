// SPDX-License-Identifier: MIT
#include "training/log_kinds.hpp"
#include "training/log_residual.hpp"

namespace programs {

LogModelKind log_ridge_residual_centred() {
  return {"ridge_residual_centred",
          "ridge + residual network, 80 ms to both sides",
          TimeReach::centred,
          true,
          needs_window,
          fit_log_residual<TimeReach::centred>,
          true};
}

}  // namespace programs
