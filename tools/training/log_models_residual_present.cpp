// SPDX-License-Identifier: MIT
#include "training/log_kinds.hpp"
#include "training/log_residual.hpp"

namespace programs {

LogModelKind log_ridge_residual() {
  return {"ridge_residual",
          "ridge + residual network",
          TimeReach::present,
          true,
          always_applicable,
          fit_log_residual<TimeReach::present>,
          true};
}

}  // namespace programs
