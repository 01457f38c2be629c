// SPDX-License-Identifier: MIT
// Bodies of judgement.hpp.
#pragma once

#include "pinnquad/evaluation/judgement.hpp"

namespace pinnquad {

PINNQUAD_BODY detail::PredictionErrors<rotor_count> model_errors(const AskedModel& model, const RowSet& rows) {
  return detail::errors_on(rows, model.each_row, model.predict);
}

PINNQUAD_BODY Judgement::PairSigns pair_signs(const std::array<AxisSeries, 3>& series) {
  constexpr double large_step_share = 0.5;  // of the standard deviation
  Judgement::PairSigns result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisSeries& s = series[axis];
    const double large = large_step_share * std::sqrt(joint_moments(s.angular_acceleration, s.target).variance_x);
    result.all[axis] = sign_violation_share(s.predicted, s.angular_acceleration, 0, s.starts);
    result.of_flown[axis] = sign_violation_share(s.target, s.angular_acceleration, 0, s.starts);
    result.large[axis] = sign_violation_share(s.predicted, s.angular_acceleration, large, s.starts);
    result.large_of_flown[axis] = sign_violation_share(s.target, s.angular_acceleration, large, s.starts);
  }
  return result;
}

PINNQUAD_BODY std::vector<Commands<double>> predicted_commands(const AskedModel& model, const RowSet& rows,
                                                               bool inside_envelope) {
  std::vector<Commands<double>> result;
  const auto declined = [&model](const double* x) {
    for (std::size_t i = 0; i < model.size(); ++i) {
      if (!model.is_column[i] && !(x[i] >= model.envelope_lower[i] && x[i] <= model.envelope_upper[i])) return true;
    }
    return false;
  };
  for (const FlightRows& piece : rows.pieces()) {
    const std::size_t first = result.size();
    result.resize(first + piece.rows.size(), {not_a_number, not_a_number, not_a_number, not_a_number});
    model.each_row(RowSet(*piece.flight, piece.rows), [&](const Flight&, std::size_t row, const double* x) {
      if (!inside_envelope || !declined(x)) result[first + row - piece.rows.begin] = model.predict(x);
    });
  }
  return result;
}

PINNQUAD_BODY double answered_share(const AskedModel& model, const RowSet& rows) {
  std::size_t answered = 0;
  for (const Commands<double>& u : predicted_commands(model, rows, true)) answered += all_finite(u) ? 1U : 0U;
  return static_cast<double>(answered) / static_cast<double>(rows.size());
}

PINNQUAD_BODY Judgement judge(const AskedModel& model, const RowSplit& split) {
  RowSet rows;  // with features: the first ones of a piece have no whole window
  std::vector<Commands<double>> predictions;
  for (const FlightRows& piece : split.test.pieces()) {
    IndexRange run;
    model.each_row(RowSet(*piece.flight, piece.rows), [&](const Flight&, std::size_t row, const double* x) {
      predictions.push_back(model.predict(x));
      if (row != run.end) {
        rows.add(*piece.flight, run);
        run.begin = row;
      }
      run.end = row + 1;
    });
    rows.add(*piece.flight, run);
  }
  Judgement result = judge(GivenAirframe(model.airframe_name, model.airframe), rows, predictions);
  result.validation_error = model_errors(model, split.validation).mean.mean_absolute;
  result.verdict =
      verdict_on(result.errors, linear_regression_errors<PaperFeatures>(split.train, split.test).mean.r_squared);
  result.verdict.answered_share = answered_share(model, split.test);
  return result;
}

}  // namespace pinnquad
