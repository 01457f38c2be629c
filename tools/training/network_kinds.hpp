// SPDX-License-Identifier: MIT
// Networks as kinds of models: the one loop over epochs, and the paper's network under each loss that a training can be
// asked for by name.
#pragma once

#include <array>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "command_line/interrupt.hpp"
#include "pinnquad/loss/local_monotonicity.hpp"
#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/checkpoint.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "pinnquad/training/trainer.hpp"
#include "training/best_recipe.hpp"
#include "training/model_kind.hpp"

namespace programs {

/// The epoch of a training that counts.
enum class KeptEpoch { last, best_on_validation };

/// The rows of networks, standardised: the same of all losses and seeds.
template <class Context>
struct NetworkRows {
  using Data = pinnquad::TrainingData<float, Context::Features::size, Context::output_count>;
  Context context;
  Data training, validation;
};
template <class Context>
std::shared_ptr<const NetworkRows<Context>> network_rows(const FitTask& task) {
  return task.shared->once<NetworkRows<Context>>(pinnquad::type_name<Context>(), [&task] {
    const auto context = pinnquad::make_context<Context>(task.training, task.given_airframe());
    const auto data = [&context](const auto& rows) { return pinnquad::standardised<float>(context, rows); };
    return std::make_shared<const NetworkRows<Context>>(
        NetworkRows<Context>{context, data(task.training), data(task.validation)});
  });
}

/// A network from the task's seed, which gives initialisation and batch order, alike for all losses.
template <class Network, class Context, class Loss, class Optimizer>
Network trained_network(const FitTask& task, const NetworkRows<Context>& rows, const Loss& loss,
                        const Optimizer& optimizer, int epochs, KeptEpoch which) {
  using Trainer = pinnquad::Trainer<Network, Loss, Optimizer, Context, pinnquad::ShuffledBatches, batch_size>;
  std::mt19937_64 engine(task.seed);
  const auto network = pinnquad::initialised<Network>(engine);
  const auto trainer = std::make_unique<Trainer>(network, loss, optimizer, rows.context);
  pinnquad::Checkpoint<Network> best;
  for (int epoch = 0; epoch < epochs; ++epoch) {
    stop_if_interrupted();
    trainer->epoch(rows.training, {epoch, epochs}, engine);
    if (which == KeptEpoch::best_on_validation) {
      best.offer(epoch, trainer->validate(rows.validation).mean_squared, *trainer);
    }
    task.share_done(static_cast<double>(epoch + 1) / epochs);
  }
  return best.empty() ? trainer->network() : best.network();
}

template <class Axis>
using PearsonTerm = pinnquad::Weighted<pinnquad::PearsonCorrelation<Axis>, pinnquad::CyclicalAnnealing>;
using PearsonLoss = pinnquad::PhysicsInformed<pinnquad::Mse, PearsonTerm<pinnquad::Roll>, PearsonTerm<pinnquad::Pitch>,
                                              PearsonTerm<pinnquad::Yaw>>;

namespace detail {

/// `Parts` is what differs between recipes: type Network; losses annealed(), constant(), pearson(); optimisers
/// vanilla_optimizer() and informed_optimizer().
template <class Parts, class MakeLoss, class MakeOptimizer>
std::shared_ptr<const TrainedNetwork> fit_by_parts(const FitTask& task, const MakeLoss& loss,
                                                   const MakeOptimizer& optimizer) {
  using Context = pinnquad::Context<pinnquad::PaperFeatures, pinnquad::GivenAirframe>;
  const auto rows = network_rows<Context>(task);
  const int epochs = task.epochs > 0 ? task.epochs : recipe_epochs;
  const auto network = std::make_unique<typename Parts::Network>(
      trained_network<typename Parts::Network>(task, *rows, loss(), optimizer(), epochs, KeptEpoch::last));
  const auto model = pinnquad::make_trained_model(*network, rows->context, task.training);
  auto ground = pinnquad::ground_model(model);
  if (task.settings.library_airframe) ground = of_library_airframe(std::move(ground));
  return std::make_shared<ExportableNetwork>(std::move(ground), task.training);
}

}  // namespace detail

/// The network of a recipe under each loss; `keys` are its kinds'.
template <class Parts>
std::vector<ModelKind> network_kinds(const std::array<const char*, 4>& keys) {
  using Task = FitTask;
  constexpr auto present = TimeReach::present;
  return {
      {keys[0], keys[0], present, true, needs_velocity,
       [](const Task& task) {
         return detail::fit_by_parts<Parts>(
             task, [] { return pinnquad::Mse{}; }, Parts::vanilla_optimizer);
       },
       never_takes_validation, "MSE"},
      {keys[1], keys[1], present, true, needs_velocity,
       [](const Task& task) { return detail::fit_by_parts<Parts>(task, Parts::annealed, Parts::informed_optimizer); },
       never_takes_validation, "MSE + local monotonicity (roll, pitch, yaw), cyclical annealing"},
      {keys[2], keys[2], present, true, needs_velocity,
       [](const Task& task) { return detail::fit_by_parts<Parts>(task, Parts::constant, Parts::informed_optimizer); },
       never_takes_validation, "MSE + local monotonicity (roll, pitch, yaw), constant weight"},
      {keys[3], keys[3], present, true, needs_velocity,
       [](const Task& task) { return detail::fit_by_parts<Parts>(task, Parts::pearson, Parts::informed_optimizer); },
       never_takes_validation, "MSE + Pearson's correlation (roll, pitch, yaw), cyclical annealing"}};
}

/// "16 -> 10 x 25 ReLU -> 4, 6379 parameters": the words are the middle.
template <class Network>
std::string network_in_words(const std::string& hidden) {
  return std::to_string(Network::inputs) + " -> " + hidden + " -> " + std::to_string(Network::outputs) + ", " +
         std::to_string(Network::parameter_count) + " parameters";
}

}  // namespace programs
