// SPDX-License-Identifier: MIT
// Bodies of asked_model.hpp.
#pragma once

#include "pinnquad/training/asked_model.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY std::vector<ColumnStatistics> feature_statistics(const AskedModel& model, const RowSet& rows) {
  return column_statistics({model.units.begin(), model.units.end()}, [&](const RowVisit& visit) {
    model.each_exact_row(rows, [&](const Flight&, std::size_t, const double* x) { visit(x); });
  });
}

}  // namespace detail
}  // namespace pinnquad
