// SPDX-License-Identifier: MIT
// The slopes of a monotone base (closed_form.hpp) with standard errors, and by smoothed rows where the noise of gyro
// and accelerometer bends those of the rows. The base is linear in its features, so it is the same of means over a
// window; the angular acceleration of a window is the difference of its rates, whose noise falls with the window's
// length to the power of 1.5, and the specific force along z that of its velocities, where they were
// measured.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/regression/block_regression.hpp"
#include "pinnquad/regression/identification.hpp"
#include "pinnquad/regression/smoothed_flights.hpp"
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
  std::vector<int> noisy;          ///< detail::noisy_features()
  std::vector<Denoised> denoised;  ///< of the slopes by smoothed rows
  bool smoothed() const {
    return std::any_of(of.begin(), of.end(), [](const MeasuredSlope& slope) { return slope.smoothed(); });
  }
};

namespace detail {

/// Time from a row to its neighbours, s: past a sensor's filter, within the motion.
inline constexpr double neighbour_lag_s = 0.1;

/// Features of a row and of its neighbours: in physical units.
using NeighboursVisit =
    std::function<void(std::size_t row, const double* x, const double* before, const double* after)>;

/// Calls `visit` for each row of a piece whose neighbours are in the same piece, without a gap between. They are
/// neighbour_lag_s away, two rows at least.
void each_with_neighbours(const FitContext& context, const FlightRows& piece, const NeighboursVisit& visit);

/// Features that a gyro's or an accelerometer's noise is in, by their units. Of a window the thrusts alone: its other
/// taps would be their own instruments.
std::vector<int> noisy_features(const FitContext& context);

/// A noisy feature as the others that `told` names, and the noisy ones of the neighbours, tell it:
/// MeasuredSlopes::Denoised. `all`: sums of features, then of noisy ones of the neighbours.
AffineMap by_neighbours(const FitContext& context, const std::vector<int>& noisy, const RegressionSums& all, int place,
                        std::vector<bool> told);

/// Sums of standardised features and outputs in blocks of consecutive rows: fifty, of two seconds at least; the last
/// may be empty. Of means over `window_s`, weighted as in smoothed_flights.hpp, the present's accelerations of body
/// rates and velocity; 0: of the rows as they are. Empty for rows without a period.
std::vector<RegressionSums> row_blocks(const FitContext& context, const RowSet& rows, double window_s);

/// A slope of least squares of the present's features, in their units: of all blocks, and without each in turn.
struct SlopeOfBlocks {
  double all = 0;
  std::vector<double> without;

  SlopeOfBlocks(const FitContext& context, const std::vector<RegressionSums>& blocks, int output);
};

/// Standard error of factor x a + b by the jackknife that leaves out blocks (Kuensch, Annals of Statistics 17, 1989),
/// because rows of a flight follow each other: sqrt((n - 1) / n sum (w_i - mean)^2).
double block_error(double factor, const SlopeOfBlocks& a, const SlopeOfBlocks* b = nullptr);

}  // namespace detail

/// Calls `visit(row, x)` for each row whose neighbours are at hand, counted through the set: features in physical
/// units, those that bend a slope as the neighbours tell them. Rows to judge a model by whose slopes are by smoothed
/// rows: on the noisy ones the worse model errs less.
void each_denoised(const FitContext& context, const MeasuredSlopes& slopes, const RowSet& rows,
                   const std::function<void(std::size_t row, const std::vector<double>& x)>& visit);

/// Examines the slopes of `map`, a base by least squares of these rows, and puts into it the weights by smoothed rows
/// of each sum whose slope noise bends: a window is doubled for as long as that finds a steeper one, beyond chance. Of
/// a window of taps the thrust alone, all taps together, which are held at it. The bounds of fit_monotone_base() hold.
/// Fewer than ten blocks say nothing.
MeasuredSlopes measure_slopes(const FitContext& context, const RowSet& rows, const std::optional<AxisSlopes>& pinned,
                              AffineMap& map);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/training/structured/impl/slopes_under_noise.hpp"
#endif
