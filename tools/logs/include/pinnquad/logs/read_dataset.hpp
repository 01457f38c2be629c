// SPDX-License-Identifier: MIT
// From what a vehicle recorded to one dataset: logs, whose columns get their meaning from a mapping, flights as CSV
// files, a folder of imported flights. The cost of each step is counted in rows.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pinnquad/data/dataset.hpp"

namespace pinnquad::logs {

/// One thing that was done to the rows, and what it cost.
struct ImportStep {
  std::string name;  ///< "saturated"
  std::size_t rows_before = 0;
  std::size_t rows_after = 0;
  std::string told;  ///< how, in a few words: "a command below 0.005 or above 0.995"
};

/// From a command u, 0 to 1, to thrust over that at u = 1: (1 - k) u + k u^2. The airframe's where one was given.
struct CommandCurve {
  double k = 0;
  bool fitted = false;  ///< to the flights; else as the mapping or the log says, or straight
  std::string told;     ///< one line: which, from what, how to overrule it; empty: an airframe says it
};

/// Flights as a training takes them. Row k holds the commands that cause the motion of row k. Where velocity is absent,
/// the linear acceleration is specific force + R^T g: what it is with v = 0.
struct ImportedDataset {
  Dataset flights;
  std::vector<std::string> sources;  ///< the log of each flight
  std::vector<std::string> absent;   ///< quantities that the logs lack, filled with 0: "velocity", "altitude"
  double sample_period_s = 0;
  double lag_removed_s = 0;  ///< by how much later than told the commands stand in the rows
  std::string airframe;
  CommandCurve curve;
  std::string mapping;
  std::vector<std::string> taken;  ///< the mapping that logs asked for, where none was given, and why
  std::vector<ImportStep> steps;
  std::vector<std::string> notes;           ///< how what the logs lack was computed
  std::vector<std::string> warnings;        ///< what looks wrong
  std::vector<std::string> contradictions;  ///< of these, with the file: what no model should learn from
  std::vector<std::string> unlike;          ///< flights of another vehicle or payload than the others

  bool lacks(const std::string& quantity) const {
    for (const std::string& missing : absent) {
      if (missing == quantity) return true;
    }
    return false;
  }
};

/// Is told the job and the share of it that is done, 0..1; what it throws ends the reading. May be empty.
using OnProgress = std::function<void(const std::string& job, double share)>;

struct LogSettings {
  std::string mapping;  ///< the name of a ready one, or a TOML file; empty: of each log what its content asks for
  /// Gives rotor speeds and thrusts their commands, and the motors their places: a name or a TOML file; empty: that of
  /// the mapping. Without one thrust is proportional to the command, and PX4's motor order holds.
  std::string airframe;
  std::optional<double> rate_hz;  ///< empty: that of the slowest of commands, body rates and force, at most 100
  std::optional<double> lag_s;    ///< from command to motion; empty: estimated
  /// k of a rotor's thrust (1 - k) u + k u^2 by the motor's value u; empty: as mapping or log says, else fitted. Throws
  /// std::invalid_argument where the motors are rotor speeds.
  std::optional<double> thrust_curve;
  double from_s = 0;            ///< of each log, from its first row on: rows before are left out
  std::optional<double> to_s;   ///< and rows after; empty: to the end
  std::optional<double> cut_s;  ///< flights are cut into parts of about this length; empty: they stay whole
  bool hold_commands = false;   ///< a command holds until the next row, where lines are drawn between rows otherwise
  bool keep_saturated = false;  ///< rows with a command at its limit stay: what the motors were given is known
  OnProgress on_progress;
  /// Is given the flights before they are compared, which takes longest: what it throws ends the reading.
  std::function<void(const ImportedDataset&)> on_flights;
};

/// Logs of any kind and folders of them, told apart by their content: ULog files, ulog2csv's folders, blackbox and
/// DataFlash logs, Crazyflie's, CSV tables. Throws InputError and
/// std::invalid_argument, one line, for logs and mappings that give no dataset.
ImportedDataset read_dataset(const std::vector<std::string>& logs, const LogSettings& settings);

/// A mapping that the library brings (examples/mappings).
struct ReadyMapping {
  std::string name;   ///< "px4"
  std::string about;  ///< one line
};
std::vector<ReadyMapping> ready_mappings();

/// "arpl, nanobench, px4": for messages and help.
std::string mapping_names();

/// Flights as CSV files (data/csv.hpp), each named by its file, with the extra columns asked for. One file has
/// `minimum_rows` or more, and so have several in sum. Throws InputError, and std::invalid_argument for too few rows in
/// all and for a flight that comes twice.
Dataset read_flights(const std::vector<std::string>& paths, std::size_t minimum_rows,
                     const std::vector<ColumnName>& extra = {}, const OnProgress& on_progress = {});

/// The extra columns that all of these CSV files have. Throws InputError.
std::vector<ColumnName> shared_columns(const std::vector<std::string>& paths);

/// Told apart by content: a dataset is a folder with a dataset.json, a flight is a CSV table with most of the columns
/// of every flight, and the rest are logs. Throws InputError where nothing can be read.
enum class SourceKind { flights, dataset, logs };
SourceKind kind_of_source(const std::string& path);

/// The kind that all of them have: logs, where there is a mapping. Throws InputError and std::invalid_argument, one
/// line: none, several kinds, two datasets, logs without a mapping.
SourceKind kind_of_sources(const std::vector<std::string>& paths, const std::string& mapping);

/// Flights of any source: paths of one kind, or one dataset, with the extra columns that all have. Where `settings`
/// have a mapping the paths are logs; for flights and datasets only `on_progress` counts. Throws InputError and
/// std::invalid_argument, one line.
ImportedDataset read_source(const std::vector<std::string>& paths, const LogSettings& settings = {});

/// Throws std::invalid_argument, one line, where two flights hold the same rows, or one the liveliest of the other,
/// from another clock or rounded; `places`: their files, if they have some.
void require_different_flights(const Dataset& dataset, const std::vector<std::string>& places = {});

}  // namespace pinnquad::logs
