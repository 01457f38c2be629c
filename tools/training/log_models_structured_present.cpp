// SPDX-License-Identifier: MIT
#include "training/log_kinds.hpp"
#include "training/structured_kind.hpp"

namespace programs {

ModelKind log_structured() {
  return {"structured",       "structured",
          TimeReach::present, true,
          always_applicable,  fit_structured_kind<TimeReach::present>,
          fits_validation,    pinnquad::structured_in_words};
}

}  // namespace programs
