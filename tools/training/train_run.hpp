// SPDX-License-Identifier: MIT
// `train`, from a source of flights to a judged, exported model and its report.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace programs {

struct TrainOptions {
  std::vector<std::string> flights;  ///< recorded flights as CSV; or
  std::string dataset;               ///< folder that `import` wrote; or
  std::vector<std::string> logs;     ///< logs to import
  std::string mapping;
  std::vector<std::string> hold_out;  ///< flights or trajectories
  std::string hold_out_each;          ///< "flight", "trajectory"; empty: those of hold_out
  std::vector<std::string> validate;  ///< flights or trajectories that alone choose what is exported; empty: all do
  std::vector<std::string> models;    ///< keys of kinds; empty: what flights, or logs, are compared by
  std::string export_choice;          ///< empty: Selection::exported()
  std::optional<bool> altitude;       ///< of the structured kinds, as what follows; none: validation says
  bool pinned_slopes = false;
  std::string airframe;         ///< empty: none was given
  double from_s = 0;            ///< of each log, from its first row
  std::optional<double> to_s;   ///< and to there
  std::optional<double> lag_s;  ///< of flights and logs, from command to motion; none: estimated
  std::string out = "demo_out";
  std::string model_name = "TrainedQuadModel";
  int seeds = 5;
  int epochs = 0;  ///< 0: what suits each kind
  std::uint64_t seed = 1;
  unsigned threads = 0;
  bool verbose = false;     ///< details beside the verdict and the table
  bool allow_poor = false;  ///< export what is worse than the mean, marked as such

  /// Of what was imported.
  std::string dataset_folder() const { return logs.empty() ? dataset : out + "/dataset"; }
};

/// The exit code of the command.
int train(const TrainOptions& options);

}  // namespace programs
