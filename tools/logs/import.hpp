// SPDX-License-Identifier: MIT
// From flight logs to one dataset: which columns mean what is said by a mapping, what each step costs is counted.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "airframe/file.hpp"
#include "logs/imported_dataset.hpp"

namespace programs {

struct ImportRequest {
  std::vector<std::string> logs;  ///< ULog files, CSV tables, folders of ulog2csv, folders of ULog files
  std::string mapping;            ///< the name of a ready one, or a TOML file
  /// Gives rotor speeds and thrusts their commands, and the motors their places. Without one thrust is proportional to
  /// the command, and PX4's motor order holds.
  std::optional<NamedAirframe> airframe;
  std::optional<double> rate_hz;  ///< empty: that of the slowest of commands, body rates and force, at most 100
  std::optional<double> lag_s;    ///< from command to motion; empty: estimated
  bool hold_commands = false;     ///< a command holds until the next row, where lines are drawn between rows otherwise
  std::function<void(const std::string& job, double share)> on_progress = [](const std::string&, double) {};
};

/// Throws InputError and std::invalid_argument, one line, for logs and mappings that give no dataset; whatever
/// `on_progress` throws.
ImportedDataset import_logs(const ImportRequest& request);

}  // namespace programs
