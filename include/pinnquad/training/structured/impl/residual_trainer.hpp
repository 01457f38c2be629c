// SPDX-License-Identifier: MIT
// Bodies of residual_trainer.hpp.
#pragma once

#include "pinnquad/training/structured/residual_trainer.hpp"

namespace pinnquad::detail {

PINNQUAD_BODY FitRows fit_rows(const FitContext& context, const RowSet& from) {
  FitRows rows{context.inputs(), {}, {}};
  context.each_standardised(from, [&](const Flight&, std::size_t, const double* x, const double* y) {
    for (int i = 0; i < context.inputs(); ++i) rows.features.push_back(static_cast<float>(x[i]));
    for (int k = 0; k < context.outputs(); ++k) rows.outputs.push_back(static_cast<float>(y[k]));
  });
  return rows;
}

}  // namespace pinnquad::detail
