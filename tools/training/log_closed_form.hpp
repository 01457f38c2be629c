// SPDX-License-Identifier: MIT
// Models of logged flights that are solved in closed form, for the features that a translation unit compiles them with.
// They need no rows to stop by: all that are not held out are fitted, the penalty by leaving out trajectories.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/training/structured/closed_form.hpp"
#include "training/log_features.hpp"
#include "training/log_least_squares.hpp"

namespace programs {

template <class Features, class Outputs = pinnquad::CommandOutputs>
using LogContext = pinnquad::Context<Features, pinnquad::GivenAirframe, Outputs>;

/// Training and validation.
inline pinnquad::RowSet rows_not_held_out(const FitTask& fit) {
  pinnquad::RowSet rows = fit.training;
  for (const pinnquad::FlightRows& piece : fit.validation.pieces()) rows.add(*piece.flight, piece.rows);
  return rows;
}

/// Throws std::invalid_argument where no row has all features.
template <class Context>
Context log_context(const FitTask& fit, const pinnquad::RowSet& rows) {
  bool any = false;
  pinnquad::each_features<typename Context::Features, double>(
      rows, [&any](const pinnquad::Flight&, std::size_t, const auto&) { any = true; });
  if (!any) throw std::invalid_argument("no row has all features that are asked for");
  return pinnquad::make_context<Context>(rows, fit.given_airframe());
}

template <class Answer, class Context>
std::shared_ptr<const TrainedNetwork> log_model_of(const Answer& answer, const Context& context,
                                                   const pinnquad::RowSet& rows) {
  return std::make_shared<ExportableNetwork>(
      pinnquad::ground_model(pinnquad::make_trained_model(answer, context, rows)), rows);
}

/// `solve(context, rows)` gives the map of standardised features to standardised outputs.
template <class Features, class Solve>
std::shared_ptr<const TrainedNetwork> fit_affine(const FitTask& fit, const Solve& solve) {
  using Context = LogContext<Features>;
  const pinnquad::RowSet rows = rows_not_held_out(fit);
  const Context context = log_context<Context>(fit, rows);
  return log_model_of(pinnquad::affine_answer<Context>(solve(context, rows)), context, rows);
}

/// Sums per group that is left out in turn.
template <class Context>
std::vector<pinnquad::RegressionSums> log_sums(const Context& context, const pinnquad::RowSet& rows) {
  return pinnquad::regression_sums(context, pinnquad::left_out_groups(rows));
}

template <TimeReach Reach>
std::shared_ptr<const TrainedNetwork> fit_log_ridge(const FitTask& fit) {
  return with_physics_features<Reach>(fit, [&](auto tag) {
    return fit_affine<typename decltype(tag)::type>(
        fit, [](const auto& context, const pinnquad::RowSet& rows) { return solved_ridge(log_sums(context, rows)); });
  });
}

}  // namespace programs
