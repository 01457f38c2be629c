// SPDX-License-Identifier: MIT
// The smallest standard deviation that counts as movement, by unit. A feature that varies less stands still: it is
// scaled as a constant, and its envelope gets a fixed margin, for a flight will move it a little.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace pinnquad {

/// In the unit itself.
struct Resolution {
  double smallest_deviation;  ///< a standard deviation below this is rounding or noise
  double still_margin;        ///< how far a quantity that stood still may be from where it stood
};

/// Of a quantity with this unit (units of a feature set or an output schema) about `mean`:
///   unit      m/s^2  rad/s^2  m/s   rad/s  rad    1       m     rev/s  V
///   smallest  0.01   0.01     0.01  0.001  0.001  0.0001  0.01  0.01   0.01
///   margin    0.2    0.5      0.1   0.05   0.05   0.05    0.2   0.5    0.5
/// Any other unit: a millionth and a hundredth of |mean|, of 1 for a smaller mean. No smallest deviation is below a
/// millionth of
/// |mean|: a float's rounding.
inline Resolution resolution_of(std::string_view unit, double mean) {
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

/// Share of a feature's range in the training set by which the envelope is wider on both sides.
inline constexpr double envelope_margin = 0.1;

/// Statistics of a column of training rows.
struct ColumnStatistics {
  double mean = 0;
  double standard_deviation = 0;  ///< divisor n
  double lowest = 0;
  double highest = 0;
  Resolution resolution{0, 0};

  bool still() const noexcept { return !(standard_deviation >= resolution.smallest_deviation); }

  /// Divisor of the column: 1 if it stands still.
  double scale() const noexcept { return still() ? 1.0 : standard_deviation; }

  /// By how much the envelope is wider than the range, on both sides: envelope_margin of the range, no less than the
  /// smallest deviation, or than the still margin if the column stands still.
  double margin() const noexcept {
    const double least = still() ? resolution.still_margin : resolution.smallest_deviation;
    const double share = envelope_margin * (highest - lowest);
    return share > least ? share : least;
  }
};

/// Statistics of every column of a table that is made row by row and never held, by two passes: `each_row(visit)` calls
/// `visit(row)` for every row, an array of Size numbers, the same ones in the same order each time. `unit_of(i)` is
/// the unit of column i.
template <std::size_t Size, class EachRow, class UnitOf>
std::array<ColumnStatistics, Size> column_statistics(const EachRow& each_row, const UnitOf& unit_of) {
  std::array<ColumnStatistics, Size> columns;
  std::array<double, Size> sums{}, squares{};
  std::size_t rows = 0;
  each_row([&](const auto& row) {
    for (std::size_t i = 0; i < Size; ++i) sums[i] += row[i];
    ++rows;
  });
  const double count = static_cast<double>(rows);
  for (std::size_t i = 0; i < Size; ++i) columns[i].mean = sums[i] / count;
  bool first = true;
  each_row([&](const auto& row) {
    for (std::size_t i = 0; i < Size; ++i) {
      ColumnStatistics& column = columns[i];
      const double value = row[i];
      squares[i] += (value - column.mean) * (value - column.mean);
      column.lowest = first || value < column.lowest ? value : column.lowest;
      column.highest = first || value > column.highest ? value : column.highest;
    }
    first = false;
  });
  for (std::size_t i = 0; i < Size; ++i) {
    columns[i].standard_deviation = std::sqrt(squares[i] / count);
    columns[i].resolution = resolution_of(unit_of(i), columns[i].mean);
  }
  return columns;
}

}  // namespace pinnquad
