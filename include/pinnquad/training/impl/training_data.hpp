// SPDX-License-Identifier: MIT
// Bodies of training_data.hpp.
#pragma once

#include "pinnquad/training/training_data.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY Resolution resolution_of(std::string_view unit, double mean) {
  struct Named {
    std::string_view unit;
    Resolution resolution;
  };
  constexpr std::array<Named, 9> named = {{{"m/s^2", {0.01, 0.2}},
                                           {"rad/s^2", {0.01, 0.5}},
                                           {"m/s", {0.01, 0.1}},
                                           {"rad/s", {0.001, 0.05}},
                                           {"rad", {0.001, 0.05}},
                                           {"1", {0.0001, 0.05}},
                                           {"m", {0.01, 0.2}},
                                           {"rev/s", {0.01, 0.5}},
                                           {"V", {0.01, 0.5}}}};
  constexpr double rounding = 1e-6;
  const double magnitude = std::abs(mean);
  for (const Named& known : named) {
    if (known.unit != unit) continue;
    Resolution resolution = known.resolution;
    if (resolution.smallest_deviation < rounding * magnitude) resolution.smallest_deviation = rounding * magnitude;
    return resolution;
  }
  const double scale = magnitude > 1 ? magnitude : 1.0;
  return {rounding * scale, 0.01 * scale};
}

PINNQUAD_BODY std::vector<ColumnStatistics> column_statistics(const std::vector<std::string_view>& units,
                                                              const std::function<void(const RowVisit&)>& each_row) {
  const std::size_t size = units.size();
  std::vector<ColumnStatistics> columns(size);
  std::vector<double> sums(size), squares(size);
  std::size_t rows = 0;
  each_row([&](const double* row) {
    for (std::size_t i = 0; i < size; ++i) sums[i] += row[i];
    ++rows;
  });
  const double count = static_cast<double>(rows);
  for (std::size_t i = 0; i < size; ++i) columns[i].mean = sums[i] / count;
  bool first = true;
  each_row([&](const double* row) {
    for (std::size_t i = 0; i < size; ++i) {
      ColumnStatistics& column = columns[i];
      const double value = row[i];
      squares[i] += (value - column.mean) * (value - column.mean);
      column.lowest = first || value < column.lowest ? value : column.lowest;
      column.highest = first || value > column.highest ? value : column.highest;
    }
    first = false;
  });
  for (std::size_t i = 0; i < size; ++i) {
    columns[i].standard_deviation = std::sqrt(squares[i] / count);
    columns[i].resolution = resolution_of(units[i], columns[i].mean);
  }
  return columns;
}

}  // namespace detail
}  // namespace pinnquad
