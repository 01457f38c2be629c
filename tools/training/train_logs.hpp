// SPDX-License-Identifier: MIT
// `train` on flights of a real vehicle: an imported dataset, or logs that it imports first. Whole flights are held out,
// every kind of model is judged on them beside the simpler ones, the best is exported.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace programs {

struct LogTrainingOptions {
  std::string dataset;            ///< folder that `import` wrote; or
  std::vector<std::string> logs;  ///< logs to import
  std::string mapping;
  std::vector<std::string> hold_out;  ///< flights or trajectories
  std::string hold_out_each;          ///< "flight", "trajectory"; empty: those of hold_out
  std::vector<std::string> models;    ///< keys of kinds; empty: all
  std::string export_choice = "causal";
  std::string airframe;  ///< empty: none was given
  std::string out = "demo_out";
  std::string model_name = "TrainedQuadModel";
  int seeds = 5;
  int epochs = 0;  ///< 0: what suits each kind
  std::uint64_t seed = 1;
  unsigned threads = 0;
  bool allow_poor = false;
};

/// The exit code of the command.
int train_on_logs(const LogTrainingOptions& options);

}  // namespace programs
