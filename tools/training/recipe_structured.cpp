// SPDX-License-Identifier: MIT
// The recipe `structured`: the paper's networks, and beside them the model of fit_structured(), monotone by
// construction.
#include <algorithm>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "command_line/interrupt.hpp"
#include "pinnquad/training/structured/fit_structured.hpp"
#include "training/network_kinds.hpp"
#include "training/recipe.hpp"

namespace programs {

namespace {

/// The export of train by default, and how it was chosen whether it is shown the altitude.
template <class Model>
class StructuredNetwork : public NetworkOfModel<Model, ExportedAirframe::by_value, true> {
 public:
  StructuredNetwork(const Model& model, const AltitudeChoice& altitude)
      : NetworkOfModel<Model, ExportedAirframe::by_value, true>(model), altitude_(altitude) {}
  AltitudeChoice altitude() const override { return altitude_; }

 private:
  AltitudeChoice altitude_;
};

/// Work of fit_structured(): one fit after the other, with progress; Ctrl-C stops it.
class InTurn {
 public:
  explicit InTurn(const FitTask& task, int epochs) : task_(task), epochs_(epochs) {}

  template <class Job>
  void run(std::size_t count, const Job& job) {
    fits_ = static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (!job(i)) throw Interrupted{};
      done_ += 1;
    }
  }
  bool goes_on(int epoch) const {
    task_.share_done((done_ + static_cast<double>(epoch) / epochs_) / fits_);
    return !interrupted();
  }
  void chose(const pinnquad::StructuredFits::Choice&) const {}

 private:
  const FitTask& task_;
  int epochs_;
  double fits_ = 1, done_ = 0;
};

std::shared_ptr<const TrainedNetwork> fit_one_structured(const FitTask& task) {
  using Rule = pinnquad::StructuredSettings::Altitude;
  pinnquad::StructuredSettings settings;
  settings.residual.epochs = task.epochs > 0 ? task.epochs : recipe_epochs;
  settings.pinned_slopes = task.settings.pinned_slopes;
  settings.altitude = task.lacks("altitude")    ? Rule::no
                      : !task.settings.altitude ? Rule::by_validation
                      : *task.settings.altitude ? Rule::yes
                                                : Rule::no;
  settings.first_seed = task.seed;
  settings.seeds = 1;
  const pinnquad::RowSplit split{task.training, task.validation, {}};
  const pinnquad::StructuredFits fits =
      pinnquad::fit_structured(split, task.given_airframe(), settings, InTurn(task, settings.residual.epochs));
  AltitudeChoice altitude;
  altitude.applies = true;
  altitude.taken = fits.altitude.taken;
  altitude.error_with = fits.altitude.error_with.value_or(pinnquad::not_a_number);
  altitude.error_without = fits.altitude.error_without.value_or(pinnquad::not_a_number);
  return std::visit(
      [&](const auto& model) -> std::shared_ptr<const TrainedNetwork> {
        return std::make_shared<StructuredNetwork<std::decay_t<decltype(model)>>>(model, altitude);
      },
      fits.best().model);
}

/// Of the paper's features and of the model's own, each once. An altitude that stands still is none of those, unless it
/// is asked for: no validation row gains by it.
std::vector<std::string> still_features_of_both(const FitTask& task) {
  std::vector<std::string> all = still_paper_features(task);
  for (const std::string& name : task.settings.altitude.value_or(false)
                                     ? pinnquad::still_features<pinnquad::InverseFeaturesWithAltitude>(task.training)
                                     : pinnquad::still_features<pinnquad::InverseFeatures>(task.training)) {
    if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
  }
  return all;
}

}  // namespace

Recipe structured_recipe() {
  Recipe recipe = paper_recipe();
  recipe.name = "structured";
  recipe.summary =
      "the paper's networks, and beside them a model that is monotone by construction (ridge and 2 x 32 ReLU), which "
      "is exported";
  recipe.settings["structured"] = {{"base", "ridge, own angular acceleration"},
                                   {"residual", "2 x 32 ReLU, no angular acceleration"},
                                   {"learning_rate", pinnquad::ResidualTraining{}.learning_rate},
                                   {"weight_decay", pinnquad::ResidualTraining{}.weight_decay},
                                   {"least_gain", pinnquad::ResidualTraining{}.least_gain},
                                   {"least_altitude_gain", pinnquad::StructuredSettings{}.least_altitude_gain}};
  recipe.kinds.push_back({"structured", "structured", TimeReach::present, true, needs_velocity, fit_one_structured,
                          false, pinnquad::structured_in_words});
  recipe.besides_in_words =
      "structured: affine map of " + std::to_string(pinnquad::InverseFeatures::size) + " features, " +
      std::to_string(pinnquad::MonotoneBase<pinnquad::InverseFeatures>::parameter_count) +
      " numbers, and on what it leaves " +
      network_in_words<pinnquad::StructuredFits::Residual<pinnquad::InverseFeatures>>("2 x 32 ReLU") +
      ", kept where the validation rows gain";
  recipe.still_features = still_features_of_both;
  return recipe;
}

}  // namespace programs
