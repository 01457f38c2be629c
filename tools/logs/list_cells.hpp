// SPDX-License-Identifier: MIT
// Cells that hold a list of numbers, as pandas writes a table of vectors and matrices: "[0.1, -2.0, 9.8]".
#pragma once

#include "pinnquad/logs/flight_log.hpp"

namespace pinnquad::logs {

/// A column of lists becomes columns of numbers: p[0], p[1], p[2]; of a matrix R[0][0], R[0][1] ... Numbers stand
/// between commas or blanks. Columns of other text stay. Throws InputError with the row where a list has other numbers
/// than the first one.
void expand_lists(LogTopic& topic);

}  // namespace pinnquad::logs
