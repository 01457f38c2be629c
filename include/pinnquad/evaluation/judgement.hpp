// SPDX-License-Identifier: MIT
// The judgement on a model: its errors on rows that it was not trained on, whether its commands run with the angular
// acceleration, and whether it is worth flying.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/evaluation/errors.hpp"
#include "pinnquad/evaluation/physical_consistency.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/loss/context.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/training/asked_model.hpp"

namespace pinnquad {

namespace detail {
/// The errors of `predict(x)` over the rows that `each_row(rows, visit)` shows.
template <class EachRow, class Predict>
PredictionErrors<rotor_count> errors_on(const RowSet& rows, const EachRow& each_row, const Predict& predict) {
  std::vector<std::array<double, rotor_count>> predicted, flown;
  each_row(rows, [&](const Flight& flight, std::size_t row, const auto& x) {
    predicted.push_back(predict(x));
    flown.push_back(flight[row].commands);
  });
  return prediction_errors(predicted, flown);
}
}  // namespace detail

/// The errors of a model's commands, 0..1. Throws std::invalid_argument where no row has features.
detail::PredictionErrors<rotor_count> model_errors(const AskedModel& model, const RowSet& rows);

/// The errors on `test` of linear regression on a feature set, fitted to `training`. Throws as model_errors().
template <class Features>
detail::PredictionErrors<rotor_count> linear_regression_errors(const RowSet& training, const RowSet& test) {
  std::vector<std::array<double, static_cast<std::size_t>(Features::size)>> features;
  std::vector<std::array<double, rotor_count>> commands;
  each_features<Features, double>(training, [&](const Flight& flight, std::size_t row, const auto& x) {
    features.push_back(x);
    commands.push_back(flight[row].commands);
  });
  const auto regression = fit_linear_regression(features, commands);
  return detail::errors_on(
      test, [](const RowSet& rows, const auto& visit) { each_features<Features, double>(rows, visit); },
      [&](const auto& x) { return regression.predict(x); });
}

/// The verdict on a model, beside linear regression on the same features that was fitted to its training rows. Throws
/// as model_errors().
template <class Model>
Verdict verdict_on(const Model& model, const RowSet& training, const RowSet& test) {
  const auto bar = linear_regression_errors<typename Model::Features>(training, test);
  return verdict_on(model_errors(model, test), bar.mean.r_squared);
}

/// No figure of roll, pitch and yaw.
inline constexpr std::array<double, 3> no_axis_figures = {not_a_number, not_a_number, not_a_number};

/// One model on one set of rows; validation_error and verdict by judge(model, split) alone.
struct Judgement {
  /// sign_violation_share() per axis, of pairs of rows that follow each other (docs/monotonicity.md). A large step of
  /// the angular acceleration is above half its standard deviation.
  struct PairSigns {
    std::array<double, 3> all = no_axis_figures;
    std::array<double, 3> of_flown = no_axis_figures;  ///< of the flown commands
    std::array<double, 3> large = no_axis_figures;     ///< among large steps
    std::array<double, 3> large_of_flown = no_axis_figures;
  };

  detail::PredictionErrors<rotor_count> errors;
  std::array<PhysicalConsistency, 3> axes;  ///< roll, pitch, yaw
  PairSigns pairs;
  std::array<double, 3> nominal_slopes = no_axis_figures;  ///< hover_slopes() of the airframe, s^2/rad
  double validation_error = not_a_number;  ///< mean absolute error of the commands on the validation rows
  Verdict verdict{};
};

/// Roll, pitch, yaw. As many predictions as rows. `airframe`: a GivenAirframe, a Context or a TrainedModel.
template <class AirframeSource>
std::array<AxisSeries, 3> axis_series(const AirframeSource& airframe, const RowSet& rows,
                                      const std::vector<Commands<double>>& predictions) {
  const std::array<std::array<double, rotor_count>, 3> signs = {
      airframe.template signs<Roll>(), airframe.template signs<Pitch>(), airframe.template signs<Yaw>()};
  std::array<AxisSeries, 3> series;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::size_t start = 0;
    for (const FlightRows& piece : rows.pieces()) {
      series[axis].starts.push_back(start);
      start += piece.rows.size();
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Sample& sample = rows[i];
      series[axis].angular_acceleration.push_back(sample.angular_acceleration_rad_s2[static_cast<int>(axis)]);
      series[axis].target.push_back(signed_sum(signs[axis], sample.commands));
      series[axis].predicted.push_back(signed_sum(signs[axis], predictions[i]));
    }
  }
  return series;
}

/// Shares of neighbouring rows on which sum and angular acceleration move apart, axis by axis (docs/monotonicity.md).
Judgement::PairSigns pair_signs(const std::array<AxisSeries, 3>& series);

/// Judges commands, one for each row. Throws std::invalid_argument for no rows or another number of commands.
template <class AirframeSource>
Judgement judge(const AirframeSource& airframe, const RowSet& rows, const std::vector<Commands<double>>& predictions) {
  std::vector<Commands<double>> targets;
  for (std::size_t i = 0; i < rows.size(); ++i) targets.push_back(rows[i].commands);
  Judgement result;
  result.errors = prediction_errors(predictions, targets);
  const std::array<AxisSeries, 3> series = axis_series(airframe, rows, predictions);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.axes[axis] = physical_consistency(series[axis]);
  }
  result.pairs = pair_signs(series);
  result.nominal_slopes = hover_slopes(airframe.template airframe<double>());
  return result;
}

/// The commands of a model, row by row. NaN for a row without features (a window that is not complete) and, if
/// `inside_envelope`, for a row that the guard of its export declines.
std::vector<Commands<double>> predicted_commands(const AskedModel& model, const RowSet& rows,
                                                 bool inside_envelope = false);

/// The share of rows that the guard of a model's export lets it answer.
double answered_share(const AskedModel& model, const RowSet& rows);

/// Judges a model on the test rows that have features: the first ones of a flight have no whole window. Its verdict is
/// beside linear regression on the paper's features. Throws std::invalid_argument for a split with an empty part, and
/// where no row has features.
Judgement judge(const AskedModel& model, const RowSplit& split);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/evaluation/impl/judgement.hpp"
#endif
