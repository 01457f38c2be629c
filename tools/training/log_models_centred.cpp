// SPDX-License-Identifier: MIT
// Ridge regression on physics features with 80 ms to both sides, for motions that are planned.
#include "training/log_closed_form.hpp"
#include "training/log_kinds.hpp"

namespace programs {

ModelKind log_ridge_centred() {
  return {"ridge_centred", "ridge, 80 ms to both sides",      TimeReach::centred,   false,
          needs_window,    fit_log_ridge<TimeReach::centred>, takes_validation_rows};
}

}  // namespace programs
