// SPDX-License-Identifier: MIT
// A monotone model from rows: the base in closed form, a network on what it leaves, trained by the Trainer and kept if
// it helps on rows that it has not seen.
#pragma once

#include "pinnquad/training/residual_features.hpp"
#include "pinnquad/training/structured_fit.hpp"

namespace pinnquad {

/// What comes of fit_monotone().
template <class FeatureSet, class Residual>
using MonotoneFit = StructuredFit<FeatureSet, MonotonePredictor<FeatureSet, Residual>>;

/// `Residual`: a Network of residual_inputs<Features> features and 4 outputs, float. `goes_on(epoch)` is asked before
/// each epoch. The residual is bounded to what it says on the training rows. Throws std::invalid_argument for rows that
/// are too few.
template <class Residual, class ContextType, class Engine, class GoesOn>
MonotoneFit<typename ContextType::Features, Residual> fit_monotone(const ContextType& context, const RowSet& training,
                                                                   const RowSet& validation, const AffineMap& map,
                                                                   const ResidualTraining& how, Engine& engine,
                                                                   const GoesOn& goes_on) {
  using Features = typename ContextType::Features;
  return detail::fit_residual<Residual, MonotoneResidual<Features, Residual>, MonotoneFit<Features, Residual>>(
      context, residual_context(context), [](const auto& rows) { return residual_rows<Features>(rows); },
      [](const auto&) {}, training, validation, map, how, engine, goes_on);
}

}  // namespace pinnquad
