// SPDX-License-Identifier: MIT
// Checks that a flight can be one: per column its unit and physical range, a robust search for cells that fit no
// neighbour, and the mistakes that logs have: commands as pulse widths or percent, columns that the motion contradicts.
// A network trains on nonsense without complaint, and then flies it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/core/clock_time.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/motion_checks.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/io/file_error.hpp"

namespace pinnquad {

namespace detail {

/// The values that a column of `sample_field_names` may hold: all that any multirotor can reach.
struct ColumnPlausibility {
  const char* unit;
  double lowest;
  double highest;
  /// Least robust deviation, for a column that hardly varies. 0: no outliers are sought.
  double smallest_scale;
};

}  // namespace detail

/// Per column, in the order of `sample_field_names`. Angles may be unwrapped. Commands are 0 to 1, with a float's
/// rounding to spare.
// clang-format off
inline constexpr std::array<detail::ColumnPlausibility, sample_value_count> column_plausibility = {{
    {"s", -1e12, 1e12, 0},
    {"m/s^2", -1000, 1000, 1}, {"m/s^2", -1000, 1000, 1}, {"m/s^2", -1000, 1000, 1},
    {"rad/s^2", -1e5, 1e5, 20}, {"rad/s^2", -1e5, 1e5, 20}, {"rad/s^2", -1e5, 1e5, 20},
    {"m/s", -200, 200, 0.1}, {"m/s", -200, 200, 0.1}, {"m/s", -200, 200, 0.1},
    {"rad/s", -100, 100, 0.2}, {"rad/s", -100, 100, 0.2}, {"rad/s", -100, 100, 0.2},
    {"rad", -1e4, 1e4, 0.25}, {"rad", -1e4, 1e4, 0.25}, {"rad", -1e4, 1e4, 0.25},
    {"m", -1000, 20000, 0.1},
    {"1", -1e-6, 1 + 1e-6, 0}, {"1", -1e-6, 1 + 1e-6, 0}, {"1", -1e-6, 1 + 1e-6, 0}, {"1", -1e-6, 1 + 1e-6, 0}}};
// clang-format on

/// A cell further than this many robust deviations from its column's median, both of whose neighbours in time are not
/// half as far, is no measurement: motion lasts longer than a row. The paper's pilots, an independent simulator and
/// real logs stay below 8, an angle that wraps round below 26.
inline constexpr double most_robust_deviations = 30;

namespace detail {

inline constexpr std::size_t first_command_field = 17;

std::vector<double> column_of(const Flight& flight, std::size_t field);

/// The upper median of a series that is not empty.
double median_of(std::vector<double> series);

inline std::string column_text(std::size_t field) { return "in column " + std::string(sample_field_names[field]); }

}  // namespace detail

/// The first reason, in this order, why a network must not learn from these rows: commands outside 0..1, a clock of
/// another unit, an attitude that does not turn by the body rates, a cell outside its column's range or like none of
/// its neighbours, accelerations that are not the derivatives of rates and velocity, an altitude that goes against it.
/// None for a flight.
std::optional<detail::Implausible> find_implausible(const Flight& flight);

/// The columns whose axis and sign the motion of a flight doesn't confirm, "w_x, w_z, v_bx": too little of it.
std::string motion_not_checked(const Flight& flight);

/// Throws InputError where find_implausible() finds something in a flight that was read from `path`:
///   flight.csv:17:5: expected -1000 to 1000 m/s^2 in column vdot_bx, found 1e+39
void require_plausible(const std::string& path, const Flight& flight);

/// Throws InputError where a command stands still in a block of a flight that was read from `path`: it teaches nothing.
/// `block_name`: "training".
void require_varied_commands(const std::string& path, const Flight& flight, const IndexRange& block,
                             const std::string& block_name);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/data/impl/plausibility.hpp"
#endif
