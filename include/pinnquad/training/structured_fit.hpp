// SPDX-License-Identifier: MIT
// A model of a base in closed form and a network on what the base leaves: what comes of training the network, whatever it
// is shown. monotone_fit.hpp and path_bounded_fit.hpp are the two kinds.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <type_traits>
#include <utility>

#include "pinnquad/loss/mse.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/adam.hpp"
#include "pinnquad/training/checkpoint.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/monotone_base.hpp"
#include "pinnquad/training/optimizer.hpp"
#include "pinnquad/training/trainer.hpp"

namespace pinnquad {

/// How the residual is trained.
struct ResidualTraining {
  int epochs = 300;
  double learning_rate = 3e-3;
  double weight_decay = 1e-3;
  /// A residual is kept if it lowers the error on the validation rows by more than this share of it.
  double least_gain = 0.01;
};

/// What came of it.
template <class FeatureSet, class Answer>
struct StructuredFit {
  Answer answer{};                  ///< base and residual
  MonotoneBase<FeatureSet> base{};  ///< the base alone: what flies where the residual is not kept
  bool residual_kept = false;
  bool finished = true;              ///< false: it was told to stop
  int epoch = -1;                    ///< after which the residual was best
  double base_error = 0, error = 0;  ///< mean absolute error of the commands on the validation rows
};

namespace detail {

/// Mean absolute error of the commands over standardised rows.
template <class Answer, class ContextType, class Data>
double command_error(const ContextType& context, const Answer& answer, const Data& data) {
  const auto mix = context.template output_setting<AxisCommandOutputs, double>();
  double sum = 0;
  for (int row = 0; row < data.size(); ++row) {
    float said[Answer::outputs] = {};
    answer.forward(data.features_of(row), said);
    double difference[4], commands[rotor_count];
    for (std::size_t k = 0; k < 4; ++k) {
      difference[k] = (static_cast<double>(said[k]) - static_cast<double>(data.outputs_of(row)[k])) *
                      context.output.standard_deviation[k];
    }
    AxisCommandOutputs::commands(static_cast<const double*>(nullptr), static_cast<const double*>(difference), mix,
                                 static_cast<double*>(commands));
    for (const double command : commands) sum += std::abs(command);
  }
  return sum / (static_cast<double>(data.size()) * rotor_count);
}

/// The least and the largest of each output over the rows, as the bounds of the answer.
template <class Residual, class Data, class Scalar>
void take_range(const Residual& residual, const Data& data, Scalar* lower, Scalar* upper) {
  for (int row = 0; row < data.size(); ++row) {
    Scalar said[Residual::outputs] = {};
    residual.forward(data.features_of(row), said);
    for (int k = 0; k < Residual::outputs; ++k) {
      lower[k] = row == 0 ? said[k] : std::min(lower[k], said[k]);
      upper[k] = row == 0 ? said[k] : std::max(upper[k], said[k]);
    }
  }
}

/// `Bound`: where the residual and its bounds stand in Fit's answer. `context` is of the base's features, `shown` of those
/// that the residual is shown, `show` gives it its rows of the base's. `after_batch` as Trainer::epoch() calls it.
template <class Residual, class Bound, class Fit, class ContextType, class ShownContext, class Show, class AfterBatch,
          class Engine, class GoesOn>
Fit fit_residual(const ContextType& context, const ShownContext& shown, const Show& show, const AfterBatch& after_batch,
                 const RowSet& training, const RowSet& validation, const AffineMap& map, const ResidualTraining& how,
                 Engine& engine, const GoesOn& goes_on) {
  using Optimizer = Scheduled<Adam, CosineDecay>;
  constexpr int batch = 64;
  using ResidualTrainer = Trainer<Residual, Mse, Optimizer, ShownContext, ShuffledBatches, batch>;
  static_assert(std::is_same_v<typename Residual::Scalar, float>, "pinnquad: a residual is trained in float");
  Fit fit;
  fit.base = monotone_base<ContextType>(map);
  auto rows = standardised<float>(context, training);
  const auto unseen = standardised<float>(context, validation);
  auto left = unseen;
  take_away(map, rows);
  take_away(map, left);
  const auto data = show(std::move(rows)), validating = show(std::move(left));
  fit.base_error = fit.error = command_error(context, fit.base, unseen);

  Optimizer optimizer;
  optimizer.optimizer.learning_rate = how.learning_rate;
  optimizer.optimizer.weight_decay = how.weight_decay;
  const auto trainer = std::make_unique<ResidualTrainer>(initialised<Residual>(engine), Mse{}, optimizer, shown);
  Checkpoint<Residual> best;
  for (int epoch = 0; epoch < how.epochs; ++epoch) {
    fit.finished = goes_on(epoch);
    if (!fit.finished) return fit;
    trainer->epoch(data, {epoch, how.epochs}, engine, after_batch);
    best.offer(epoch, trainer->validate(validating).mean_absolute, *trainer);
  }
  if (best.empty()) return fit;
  fit.epoch = best.epoch();
  auto* to = std::copy(fit.base.parameters.begin(), fit.base.parameters.end(), fit.answer.parameters.begin());
  take_range(best.network(), data, to + Bound::lower, to + Bound::upper);
  std::copy(best.network().parameters.begin(), best.network().parameters.end(), to + Bound::own);
  fit.error = command_error(context, fit.answer, unseen);
  fit.residual_kept = fit.error < (1 - how.least_gain) * fit.base_error;
  return fit;
}

}  // namespace detail
}  // namespace pinnquad
