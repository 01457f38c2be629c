// SPDX-License-Identifier: MIT
// Columns of a flight that repeat a value while what goes with them moves: a sensor that is off or has stopped, a
// logger that writes on what it had last. In all rows, or from some time on. An accelerometer that shows no gravity.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "logs/row_checks.hpp"
#include "pinnquad/data/motion_checks.hpp"

namespace pinnquad::logs {

/// Quantities that a flight has; what it lacks is 0 in all rows, and stands still rightly.
struct HasQuantities {
  bool velocity = true, altitude = true;
  bool motors = true;  ///< commands that stand still are to be told
};

/// Attitude, rates, specific force, velocity, altitude or a motor that is the same in all rows, where its partner
/// contradicts: the attitude turns by the rates, the rates turn the attitude, the force follows the commands, the
/// velocity changes by the force, the altitude by the velocity, the commands vary together. A specific force below 1
/// m/s^2 throughout is no flight. A heading that stays while w_z turns by less than 0.5 rad passes, and so does a
/// vehicle that hovers without noise.
std::optional<detail::Implausible> find_standing_column(const Flight& flight, const HasQuantities& has);

/// A specific force whose size is below 0.6 or above 5 times gravity in half of the rows of five seconds or more: an
/// accelerometer that is off but for its noise, one in another unit, or without gravity. The rotors of what stays in
/// the air carry it: the mean of R f + g is the change of velocity over the time.
std::optional<detail::Implausible> find_wrong_gravity(const Flight& flight);

/// Rows in which such a column stands still for half a second or longer, five times as long as it otherwise does, a
/// tenth of a second around them included; of each column what it is and when:
/// "columns w_x, w_y, w_z: the same for 3.2 s in 1 stretch, first at 12 s, while the attitude turns: left out".
/// Time counts from `begin_s`. A column that stands still in all rows is find_standing_column()'s.
struct StandingRows {
  RowMask out;
  std::vector<std::string> told;
};
StandingRows standing_rows(const Flight& flight, const HasQuantities& has, double period_s, double begin_s);

}  // namespace pinnquad::logs
