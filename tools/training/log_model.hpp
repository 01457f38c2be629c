// SPDX-License-Identifier: MIT
// A kind of model that `train` fits to logged flights and compares with the others: one entry of a table. Each kind is
// a translation unit of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "airframe/choice.hpp"
#include "pinnquad/data/row_set.hpp"
#include "training/trained_network.hpp"

namespace programs {

/// Times of the motion that a kind of model sees. Ranked apart: a centred model looks ahead, and flies planned
/// trajectories only.
enum class TimeReach { present, causal, centred };

/// The target of a fit.
struct LogFit {
  const NamedAirframe& airframe;
  const pinnquad::RowSet& training;
  const pinnquad::RowSet& validation;  ///< other flights than those that train; chooses between models, never the test
  const std::vector<std::string>& absent;  ///< quantities that the logs lack: "velocity", "altitude"
  double sample_period_s = 0;
  std::uint64_t seed = 1;
  int epochs = 0;  ///< 0: what suits the kind
};

struct LogModelKind {
  const char* key;    ///< in report.json: "ridge"
  const char* title;  ///< in tables: "ridge on physics features"
  TimeReach reach = TimeReach::present;
  bool seeded = false;  ///< false: closed form, one fit whatever the seed
  /// Why it can't be fitted to these rows ("needs velocity, which the logs lack"); empty if it can.
  std::string (*not_applicable)(const LogFit&);
  /// Throws std::invalid_argument, one line, where the data leave it without an answer.
  std::shared_ptr<const TrainedNetwork> (*fit)(const LogFit&);
  /// fit() is fitted to the validation rows too: what it says of them is no measure of it. Without them it does as
  /// well.
  bool takes_validation = false;
};

/// All kinds, the simplest first: constant, physics, linear, linearized, ridge, vanilla, physics_informed, structured;
/// ridge and structured also with "_causal" and "_centred" windows.
/// Those that validation rows stop (vanilla, physics_informed) train on the training rows; those that choose by leaving
/// out trajectories in turn have to be left nothing else.
const std::vector<LogModelKind>& log_model_kinds();

}  // namespace programs
