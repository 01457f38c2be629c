// SPDX-License-Identifier: MIT
// The bias that an inverse learns in flight (control/motion_bias.hpp), on rows that were flown: what it leaves of a
// model's errors, and which time constants leave least. A row's bias is of earlier rows alone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/control/motion_bias.hpp"
#include "pinnquad/core/body.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/evaluation/judgement.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"

namespace pinnquad {

/// Time constants that are tried, s, sum by sum. 0: no bias.
inline constexpr std::array<double, 7> bias_time_constants_tried_s = {0, 0.05, 0.1, 0.2, 0.3, 0.5, 1};

/// The delay of a state beside its commands that nobody has told the loop: with it the bias must still be stable.
inline constexpr double untold_delay_s = 0.04;
/// Between the middle of the flown motion that a bias is learnt from and the use of it, at most: two periods of a
/// FlownMotion.
inline constexpr double flown_motion_age_s = 0.05;

/// The least time constant that a loop takes. A bias that is faster follows the answer to its own change: twice the
/// time until that is seen. Measured in closed loops with lags of 5 to 50 ms and delays of 0 to 40 ms
/// (docs/adaptive.md).
constexpr double least_bias_time_constant_s(double rotor_lag_s) noexcept {
  return 2 * (rotor_lag_s + untold_delay_s + flown_motion_age_s);
}

namespace detail {

/// Calls `use(row, bias)` for each row, counted through all pieces, with the bias that stands there. A row without a
/// prediction teaches nothing. Throws std::invalid_argument for a count that is none.
template <class Use>
void each_past_bias(const RowSet& rows, const std::vector<Commands<double>>& predictions,
                    const Airframe<double>& airframe, const BiasSettings<double>& settings, double delay_s,
                    const Use& use) {
  if (predictions.size() != rows.size()) {
    throw std::invalid_argument("past bias: expected " + std::to_string(rows.size()) + " predictions, found " +
                                std::to_string(predictions.size()));
  }
  constexpr double rounding_s = 1e-6;
  std::size_t first = 0;
  for (const FlightRows& piece : rows.pieces()) {
    MotionBias<double> bias(airframe, settings);
    std::size_t taught = piece.rows.begin;
    for (std::size_t row = piece.rows.begin; row < piece.rows.end; ++row) {
      const Flight& flight = *piece.flight;
      for (; taught < row && flight[taught].time_s <= flight[row].time_s - delay_s + rounding_s; ++taught) {
        const double step_s = taught > piece.rows.begin ? flight[taught].time_s - flight[taught - 1].time_s : 0.0;
        const SignedSums<double> residual =
            bias.residual(flight[taught].commands, predictions[first + taught - piece.rows.begin]);
        const bool gap = step_s > settings.hold_s;
        if (gap || !all_finite(residual)) bias.wait(step_s);
        if (!gap && step_s > 0) static_cast<void>(bias.learn(residual, Vector3<double>::Zero(), step_s));
      }
      use(first + row - piece.rows.begin, std::as_const(bias));
    }
    first += piece.rows.size();
  }
}

}  // namespace detail

/// Predictions with the bias of the past; NaN stays. Throws std::invalid_argument for a count that is none.
std::vector<Commands<double>> with_past_bias(const RowSet& rows, const std::vector<Commands<double>>& predictions,
                                             const Airframe<double>& airframe, const BiasSettings<double>& settings,
                                             double delay_s);

/// The residuals of each signed sum that each time constant leaves. Trials of several row sets are added up.
struct BiasTrial {
  static constexpr std::size_t candidates = bias_time_constants_tried_s.size();
  /// How a bias is made of rows.
  struct Past {
    double delay_s = flown_motion_age_s;  ///< rows younger than this have no part in it
    double least_time_constant_s = 0;     ///< of those that are tried
  };

  double rows = 0;
  std::array<SignedSums<double>, candidates> absolute{};  ///< sums over the rows; infinite: not to be taken

  BiasTrial& operator+=(const BiasTrial& other) {
    rows += other.rows;
    for (std::size_t c = 0; c < candidates; ++c) {
      for (std::size_t k = 0; k < 4; ++k) absolute[c][k] += other.absolute[c][k];
    }
    return *this;
  }

  /// Sum by sum the shortest time constant whose mean absolute residual is within a twentieth of the least of all; the
  /// longest where each of them costs more. Recorded flights seldom have the payload or the weak rotor that a bias is
  /// for: on them alone the least error would be that of a slow bias, or of none. 0 without rows.
  SignedSums<double> best_s() const;
};

/// Tries them on rows that did not train the model. Rows without a prediction count for none. Throws
/// std::invalid_argument for a count that is none.
BiasTrial try_biases(const RowSet& rows, const std::vector<Commands<double>>& predictions,
                     const Airframe<double>& airframe, const BiasTrial::Past& past);

/// The time constants that a model's header and block say: best_s() on rows that did not train it, as of flights whose
/// derivatives do not look ahead.
SignedSums<double> chosen_bias_time_constants_s(const AskedModel& model, const RowSet& rows);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/evaluation/impl/past_bias.hpp"
#endif
