// SPDX-License-Identifier: MIT
// The recipe `structured`: the paper's networks, and beside them the model of fit_structured(), monotone by
// construction.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <memory>
#include <variant>

#include "command_line/interrupt.hpp"
#include "command_line/parallel.hpp"
#include "pinnquad/training/structured/fit_structured.hpp"
#include "training/campaign.hpp"

namespace programs {

namespace {

/// "10.15e-3"
std::string thousandths(double error) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2fe-3", 1e3 * error);
  return text;
}

std::string reason_of(const pinnquad::StructuredFits::Choice& choice) {
  if (!choice.error_with) return "as --altitude asks";
  return "error on the validation rows with it " + thousandths(*choice.error_with) + ", without " +
         thousandths(*choice.error_without) + (choice.taken ? "" : "; a fifth less would take it");
}

/// Side by side over the cores, with progress; Ctrl-C stops them.
class SideBySide {
 public:
  explicit SideBySide(const TrainingPlan& plan) : plan_(plan) {}

  template <class Job>
  void run(std::size_t count, const Job& job) {
    const std::string what =
        std::to_string(count) + " structured models" + (chosen_ ? "" : ", with the altitude and without");
    const double all_epochs = static_cast<double>(count) * plan_.epochs;
    epochs_done_ = 0;
    run_parallel(
        plan_.silent ? "" : "training " + what, count, plan_.threads,
        [&] { return static_cast<double>(epochs_done_.load()) / all_epochs; },
        [&](std::size_t i) {
          if (!job(i)) throw Interrupted{};
          epochs_done_.fetch_add(1);
        });
  }
  bool goes_on(int epoch) {
    if (epoch > 0) epochs_done_.fetch_add(1);
    return !interrupted();
  }
  void chose(const pinnquad::StructuredFits::Choice& choice) {
    chosen_ = true;
    if (plan_.silent) return;
    std::printf("      the structured model is %s the altitude: %s\n", choice.taken ? "shown" : "not shown",
                reason_of(choice).c_str());
    std::fflush(stdout);
  }

 private:
  const TrainingPlan& plan_;
  std::atomic<long> epochs_done_{0};
  bool chosen_ = false;
};

/// One model per seed.
std::vector<Training> train_structured(const TrainingPlan& plan) {
  pinnquad::StructuredSettings settings;
  settings.residual.epochs = plan.epochs;
  settings.pinned_slopes = plan.pinned_slopes;
  settings.altitude = plan.altitude;
  settings.first_seed = plan.first_seed;
  settings.seeds = plan.seeds;
  const pinnquad::StructuredFits fits = pinnquad::fit_structured(plan.split, plan.airframe, settings, SideBySide(plan));
  const pinnquad::StructuredFits::Choice& choice = fits.altitude;
  nlohmann::json altitude = {{"asked", plan.altitude == AltitudeRule::yes  ? "yes"
                                       : plan.altitude == AltitudeRule::no ? "no"
                                                                           : "auto"},
                             {"validation_mae", nullptr},
                             {"validation_mae_without", nullptr},
                             {"least_gain", settings.least_altitude_gain},
                             {"taken", choice.taken},
                             {"why", reason_of(choice)}};
  if (choice.error_with) altitude["validation_mae"] = *choice.error_with;
  if (choice.error_without) altitude["validation_mae_without"] = *choice.error_without;
  std::vector<Training> done;
  for (const pinnquad::StructuredFits::Fit& fit : fits.models) {
    const auto network = std::visit(
        [](const auto& model) -> std::shared_ptr<const TrainedNetwork> {
          using Model = std::decay_t<decltype(model)>;
          return std::make_shared<NetworkOfModel<Model, ExportedAirframe::by_value, true>>(model);
        },
        fit.model);
    done.push_back({structured, fit.seed, fit.training_s, network, altitude});
  }
  return done;
}

/// Those that are asked for by the paper's recipe, then the structured ones. The latter are trained first: they take a
/// moment, and one of them is exported.
std::vector<Training> train_all_and_structured(const TrainingPlan& plan) {
  TrainingPlan of_paper = plan;
  of_paper.losses.clear();
  for (const LossName& loss : plan.losses) {
    if (!is_structured(loss)) of_paper.losses.push_back(loss);
  }
  std::vector<Training> own, all;
  if (of_paper.losses.size() < plan.losses.size()) own = train_structured(plan);
  if (!of_paper.losses.empty()) all = paper_recipe().train(of_paper);
  for (Training& training : own) all.push_back(std::move(training));
  return all;
}

/// Of the paper's features and of the model's own, each once. An altitude that stands still is none of those, unless it
/// is asked for: no validation row gains by it.
std::vector<std::string> still_features_of_both(const TrainingPlan& plan) {
  std::vector<std::string> all = pinnquad::still_features<pinnquad::PaperFeatures>(plan.split.train);
  for (const std::string& name : plan.altitude == AltitudeRule::yes
                                     ? pinnquad::still_features<pinnquad::InverseFeaturesWithAltitude>(plan.split.train)
                                     : pinnquad::still_features<pinnquad::InverseFeatures>(plan.split.train)) {
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
  recipe.train = train_all_and_structured;
  recipe.besides = {structured};
  recipe.besides_in_words =
      std::string(structured.title) + ": affine map of " + std::to_string(pinnquad::InverseFeatures::size) +
      " features, " + std::to_string(pinnquad::MonotoneBase<pinnquad::InverseFeatures>::parameter_count) +
      " numbers, and on what it leaves " +
      network_in_words<pinnquad::StructuredFits::Residual<pinnquad::InverseFeatures>>("2 x 32 ReLU") +
      ", kept where the validation rows gain";
  recipe.still_features = still_features_of_both;
  return recipe;
}

}  // namespace programs
