// SPDX-License-Identifier: MIT
// The model of a context that is a value (training/structured/fit_context.hpp), compiled once for all feature sets.
#pragma once

#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/deploy/written_model.hpp"
#include "pinnquad/regression/ridge.hpp"
#include "pinnquad/training/structured/fit_context.hpp"

namespace pinnquad {

namespace detail {
/// A model of a predictor that is affine, or affine with a bounded residual: its envelope is twice as wide as its rows,
/// and more (affine_reach()). `fitted`: the rows that it was fitted to, those of its context.
GroundModel<float> fitted_model(const FitContext& context, const PredictorText& predictor,
                                const std::vector<float>& parameters, const RowSet& fitted);
}  // namespace detail

/// The model of an affine map of standardised features to standardised outputs: a float Network of one Dense. Throws
/// std::invalid_argument for a map of other sizes.
GroundModel<float> affine_model(const FitContext& context, const AffineMap& map, const RowSet& fitted);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/fitted_model.hpp"
#endif
