// SPDX-License-Identifier: MIT
// Ridge regression on physics features with the last 160 ms.
#include "training/log_closed_form.hpp"
#include "training/log_kinds.hpp"

namespace programs {

ModelKind log_ridge_causal() {
  return {"ridge_causal", "ridge, the last 160 ms",         TimeReach::causal,    false,
          needs_window,   fit_log_ridge<TimeReach::causal>, takes_validation_rows};
}

}  // namespace programs
