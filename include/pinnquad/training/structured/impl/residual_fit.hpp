// SPDX-License-Identifier: MIT
// Bodies of residual_fit.hpp.
#pragma once

#include "pinnquad/training/structured/residual_fit.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY double command_error(const FitContext& context, const DescribedPredictor& predictor,
                                   const FitRows& rows) {
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

PINNQUAD_BODY FitRows shown_rows(const FitContext& context, const ResidualKind& kind, FitRows all) {
  if (kind.shown_accelerations) return all;
  const std::vector<int> others = other_features(context.inputs(), context.features.accelerations);
  FitRows rows{static_cast<int>(others.size()), {}, std::move(all.outputs)};
  for (int row = 0; row < all.size(); ++row) {
    for (const int feature : others) rows.features.push_back(all.features_of(row)[feature]);
  }
  return rows;
}

PINNQUAD_BODY FitRows left_by(const FitContext& context, const ResidualKind& kind, const AffineMap& map, FitRows rows) {
  take_away(map, rows);
  return shown_rows(context, kind, std::move(rows));
}

PINNQUAD_BODY bool train_residual(const FitContext& context, const ResidualKind& kind, const FitRows& training,
                                  const FitRows& unseen, const ResidualTraining& how, int epochs,
                                  std::mt19937_64& engine, const GoesOn& goes_on,
                                  const std::function<void(ResidualTrainer&, int epoch)>& visit) {
  const auto trainer = kind.trainer(context, training, unseen, how, engine);
  for (int epoch = 0; epoch < epochs; ++epoch) {
    if (!goes_on(epoch)) return false;
    trainer->epoch({epoch, how.epochs}, engine);
    visit(*trainer, epoch);
  }
  return true;
}

PINNQUAD_BODY std::vector<float> base_and_residual(const ResidualKind& kind, std::vector<float> base,
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

PINNQUAD_BODY FittedResidual fit_residual(const FitContext& context, const ResidualKind& kind, const FitRows& training,
                                          const FitRows& validation, const AffineMap& map, const ResidualTraining& how,
                                          std::mt19937_64& engine, const GoesOn& goes_on) {
  FittedResidual fit;
  fit.base = base_parameters(context.features.accelerations, map);
  const FitRows rows = left_by(context, kind, map, training);
  fit.base_error = fit.error = command_error(context, {kind.base, fit.base}, validation);

  std::vector<float> best;
  double least = std::numeric_limits<double>::infinity();
  fit.finished = train_residual(context, kind, rows, left_by(context, kind, map, validation), how, how.epochs, engine,
                                goes_on, [&](ResidualTrainer& trainer, int epoch) {
                                  const double error = trainer.validate();
                                  if (!(error < least)) return;  // nor for NaN
                                  least = error;
                                  fit.epoch = epoch;
                                  best = trainer.parameters();
                                });
  if (!fit.finished || best.empty()) return fit;
  fit.predictor = base_and_residual(kind, fit.base, best, rows);
  fit.error = command_error(context, {kind.predictor, fit.predictor}, validation);
  fit.residual_kept = fit.error < (1 - how.least_gain) * fit.base_error;
  return fit;
}

}  // namespace detail
}  // namespace pinnquad
