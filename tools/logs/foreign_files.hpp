// SPDX-License-Identifier: MIT
// Files that hold a log, or look like one, in a container that is not read: each is named with what to do about it.
#pragma once

#include <string>
#include <string_view>

namespace pinnquad::logs {

/// `begin`: the file's first bytes. Throws InputError, one line with the command that converts it: compressed files,
/// MCAP, ROS bags, MAVLink telemetry, PlotJuggler layouts, HDF5, MATLAB, NumPy, PyTorch, Parquet, JSON, a DataFlash
/// log as text.
void refuse_foreign(const std::string& path, std::string_view begin);

}  // namespace pinnquad::logs
