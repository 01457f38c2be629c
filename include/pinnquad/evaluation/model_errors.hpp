// SPDX-License-Identifier: MIT
// A trained model on rows of flights: its errors against the commands flown, and the verdict on it.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/evaluation/errors.hpp"
#include "pinnquad/evaluation/linear_regression.hpp"
#include "pinnquad/evaluation/verdict.hpp"

namespace pinnquad {

namespace detail {

/// What was flown and what `predict(x)` says, for each row that has features.
template <class Features, class Scalar, class Predict>
PredictionErrors<rotor_count> errors_on(const RowSet& rows, const Predict& predict) {
  std::vector<std::array<double, rotor_count>> predicted, flown;
  each_features<Features, Scalar>(rows, [&](const Flight& flight, std::size_t row, const auto& x) {
    const auto u = predict(x);
    predicted.push_back({});
    for (std::size_t i = 0; i < rotor_count; ++i) predicted.back()[i] = static_cast<double>(u[i]);
    flown.push_back(flight[row].commands);
  });
  return prediction_errors(predicted, flown);
}

}  // namespace detail

/// The errors of a TrainedModel's commands, 0..1. Throws std::invalid_argument where no row has features.
template <class Model>
PredictionErrors<rotor_count> model_errors(const Model& model, const RowSet& rows) {
  return detail::errors_on<typename Model::Features, typename Model::Scalar>(
      rows, [&model](const typename Model::FeatureVector& x) { return model.predict(x); });
}

/// The errors on `test` of linear regression on a feature set, fitted to `training`. Throws std::invalid_argument where no row of
/// one of them has features.
template <class Features>
PredictionErrors<rotor_count> linear_regression_errors(const RowSet& training, const RowSet& test) {
  std::vector<std::array<double, static_cast<std::size_t>(Features::size)>> features;
  std::vector<std::array<double, rotor_count>> commands;
  each_features<Features, double>(training, [&](const Flight& flight, std::size_t row, const auto& x) {
    features.push_back(x);
    commands.push_back(flight[row].commands);
  });
  const auto regression = fit_linear_regression(features, commands);
  return detail::errors_on<Features, double>(test, [&](const auto& x) { return regression.predict(x); });
}

/// The verdict on a model by rows that it was not trained on, beside linear regression on the same features that was fitted to
/// the rows that it was trained on. Throws std::invalid_argument where no row of one of them has features.
template <class Model>
Verdict verdict_on(const Model& model, const RowSet& training, const RowSet& test) {
  const auto bar = linear_regression_errors<typename Model::Features>(training, test);
  return verdict_on(model_errors(model, test), bar.mean.r_squared);
}

}  // namespace pinnquad
