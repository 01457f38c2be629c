// SPDX-License-Identifier: MIT
// The slopes of a monotone base (closed_form.hpp) with standard errors, and by instruments where the noise of gyro and
// accelerometer bends those of least squares (regression/instrumental_variables.hpp). Instruments are the noisy
// features themselves, a moment before and after: the motion goes on, white noise does not.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/regression/block_regression.hpp"
#include "pinnquad/regression/instrumental_variables.hpp"
#include "pinnquad/training/structured/closed_form.hpp"
#include "pinnquad/training/structured/measured_slope.hpp"

namespace pinnquad {

/// The slopes of a monotone base, and what noise bends them.
struct MeasuredSlopes {
  /// A feature of which noise bends a slope, as the rows before and after tell it.
  struct Denoised {
    int place = 0;
    /// By standardised feature, then by noisy feature before and after; the noisy ones of now count nothing.
    AffineMap by_neighbours;
  };

  SlopesOfSums of;
  std::vector<int> noisy;          ///< MonotoneShape::noisy
  std::vector<Denoised> denoised;  ///< of the slopes by instruments
  bool by_instruments() const { return !denoised.empty(); }
};

namespace detail {

/// Time from a row to its instruments, s: past a sensor's filter, within the motion.
inline constexpr double instrument_lag_s = 0.1;

/// Features of a row and of its neighbours, and the row's outputs: in physical units.
using NeighboursVisit =
    std::function<void(std::size_t row, const double* x, const double* y, const double* before, const double* after)>;

/// Calls `visit` for each row of a piece whose neighbours are in the same piece, without a gap between. They are
/// instrument_lag_s away, two rows at least.
void each_with_neighbours(const FitContext& context, const FlightRows& piece, const NeighboursVisit& visit);

/// Sums of these over blocks of consecutive rows: fifty, of two seconds at least.
std::vector<RegressionSums> instrumented_blocks(const FitContext& context, const RowSet& rows,
                                                const std::vector<int>& noisy);

/// A noisy feature as the others that `told` names, and the noisy ones of the neighbours, tell it:
/// MeasuredSlopes::Denoised. `all`: of instrumented_blocks().
AffineMap by_neighbours(const MonotoneShape& shape, const std::vector<int>& noisy, const RegressionSums& all, int place,
                        std::vector<bool> told);

/// The specific force along the thrust axis at each tap of a window, as what the neighbours' windows have
/// instrument_lag_s off this tap tells it. `all`: of instrumented_blocks(), MonotoneShape::thrusts the noisy ones.
std::vector<MeasuredSlopes::Denoised> denoised_taps(const FitContext& context, const MonotoneShape& shape,
                                                    const RegressionSums& all);

}  // namespace detail

/// Calls `visit(row, x)` for each row whose neighbours are at hand, counted through the set: features in physical
/// units, those that bend a slope as the neighbours tell them. Rows to judge a model by whose slopes are by
/// instruments: on the noisy ones the worse model errs less.
void each_denoised(const FitContext& context, const MeasuredSlopes& slopes, const RowSet& rows,
                   const std::function<void(std::size_t row, const std::vector<double>& x)>& visit);

/// Examines the slopes of `map`, a base by least squares of the same rows, and puts into it the weights by instruments
/// of each sum whose slope noise bends. `blocks`: of detail::instrumented_blocks(). The bounds of fit_monotone_base()
/// hold. Fewer than ten blocks say nothing.
MeasuredSlopes measure_slopes(const MonotoneShape& shape, const std::vector<RegressionSums>& blocks,
                              const std::optional<AxisSlopes>& pinned, AffineMap& map);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/training/structured/impl/slopes_under_noise.hpp"
#endif
