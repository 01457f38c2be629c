// SPDX-License-Identifier: MIT
// Bodies of fit_context.hpp.
#pragma once

#include "pinnquad/training/structured/fit_context.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY std::vector<int> other_features(int count, const std::vector<int>& threes) {
  std::vector<int> others;
  for (int i = 0; i < count; ++i) {
    bool other = true;
    for (const int first : threes) other = other && (i < first || i > first + 2);
    if (other) others.push_back(i);
  }
  return others;
}

}  // namespace detail
}  // namespace pinnquad
