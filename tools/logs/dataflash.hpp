// SPDX-License-Identifier: MIT
// ArduPilot's DataFlash logs (.bin): messages that FMT messages describe, in the log itself. A message is a topic, its
// instance the number in the column that FMTU marks; columns are in the units that the log has, with the factors of
// their formats (c, C, e, E: a hundredth; L: 1e-7). PARM messages are parameters.
#pragma once

#include <string>
#include <string_view>

#include "pinnquad/logs/read_log.hpp"

namespace pinnquad::logs {

/// Whether a file begins as a DataFlash log; its first bytes tell.
bool is_dataflash_log(std::string_view begin);

/// A log that stands in memory; `name` is what messages call it. Bytes that are no message, and messages whose
/// format is not understood, are left out, and `warnings` say so. "motorOutput[0]" and "motorOutput[1]" are parameters
/// of a copter's log: the pulses that its mixer sends for no thrust and for all of it, us, by MOT_PWM_MIN, MOT_PWM_MAX,
/// MOT_SPIN_MIN and MOT_SPIN_MAX. "Motor1" and on are columns of RCOU: the outputs that SERVOn_FUNCTION makes motors.
///
/// Throws InputError, one line, for what is no DataFlash log.
FlightLog parse_dataflash(std::string_view file, const std::string& name, const LogSelection& selection = {});

}  // namespace pinnquad::logs
