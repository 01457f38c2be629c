// SPDX-License-Identifier: MIT
// The paper's network on the paper's features, plain and physics-informed, trained as the study does; of its epochs the
// one counts that is best on the validation flights.
#include <algorithm>
#include <memory>
#include <random>

#include "command_line/interrupt.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/training/checkpoint.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/trainer.hpp"
#include "training/best_recipe.hpp"
#include "training/log_closed_form.hpp"
#include "training/log_kinds.hpp"

namespace programs {

namespace {

constexpr int network_epochs = 100;

template <class Features, class Loss>
std::shared_ptr<const TrainedNetwork> trained(const LogFit& fit, const Loss& loss, double weight_decay) {
  using Context = LogContext<Features>;
  using Network = pinnquad::Mlp<float, pinnquad::InputSize<Features::size>, pinnquad::Hidden<10, 25>,
                                pinnquad::OutputSize<pinnquad::rotor_count>, pinnquad::Relu>;
  using Trainer = pinnquad::Trainer<Network, Loss, best::Optimizer, Context, pinnquad::ShuffledBatches, batch_size>;
  const Context context = log_context<Context>(fit, fit.training);
  const auto data = pinnquad::standardised<float>(context, fit.training);
  const auto validation = pinnquad::standardised<float>(context, fit.validation);
  std::mt19937_64 engine(fit.seed);
  const auto network = pinnquad::initialised<Network>(engine);
  const auto trainer = std::make_unique<Trainer>(network, loss, best::optimizer(weight_decay), context);
  pinnquad::Checkpoint<Network> kept;
  const int epochs = fit.epochs > 0 ? fit.epochs : network_epochs;
  for (int epoch = 0; epoch < epochs; ++epoch) {
    stop_if_interrupted();
    trainer->epoch(data, {epoch, epochs}, engine);
    kept.offer(epoch, trainer->validate(validation).mean_squared, *trainer);
  }
  return log_model_of(kept.empty() ? trainer->network() : kept.network(), context, fit.training);
}

std::shared_ptr<const TrainedNetwork> fit_vanilla(const LogFit& fit) {
  return with_paper_features(
      fit, [&](auto tag) { return trained<typename decltype(tag)::type>(fit, pinnquad::Mse{}, best::vanilla_decay); });
}

std::shared_ptr<const TrainedNetwork> fit_physics_informed(const LogFit& fit) {
  return with_paper_features(fit, [&](auto tag) {
    return trained<typename decltype(tag)::type>(fit, best::physics_loss(best::annealed_weight()),
                                                 best::informed_decay);
  });
}

}  // namespace

LogModelKind log_vanilla() {
  return {"vanilla", "vanilla network", TimeReach::present, true, needs_velocity, fit_vanilla};
}
LogModelKind log_physics_informed() {
  return {"physics_informed", "physics-informed network", TimeReach::present, true,
          needs_velocity,     fit_physics_informed};
}

}  // namespace programs
