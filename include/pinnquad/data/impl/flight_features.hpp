// SPDX-License-Identifier: MIT
// Bodies of flight_features.hpp.
#pragma once

#include "pinnquad/data/flight_features.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY const std::vector<double>& column_values(const Flight& flight, const std::string& name,
                                                       const std::string& unit) {
  const ExtraColumn* column = flight.column(name);
  const std::string expected = "flight '" + flight.name + "': expected a column " + name + " in " + unit + ", found ";
  if (column == nullptr) throw std::invalid_argument(expected + "none of that name");
  if (column->unit != unit) throw std::invalid_argument(expected + "it in " + column->unit);
  return column->values;
}

}  // namespace detail
}  // namespace pinnquad
