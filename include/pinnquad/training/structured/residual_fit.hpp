// SPDX-License-Identifier: MIT
// The residual of a structured model: a network on what the monotone base leaves (closed_form.hpp), kept where it helps
// on rows that it has not seen. It is not shown the angular acceleration.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/training/structured/closed_form.hpp"
#include "pinnquad/training/structured/residual_trainer.hpp"

namespace pinnquad {

/// The result of a residual's fit: base alone or both.
struct FittedResidual {
  std::vector<float> parameters;  ///< of base and residual
  std::vector<float> base;        ///< of the base alone: flies where the residual is not kept
  bool residual_kept = false;
  bool finished = true;              ///< false: goes_on() stopped it
  int epoch = -1;                    ///< after which the residual was best
  double base_error = 0, error = 0;  ///< mean absolute error of the commands on the validation rows
};

/// The same with types.
template <class FeatureSet, class Predictor>
struct ResidualFit {
  Predictor predictor{};
  MonotoneBase<FeatureSet> base{};
  bool residual_kept = false;
  bool finished = true;
  int epoch = -1;
  double base_error = 0, error = 0;
};

namespace detail {

/// Mean absolute error of the commands over standardised rows.
inline double command_error(const FitContext& context, const DescribedPredictor& predictor, const FitRows& rows) {
  const auto mix = OutputMap<AxisCommandOutputs>::setting(context.airframe);
  double sum = 0;
  for (int row = 0; row < rows.size(); ++row) {
    const std::vector<float> said = predictor(rows.features_of(row));
    double difference[4], commands[rotor_count];
    for (std::size_t k = 0; k < 4; ++k) {
      difference[k] =
          (static_cast<double>(said[k]) - static_cast<double>(rows.outputs_of(row)[k])) * context.output_deviation[k];
    }
    AxisCommandOutputs::commands(static_cast<const double*>(nullptr), static_cast<const double*>(difference), mix,
                                 static_cast<double*>(commands));
    for (const double command : commands) sum += std::abs(command);
  }
  return sum / (static_cast<double>(rows.size()) * rotor_count);
}

/// The rows as the residual is shown them: without the angular accelerations, unless it is shown those.
inline FitRows shown_rows(const FitContext& context, const ResidualKind& kind, FitRows all) {
  if (kind.shown_accelerations) return all;
  const std::vector<int> others = other_features(context.inputs(), context.accelerations);
  FitRows rows{static_cast<int>(others.size()), {}, std::move(all.outputs)};
  for (int row = 0; row < all.size(); ++row) {
    for (const int feature : others) rows.features.push_back(all.features_of(row)[feature]);
  }
  return rows;
}

/// The rest that a base leaves of rows, as the residual is shown it.
inline FitRows left_by(const FitContext& context, const ResidualKind& kind, const AffineMap& map, FitRows rows) {
  take_away(map, rows);
  return shown_rows(context, kind, std::move(rows));
}

/// Trains a residual from `engine`, up to `epochs` of the schedule's; after each epoch `visit(trainer, epoch)`. False
/// where `goes_on` stopped it.
inline bool train_residual(const FitContext& context, const ResidualKind& kind, const FitRows& training,
                           const FitRows& unseen, const ResidualTraining& how, int epochs, std::mt19937_64& engine,
                           const GoesOn& goes_on, const std::function<void(ResidualTrainer&, int epoch)>& visit) {
  const auto trainer = kind.trainer(context, training, unseen, how, engine);
  for (int epoch = 0; epoch < epochs; ++epoch) {
    if (!goes_on(epoch)) return false;
    trainer->epoch({epoch, how.epochs}, engine);
    visit(*trainer, epoch);
  }
  return true;
}

/// Parameters of base and residual, which is bounded to its outputs on these rows: lower bounds, upper bounds, its own.
inline std::vector<float> base_and_residual(const ResidualKind& kind, std::vector<float> base,
                                            const std::vector<float>& residual, const FitRows& rows) {
  const DescribedPredictor network(kind.network, residual);
  std::vector<float> lower(AxisCommandOutputs::size), upper(AxisCommandOutputs::size);
  for (int row = 0; row < rows.size(); ++row) {
    const std::vector<float> said = network(rows.features_of(row));
    for (std::size_t k = 0; k < lower.size(); ++k) {
      lower[k] = row == 0 ? said[k] : std::min(lower[k], said[k]);
      upper[k] = row == 0 ? said[k] : std::max(upper[k], said[k]);
    }
  }
  for (const auto* part :
       {&static_cast<const std::vector<float>&>(lower), &static_cast<const std::vector<float>&>(upper), &residual}) {
    base.insert(base.end(), part->begin(), part->end());
  }
  return base;
}

/// A residual on the base `map`. Throws std::invalid_argument for rows that are too few.
inline FittedResidual fit_residual(const FitContext& context, const ResidualKind& kind, const RowSet& training,
                                   const RowSet& validation, const AffineMap& map, const ResidualTraining& how,
                                   std::mt19937_64& engine, const GoesOn& goes_on) {
  FittedResidual fit;
  fit.base = base_parameters(context.accelerations, map);
  const FitRows unseen = fit_rows(context, validation);
  const FitRows rows = left_by(context, kind, map, fit_rows(context, training));
  fit.base_error = fit.error = command_error(context, {kind.base, fit.base}, unseen);

  std::vector<float> best;
  double least = std::numeric_limits<double>::infinity();
  fit.finished = train_residual(context, kind, rows, left_by(context, kind, map, unseen), how, how.epochs, engine,
                                goes_on, [&](ResidualTrainer& trainer, int epoch) {
                                  const double error = trainer.validate();
                                  if (!(error < least)) return;  // nor for NaN
                                  least = error;
                                  fit.epoch = epoch;
                                  best = trainer.parameters();
                                });
  if (!fit.finished || best.empty()) return fit;
  fit.parameters = base_and_residual(kind, fit.base, best, rows);
  fit.error = command_error(context, {kind.predictor, fit.parameters}, unseen);
  fit.residual_kept = fit.error < (1 - how.least_gain) * fit.base_error;
  return fit;
}

template <class FeatureSet, class Predictor>
ResidualFit<FeatureSet, Predictor> with_types(const FittedResidual& fit) {
  ResidualFit<FeatureSet, Predictor> typed;
  std::copy(fit.parameters.begin(), fit.parameters.end(), typed.predictor.parameters.begin());
  std::copy(fit.base.begin(), fit.base.end(), typed.base.parameters.begin());
  typed.residual_kept = fit.residual_kept;
  typed.finished = fit.finished;
  typed.epoch = fit.epoch;
  typed.base_error = fit.base_error;
  typed.error = fit.error;
  return typed;
}

}  // namespace detail

/// A residual that is not shown the angular acceleration, on the base `map`, bounded to its outputs on the training
/// rows. `Residual`: a float Network of residual_inputs<Features> features and 4 outputs. `goes_on(epoch)` is asked
/// before each epoch. Throws std::invalid_argument for rows that are too few.
template <class Residual, class ContextType>
auto fit_monotone(const ContextType& context, const RowSet& training, const RowSet& validation, const AffineMap& map,
                  const ResidualTraining& how, std::mt19937_64& engine, const GoesOn& goes_on) {
  using Features = typename ContextType::Features;
  using Predictor = MonotonePredictor<Features, Residual>;
  const ResidualKind kind =
      detail::residual_kind<Residual, Residual, Predictor, MonotoneBase<Features>>(false, detail::NoProjection{});
  return detail::with_types<Features, Predictor>(
      detail::fit_residual(fit_context(context), kind, training, validation, map, how, engine, goes_on));
}

}  // namespace pinnquad
