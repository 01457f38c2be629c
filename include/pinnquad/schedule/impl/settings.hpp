// SPDX-License-Identifier: MIT
// Body of settings.hpp.
#pragma once

#include <locale>
#include <sstream>
#include <stdexcept>

#include "pinnquad/schedule/settings.hpp"

namespace pinnquad::detail {

PINNQUAD_BODY void refuse_setting(const char* setting, const char* expected, double found) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << setting << ": expected " << expected << ", found " << found;
  throw std::invalid_argument(text.str());
}

}  // namespace pinnquad::detail
