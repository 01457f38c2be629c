// SPDX-License-Identifier: MIT
#include "training/log_kinds.hpp"
#include "training/log_structured.hpp"

namespace programs {

ModelKind log_structured() {
  return {"structured",
          "structured: monotone ridge + residual network",
          TimeReach::present,
          true,
          always_applicable,
          fit_log_structured<TimeReach::present>,
          true};
}

}  // namespace programs
