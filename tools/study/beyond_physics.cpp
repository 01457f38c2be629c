// SPDX-License-Identifier: MIT
// Unconstrained models on physics features: the paper's network, and an affine map without one.
#include <random>

#include "pinnquad/identification/ridge.hpp"
#include "pinnquad/inference/motion_parts.hpp"
#include "pinnquad/loss/mse.hpp"
#include "pinnquad/training/closed_form.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/trainer.hpp"
#include "study/beyond_models.hpp"
#include "training/best_recipe.hpp"
#include "training/paper_network.hpp"

namespace study {

namespace {

using PhysicsContext = pinnquad::Context<pinnquad::PhysicsFeatures, pinnquad::GivenAirframe>;

template <class Answer>
std::shared_ptr<const JudgedModel> judged(const Answer& answer, const PhysicsContext& context,
                                          const pinnquad::RowSet& rows) {
  const auto model = pinnquad::make_trained_model(answer, context, rows);
  return std::make_shared<JudgedModelOf<std::decay_t<decltype(model)>>>(model);
}

}  // namespace

BeyondTraining train_network_on_physics(const BeyondTask& task) {
  using namespace programs::best;
  using Network = programs::PaperNetwork<pinnquad::PhysicsFeatures>;
  using Trainer =
      pinnquad::Trainer<Network, pinnquad::Mse, Optimizer, PhysicsContext, pinnquad::ShuffledBatches, batch_size>;
  const auto context = pinnquad::make_context<PhysicsContext>(task.split.train, task.airframe);
  const auto data = pinnquad::standardised<float>(context, task.split.train);
  std::mt19937_64 engine(task.seed);
  const auto trainer = std::make_unique<Trainer>(pinnquad::initialised<Network>(engine), pinnquad::Mse{},
                                                 optimizer(vanilla_decay), context);
  for (int epoch = 0; epoch < task.epochs; ++epoch) {
    if (!task.goes_on()) return {};
    trainer->epoch(data, {epoch, task.epochs}, engine);
  }
  return {judged(trainer->network(), context, task.split.train), false, false};
}

BeyondTraining train_ridge(const BeyondTask& task) {
  const auto context = pinnquad::make_context<PhysicsContext>(task.split.train, task.airframe);
  const auto groups = pinnquad::regression_sums(context, pinnquad::left_out_groups(task.split.train));
  pinnquad::RegressionSums sums = groups.front();
  for (std::size_t i = 1; i < groups.size(); ++i) sums += groups[i];
  const double penalty = groups.size() < 2 ? 0.0 : pinnquad::choose_penalty(groups).penalty;
  const auto answer = pinnquad::affine_answer<PhysicsContext>(pinnquad::fit_ridge(sums, penalty));
  return {judged(answer, context, task.split.train), false, false};
}

}  // namespace study
