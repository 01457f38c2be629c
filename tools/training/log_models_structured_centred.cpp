// SPDX-License-Identifier: MIT
#include "training/log_kinds.hpp"
#include "training/log_structured.hpp"

namespace programs {

ModelKind log_structured_centred() {
  return {"structured_centred",
          "structured: monotone ridge + residual network, 80 ms to both sides",
          TimeReach::centred,
          true,
          needs_window,
          fit_log_structured<TimeReach::centred>,
          true};
}

}  // namespace programs
