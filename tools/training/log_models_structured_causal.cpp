// SPDX-License-Identifier: MIT
#include "training/log_kinds.hpp"
#include "training/log_structured.hpp"

namespace programs {

ModelKind log_structured_causal() {
  return {"structured_causal",
          "structured: monotone ridge + residual network, the last 160 ms",
          TimeReach::causal,
          true,
          needs_window,
          fit_log_structured<TimeReach::causal>,
          true};
}

}  // namespace programs
