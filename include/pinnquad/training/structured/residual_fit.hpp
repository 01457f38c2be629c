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

#include "pinnquad/core/body.hpp"
#include "pinnquad/training/structured/closed_form.hpp"
#include "pinnquad/training/structured/residual_trainer.hpp"

namespace pinnquad {

namespace detail {

/// The result of a residual's fit, base alone and both: predictors, or their parameters.
template <class Base, class Predictor>
struct ResidualFit {
  Predictor predictor{};  ///< base and residual
  Base base{};            ///< alone: flies where the residual is not kept
  bool residual_kept = false;
  bool finished = true;              ///< false: goes_on() stopped it
  int epoch = -1;                    ///< after which the residual was best
  double base_error = 0, error = 0;  ///< mean absolute error of the commands on the validation rows
};

using FittedResidual = ResidualFit<std::vector<float>, std::vector<float>>;

/// Mean absolute error of the commands over standardised rows.
double command_error(const FitContext& context, const DescribedPredictor& predictor, const FitRows& rows);

/// The rows as the residual is shown them: without the angular accelerations, unless it is shown those.
FitRows shown_rows(const FitContext& context, const ResidualKind& kind, FitRows all);

/// The rest that a base leaves of rows, as the residual is shown it.
FitRows left_by(const FitContext& context, const ResidualKind& kind, const AffineMap& map, FitRows rows);

/// Trains a residual from `engine`, up to `epochs` of the schedule's; after each epoch `visit(trainer, epoch)`. False
/// where `goes_on` stopped it.
bool train_residual(const FitContext& context, const ResidualKind& kind, const FitRows& training, const FitRows& unseen,
                    const ResidualTraining& how, int epochs, std::mt19937_64& engine, const GoesOn& goes_on,
                    const std::function<void(ResidualTrainer&, int epoch)>& visit);

/// Parameters of base and residual, which is bounded to its outputs on these rows: lower bounds, upper bounds, its own.
std::vector<float> base_and_residual(const ResidualKind& kind, std::vector<float> base,
                                     const std::vector<float>& residual, const FitRows& rows);

/// A residual on the base `map`, of fit_rows(). Throws std::invalid_argument for rows that are too few.
FittedResidual fit_residual(const FitContext& context, const ResidualKind& kind, const FitRows& training,
                            const FitRows& validation, const AffineMap& map, const ResidualTraining& how,
                            std::mt19937_64& engine, const GoesOn& goes_on);

/// The same from rows, with types.
template <class Base, class Predictor, class ContextType>
ResidualFit<Base, Predictor> fit_residual(const ContextType& context, const ResidualKind& kind, const RowSet& training,
                                          const RowSet& validation, const AffineMap& map, const ResidualTraining& how,
                                          std::mt19937_64& engine, const GoesOn& goes_on) {
  const FitContext value = fit_context(context);
  const FittedResidual fit =
      fit_residual(value, kind, fit_rows(value, training), fit_rows(value, validation), map, how, engine, goes_on);
  ResidualFit<Base, Predictor> typed{{}, {}, fit.residual_kept, fit.finished, fit.epoch, fit.base_error, fit.error};
  std::copy(fit.predictor.begin(), fit.predictor.end(), typed.predictor.parameters.begin());
  std::copy(fit.base.begin(), fit.base.end(), typed.base.parameters.begin());
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
  using Base = MonotoneBase<Features>;
  const detail::ResidualKind kind = detail::residual_kind<Residual, Predictor, Base>(false, detail::NoProjection{});
  return detail::fit_residual<Base, Predictor>(context, kind, training, validation, map, how, engine, goes_on);
}

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/training/structured/impl/residual_fit.hpp"
#endif
