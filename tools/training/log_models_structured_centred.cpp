// SPDX-License-Identifier: MIT
#include "training/log_kinds.hpp"
#include "training/structured_kind.hpp"

namespace programs {

ModelKind log_structured_centred() {
  return {
      "structured_centred", "structured, 80 ms to both sides",       TimeReach::centred, true,
      needs_window,         fit_structured_kind<TimeReach::centred>, fits_validation,    pinnquad::structured_in_words};
}

}  // namespace programs
