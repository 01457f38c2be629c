// SPDX-License-Identifier: MIT
#include "training/log_kinds.hpp"
#include "training/structured_kind.hpp"

namespace programs {

ModelKind log_structured_causal() {
  return {
      "structured_causal", "structured, the last 160 ms",          TimeReach::causal, true,
      needs_window,        fit_structured_kind<TimeReach::causal>, fits_validation,   pinnquad::structured_in_words};
}

}  // namespace programs
