// SPDX-License-Identifier: MIT
// A monotone model from rows whose network is shown the angular acceleration too: the base in closed form, a network on
// what it leaves, projected after each step so that it turns no slope round (training/path_projection.hpp), kept if it
// helps on rows that it has not seen.
#pragma once

#include "pinnquad/training/path_projection.hpp"
#include "pinnquad/training/structured_fit.hpp"

namespace pinnquad {

/// What comes of fit_path_bounded().
template <class FeatureSet, class Residual>
using PathBoundedFit = StructuredFit<FeatureSet, PathBoundedPredictor<FeatureSet, Residual>>;

/// As fit_monotone(), but that `Residual` is a Network of all the features: Dense layers, at most 3, with Relu, Tanh or
/// Softplus between them. `share`: of a slope that it may take away.
template <class Residual, class ContextType, class Engine, class GoesOn>
PathBoundedFit<typename ContextType::Features, Residual> fit_path_bounded(
    const ContextType& context, const RowSet& training, const RowSet& validation, const AffineMap& map,
    const ResidualTraining& how, Engine& engine, const GoesOn& goes_on, double share = 0.9) {
  const PathProjection<ContextType, Residual> projection(context, map, share);
  return detail::fit_residual<Residual, Saturated<PathBounded<Residual>>,
                              PathBoundedFit<typename ContextType::Features, Residual>>(
      context, context, [](auto rows) { return rows; }, [&](auto& trained) { trained.project(projection); }, training,
      validation, map, how, engine, goes_on);
}

}  // namespace pinnquad
