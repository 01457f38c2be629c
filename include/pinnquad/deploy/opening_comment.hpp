// SPDX-License-Identifier: MIT
// The first lines of an exported header, for whoever opens it: is it for flight, what is proven of it, how it was
// judged.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <ostream>
#include <string>

#include "pinnquad/control/motion_bias.hpp"
#include "pinnquad/core/body.hpp"
#include "pinnquad/deploy/provenance.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/training/structured/measured_slope.hpp"

namespace pinnquad {

/// Slopes as the training rows know them, over the airframe's own: "roll 0.97 to 1.02"; by smoothed rows with what
/// least squares of the rows say. Empty where none is known.
std::string known_slopes_in_words(const SlopesOfSums& slopes, double own_thrust, const AxisSlopes& own,
                                  int decimals = 2);

namespace detail {

/// Lines of a comment, broken at blanks.
void write_comment(std::ostream& out, const std::string& text);

/// Lines of a comment. `own`: the airframe that the slopes are compared with.
void write_opening_comment(std::ostream& out, const WrittenRecords& records, const Airframe<double>& own);

}  // namespace detail
}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/opening_comment.hpp"
#endif
