// SPDX-License-Identifier: MIT
// Rows of a flight that nothing should be learned from: motors idle or at their limits, the vehicle on the ground,
// values like none of their neighbours.
#pragma once

#include <vector>

#include "logs/derived_motion.hpp"
#include "logs/mapping.hpp"

namespace pinnquad::logs {

/// Per row of a flight: leave it out?
using RowMask = std::vector<bool>;

/// A command at `lowest` or `highest`, to a thousandth, or at its own extreme where that was held for five rows
/// somewhere (a limit of the mapping or the mixer below 1): the motor may have been asked for more than the log shows.
/// To be asked of commands as they were logged: a mean over rows is hardly ever at the limit.
/// As many of a flight's rows, from its first on.
Flight first_rows(const Flight& flight, std::size_t count);

RowMask saturated_rows(const Flight& flight, double lowest = 0, double highest = 1);

/// Rows where something else than the rotors bears the vehicle: the specific force along z is what the commands make in
/// the air (the median ratio of rows with 60 % or more of the usual high collective) and, on the ground, what it bears;
/// a vehicle that stands with idle motors reads the same 9.81 m/s^2 as one that hovers. There the whole force is the
/// weight, and the speed low: what air bears in a fast descent is neither. Needs no land detector and no height.
/// Limits: commands whose thrust is strongly curved (rotor speed) look like ground too soon; spool-up just before
/// lift-off is only covered by half a second around a contact; a log of which less than a fiftieth is in the air has no
/// usual collective.
RowMask grounded_rows(const Flight& flight, double period_s);

/// Rows with a value of a measured column that none of its neighbours comes near: further from the median of seven rows
/// than twelve robust deviations of such distances (and of half of what plausibility.hpp calls the smallest
/// scale), with both neighbours not half as far. Time and commands, which may jump, are not judged. Limits: two wrong
/// rows in succession are taken for motion.
RowMask outlier_rows(const Flight& flight);

/// True where the vehicle stands on the ground: the log says landed, it is lower than the mapping says, or something
/// else than the rotors bears it.
RowMask on_the_ground(const LogRows& rows, const Mapping& mapping, double period_s);

bool is_idle(const Sample& sample, const Mapping& mapping);

/// The rows that stay.
Flight without(Flight flight, const RowMask& out);

/// Parts at steps in time longer than `gap_s`.
std::vector<Flight> split_at_gaps(Flight flight, double gap_s);

/// In parts of one length, as near to `part_s` as whole parts are.
std::vector<Flight> cut(Flight flight, double part_s);

/// One after the other, which is in time's order.
Flight joined(std::vector<Flight> parts);

}  // namespace pinnquad::logs
