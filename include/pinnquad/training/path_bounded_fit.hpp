// SPDX-License-Identifier: MIT
// A monotone model from rows whose network is shown the angular acceleration too: the base in closed form, a network on
// what it leaves, projected after each step so that it turns no slope round (training/path_projection.hpp), kept if it
// helps on rows that it has not seen.
#pragma once

#include "pinnquad/training/monotone_fit.hpp"
#include "pinnquad/training/path_projection.hpp"

namespace pinnquad {

/// What came of it.
template <class FeatureSet, class Residual>
struct PathBoundedFit {
  PathBoundedAnswer<FeatureSet, Residual> answer{};  ///< base and network
  MonotoneBase<FeatureSet> base{};                   ///< the base alone: what flies where the network is not kept
  bool residual_kept = false;
  bool finished = true;              ///< false: it was told to stop
  int epoch = -1;                    ///< after which the network was best
  double base_error = 0, error = 0;  ///< mean absolute error of the commands on the validation rows
};

/// As fit_monotone(), but that `Residual` is a Network of all the features: Dense layers, at most 3, with Relu, Tanh or
/// Softplus between them. `share`: of a slope that it may take away.
template <class Residual, class ContextType, class Engine, class GoesOn>
PathBoundedFit<typename ContextType::Features, Residual> fit_path_bounded(
    const ContextType& context, const RowSet& training, const RowSet& validation, const AffineMap& map,
    const ResidualTraining& how, Engine& engine, const GoesOn& goes_on, double share = 0.9) {
  using Features = typename ContextType::Features;
  using Optimizer = Scheduled<Adam, CosineDecay>;
  constexpr int batch = 64;
  using ResidualTrainer = Trainer<Residual, Mse, Optimizer, ContextType, ShuffledBatches, batch>;
  PathBoundedFit<Features, Residual> fit;
  const PathProjection<ContextType, Residual> projection(context, map, share);
  fit.base = monotone_base<ContextType>(map);
  auto rows = standardised<float>(context, training);
  const auto unseen = standardised<float>(context, validation);
  auto left = unseen;
  take_away(map, rows);
  take_away(map, left);
  fit.base_error = fit.error = detail::command_error(context, fit.base, unseen);

  Optimizer optimizer;
  optimizer.optimizer.learning_rate = how.learning_rate;
  optimizer.optimizer.weight_decay = how.weight_decay;
  const auto trainer = std::make_unique<ResidualTrainer>(initialised<Residual>(engine), Mse{}, optimizer, context);
  Checkpoint<Residual> best;
  for (int epoch = 0; epoch < how.epochs; ++epoch) {
    fit.finished = goes_on(epoch);
    if (!fit.finished) return fit;
    trainer->epoch(rows, {epoch, how.epochs}, engine, [&](auto& trained) { trained.project(projection); });
    best.offer(epoch, trainer->validate(left).mean_absolute, *trainer);
  }
  if (best.empty()) return fit;
  fit.epoch = best.epoch();
  auto* to = std::copy(fit.base.parameters.begin(), fit.base.parameters.end(), fit.answer.parameters.begin());
  using Bound = Bounded<PathBounded<Residual>>;
  detail::take_range(best.network(), rows, to + Bound::lower, to + Bound::upper);
  std::copy(best.network().parameters.begin(), best.network().parameters.end(), to + Bound::own);
  fit.error = detail::command_error(context, fit.answer, unseen);
  fit.residual_kept = fit.error < (1 - how.least_gain) * fit.base_error;
  return fit;
}

}  // namespace pinnquad
