// SPDX-License-Identifier: MIT
// Unconstrained models: the paper's network on other features and under another loss, and an affine map.
#include <random>

#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/regression/ridge.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/structured/closed_form.hpp"
#include "pinnquad/training/trainer.hpp"
#include "study/beyond_models.hpp"
#include "training/best_recipe.hpp"
#include "training/paper_network.hpp"

namespace study {

namespace {

/// Those of the structured model.
using Shown = pinnquad::InverseFeatures;

template <class Answer, class AnyContext>
std::shared_ptr<const programs::TrainedNetwork> judged(const Answer& answer, const AnyContext& context,
                                                       const pinnquad::RowSet& rows) {
  const auto model = pinnquad::make_trained_model(answer, context, rows);
  return std::make_shared<programs::BlockNetwork>(pinnquad::ground_model(model), rows);
}

/// The paper's network, its last weights.
template <class Shown, class Loss>
BeyondTraining train_network(const BeyondTask& task, const Loss& loss, double weight_decay) {
  using namespace programs::best;
  using Context = pinnquad::Context<Shown, pinnquad::GivenAirframe>;
  using Network = programs::PaperNetwork<Shown>;
  using Trainer = pinnquad::Trainer<Network, Loss, Optimizer, Context, pinnquad::ShuffledBatches, batch_size>;
  const auto context = pinnquad::make_context<Context>(task.split.train, task.airframe);
  const auto data = pinnquad::standardised<float>(context, task.split.train);
  std::mt19937_64 engine(task.seed);
  const auto trainer =
      std::make_unique<Trainer>(pinnquad::initialised<Network>(engine), loss, optimizer(weight_decay), context);
  for (int epoch = 0; epoch < task.epochs; ++epoch) {
    if (!task.goes_on()) return {};
    trainer->epoch(data, {epoch, task.epochs}, engine);
  }
  return {judged(trainer->network(), context, task.split.train), false, false};
}

}  // namespace

BeyondTraining train_network_on_physics(const BeyondTask& task) {
  return train_network<Shown>(task, pinnquad::Mse{}, programs::best::vanilla_decay);
}

BeyondTraining train_match(const BeyondTask& task) {
  using namespace programs::best;
  using Loss = pinnquad::PaperLoss<pinnquad::CyclicalAnnealing, pinnquad::Match>;
  return train_network<pinnquad::PaperFeatures>(task, with_schedule(Loss{}, annealed_weight()), informed_decay);
}

BeyondTraining train_paper_with_altitude(const BeyondTask& task) {
  using namespace programs::best;
  return train_network<pinnquad::PaperFeaturesWithAltitude>(task, physics_loss(annealed_weight()), informed_decay);
}

BeyondTraining train_ridge(const BeyondTask& task) {
  using Context = pinnquad::Context<Shown, pinnquad::GivenAirframe>;
  const auto context = pinnquad::make_context<Context>(task.split.train, task.airframe);
  const auto groups = pinnquad::regression_sums(context, pinnquad::left_out_groups(task.split.train));
  pinnquad::RegressionSums sums = groups.front();
  for (std::size_t i = 1; i < groups.size(); ++i) sums += groups[i];
  const double penalty = groups.size() < 2 ? 0.0 : pinnquad::choose_penalty(groups);
  const auto answer = pinnquad::affine_answer<Context>(pinnquad::fit_ridge(sums, penalty));
  return {judged(answer, context, task.split.train), false, false};
}

}  // namespace study
