// SPDX-License-Identifier: MIT
// The list of who competes in `study beyond`. The paper's networks train as the study of Table 2 does.
#include "study/beyond_models.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "command_line/listed.hpp"
#include "training/recipe.hpp"

namespace study {

namespace {

/// A network that a recipe of `train` makes.
class JudgedNetwork : public JudgedModel {
 public:
  explicit JudgedNetwork(std::shared_ptr<const programs::TrainedNetwork> network) : network_(std::move(network)) {}
  programs::Predictions predictions(const pinnquad::RowSet& rows) const override { return network_->predictions(rows); }
  programs::DerivativeFigures derivatives(const pinnquad::RowSet& rows) const override {
    return network_->derivatives(rows);
  }

 private:
  std::shared_ptr<const programs::TrainedNetwork> network_;
};

/// Eq. (3) inverted, with the airframe as it is told.
class JudgedFormula : public JudgedModel {
 public:
  explicit JudgedFormula(pinnquad::ContextAirframe<pinnquad::GivenAirframe> airframe)
      : airframe_(std::move(airframe)) {}
  programs::Predictions predictions(const pinnquad::RowSet& rows) const override {
    return programs::linear_predictions(airframe_.airframe<double>(), rows);
  }
  programs::DerivativeFigures derivatives(const pinnquad::RowSet& rows) const override {
    return programs::derivative_figures(rows, programs::LinearDerivatives(airframe_));
  }

 private:
  pinnquad::ContextAirframe<pinnquad::GivenAirframe> airframe_;
};

BeyondTraining evaluate_formula(const BeyondTask& task) {
  return {std::make_shared<JudgedFormula>(task.airframe), false, false};
}

std::function<BeyondTraining(const BeyondTask&)> by_recipe(programs::Recipe (*recipe)(),
                                                           const programs::LossName& loss) {
  return [recipe, loss](const BeyondTask& task) {
    programs::TrainingPlan plan{task.airframe, false, task.split, {loss}, task.epochs, task.seed};
    plan.silent = true;
    BeyondTraining result;
    for (const programs::Training& training : recipe().train(plan)) {
      result.model = std::make_shared<JudgedNetwork>(training.network);
    }
    return result;
  };
}

template <BeyondTraining (*Train)(const BeyondTask&, Slopes)>
std::function<BeyondTraining(const BeyondTask&)> with(Slopes slopes) {
  return [slopes](const BeyondTask& task) { return Train(task, slopes); };
}

}  // namespace

std::vector<BeyondModel> beyond_models() {
  using programs::best_recipe;
  return {
      {"formula", "Eq. (3) inverted", true, false, evaluate_formula},
      {"vanilla", "10 x 25 ReLU on the paper's features, MSE", false, true, by_recipe(best_recipe, programs::vanilla)},
      {yardstick, "the same, physics-informed: the paper's network", false, true,
       by_recipe(best_recipe, programs::physics_informed)},
      {"vanilla_physics", "10 x 25 ReLU on physics features, MSE", false, true, train_network_on_physics},
      {"ridge", "affine ridge on physics features", false, false, train_ridge},
      {"structured", "ridge, slopes above 0, 2 x 32 ReLU without angular acceleration", true, true,
       with<train_structured_on_ridge>(Slopes::learnt)},
      {"structured_pinned", "the same, slopes the airframe's", true, true,
       with<train_structured_on_ridge>(Slopes::pinned)},
      {"structured_rigid", "ridge on the rigid body's inverse, slopes above 0, 2 x 32 ReLU", true, true,
       with<train_structured_on_rigid_body>(Slopes::learnt)},
      {"structured_rigid_pinned", "the same, slopes the airframe's", true, true,
       with<train_structured_on_rigid_body>(Slopes::pinned)},
  };
}

std::vector<BeyondModel> chosen_models(std::vector<BeyondModel> all, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (std::any_of(all.begin(), all.end(), [&name](const BeyondModel& m) { return m.name == name; })) continue;
    throw std::invalid_argument("--models: no model '" + name +
                                "'; known: " + programs::listed(all, [](const BeyondModel& m) { return m.name; }));
  }
  if (names.empty()) return all;
  std::vector<BeyondModel> chosen;
  std::copy_if(all.begin(), all.end(), std::back_inserter(chosen), [&names](const BeyondModel& model) {
    return model.name == yardstick || std::find(names.begin(), names.end(), model.name) != names.end();
  });
  return chosen;
}

}  // namespace study
