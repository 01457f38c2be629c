// SPDX-License-Identifier: MIT
// Crashes in a log: rows in which the gyro is at the end of its range, or a force pushes that no rotor makes.
#pragma once

#include <string>
#include <vector>

#include "logs/common_rows.hpp"
#include "logs/row_checks.hpp"

namespace pinnquad::logs {

struct Tumbling {
  RowMask out;                    ///< empty for none
  std::vector<std::string> told;  ///< "0.4 s of tumbling at 23.6 s", time from the first row
};

/// Three rows or more within half a second with a rate at the end of the gyro's range (34 rad/s, 1950 degrees/s, or
/// where it stays at its own extreme above 15 rad/s), or a specific force across the rotors' axis of 40 m/s^2 and ten
/// robust deviations, or one that pushes down by as much; and what is between them and 0.15 s around them, where
/// windows of derivatives reach. More than a tenth of the rows is no crash: another unit, most often.
Tumbling find_tumbling(const CommonRows& rows);

/// Rows that nothing is made of: rates and forces become NaN.
void leave_out(CommonRows& rows, const RowMask& out);

}  // namespace pinnquad::logs
