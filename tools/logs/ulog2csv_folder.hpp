// SPDX-License-Identifier: MIT
// A folder that PX4's ulog2csv wrote: a table per instance of a topic, `<log>_<topic>_<instance>.csv`. Such a folder
// has no parameters, no dropouts, nothing of what the vehicle said; its rows are in the log's order.
#pragma once

#include <set>
#include <string>

#include "pinnquad/logs/read_log.hpp"

namespace pinnquad::logs {

/// The logs whose files stand in a folder. Throws InputError where it cannot be read.
std::set<std::string> ulog2csv_logs(const std::string& folder, const LogSelection& selection);

/// The wanted topics of a log that ulog2csv wrote. Throws InputError, one line: no such folder, no such files in it,
/// files of several logs of which `selection.prefix` chooses none, a table that cannot be read.
FlightLog read_ulog2csv_folder(const std::string& folder, const LogSelection& selection = {});

}  // namespace pinnquad::logs
