// SPDX-License-Identifier: MIT
// A kind of model that `train` fits and compares with others: one entry of a table. Each kind is a translation unit of
// its own, or a few lines of one.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "airframe/choice.hpp"
#include "pinnquad/data/row_set.hpp"
#include "training/shared_by_fits.hpp"
#include "training/trained_network.hpp"

namespace programs {

/// Times of the motion that a kind of model sees. Ranked apart: a centred model looks ahead, and flies planned
/// trajectories only.
enum class TimeReach { present, causal, centred };

/// Options of `train` for the structured kinds, and for what it exports.
struct FitSettings {
  bool library_airframe = false;  ///< the program knows it by name: of_library_airframe()
  std::optional<bool> altitude;   ///< is the model shown it? none: where the validation rows gain much
  bool pinned_slopes = false;     ///< to the airframe's in hover; false: learnt
  bool fit_validation = false;    ///< of the structured model: no rows are left to find limits of trust by
  bool without_residual = false;  ///< its closed form alone: to be compared with other kinds
};

/// Epochs of flights' networks where --epochs does not say another number.
inline constexpr int recipe_epochs = 300;

/// The target of a fit.
struct FitTask {
  const NamedAirframe& airframe;
  const pinnquad::RowSet& training;
  const pinnquad::RowSet& validation;      ///< other rows than those that train; chooses between models, never the test
  const std::vector<std::string>& absent;  ///< quantities that the flights lack: "velocity", "altitude"
  double sample_period_s = 0;
  std::uint64_t seed = 1;
  int epochs = 0;  ///< 0: what suits the kind
  FitSettings settings{};
  std::function<void(double)> share_done = [](double) {};  ///< told now and then, 0 to 1
  /// With the other fits to this parting.
  std::shared_ptr<SharedByFits> shared = std::make_shared<SharedByFits>();

  bool lacks(const std::string& quantity) const {
    for (const std::string& missing : absent) {
      if (missing == quantity) return true;
    }
    return false;
  }
  pinnquad::GivenAirframe given_airframe() const { return {airframe.name, airframe.value}; }
};

inline bool never_takes_validation(const FitSettings&) { return false; }
inline bool takes_validation_rows(const FitSettings&) { return true; }

struct ModelKind {
  const char* key;    ///< in report.json: "ridge"
  const char* title;  ///< in tables: "ridge on physics features"
  TimeReach reach = TimeReach::present;
  bool seeded = false;  ///< false: closed form, one fit whatever the seed
  /// Why it can't be fitted to these rows ("needs velocity, which the logs lack"); empty if it can.
  std::string (*not_applicable)(const FitTask&);
  /// Throws std::invalid_argument, one line, where the data leave it without an answer.
  std::shared_ptr<const TrainedNetwork> (*fit)(const FitTask&);
  /// fit() is fitted to the validation rows too: what it says of them is no measure of it. Without them it does as
  /// well.
  bool (*takes_validation)(const FitSettings&) = never_takes_validation;
  const char* words = nullptr;  ///< its training, in an exported header; null: the title says it
  bool exportable = true;       ///< false: to be compared with alone
  bool quick = false;           ///< a fit takes moments (FitSettings::without_residual): every flight judges it in turn
};

inline std::string always_applicable(const FitTask&) { return ""; }

inline std::string needs_velocity(const FitTask& fit) {
  return fit.lacks("velocity") ? "needs velocity, which the logs lack" : "";
}

/// Those that logs are compared by, the simplest first: constant, last_commands, physics, linear, linearized, ridge,
/// vanilla, physics_informed, structured; ridge and structured also with "_causal" and "_centred" windows.
/// Those that validation rows stop (vanilla, physics_informed) train on the training rows; those that choose by leaving
/// out trajectories in turn have to be left nothing else.
const std::vector<ModelKind>& log_model_kinds();

}  // namespace programs
