// SPDX-License-Identifier: MIT
// What the models of Table 2 predict on a set of rows.
#pragma once

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/dynamics/linearized.hpp"
#include "pinnquad/dynamics/site.hpp"
#include "pinnquad/evaluation/linear_regression.hpp"
#include "training/judgement.hpp"

namespace programs {

/// Model 1 on a row. The air's density is that of the paper's site at the row's altitude.
inline pinnquad::Commands<double> linear_prediction(const pinnquad::Airframe<double>& airframe,
                                                    const pinnquad::Rotors<double>& rotors,
                                                    const pinnquad::Sample& sample) {
  using namespace pinnquad;
  const Site<double> site = paper_site<double>();
  const double density = standard_atmosphere_density_kg_m3(site.elevation_m + sample.altitude_m);
  return linearized_commands(airframe, rotors,
                             Accelerations<double>{sample.linear_acceleration_m_s2, sample.angular_acceleration_rad_s2},
                             site.gravity_m_s2, density / standard_air_density_kg_m3<double>);
}

/// Model 1 on a set of rows.
inline Predictions linear_predictions(const pinnquad::Airframe<double>& airframe, const pinnquad::RowSet& rows) {
  const pinnquad::Rotors<double> rotors(airframe);
  Predictions result;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    result.push_back(linear_prediction(airframe, rotors, rows[row]));
  }
  return result;
}

/// Linear regression of the commands on the features, fitted on the training rows, on a set of rows.
template <class Features>
Predictions regression_predictions(const pinnquad::RowSet& training, const pinnquad::RowSet& rows) {
  std::vector<std::array<double, static_cast<std::size_t>(Features::size)>> features;
  Predictions commands;
  pinnquad::each_features<Features, double>(training,
                                            [&](const pinnquad::Flight& flight, std::size_t row, const auto& x) {
                                              features.push_back(x);
                                              commands.push_back(flight[row].commands);
                                            });
  const auto regression = pinnquad::fit_linear_regression(features, commands);
  Predictions result;
  pinnquad::each_features<Features, double>(
      rows, [&](const pinnquad::Flight&, std::size_t, const auto& x) { result.push_back(regression.predict(x)); });
  return result;
}

/// A trained model on a set of rows: NaN for a row that has no features, where a window is not complete.
template <class Model>
Predictions network_predictions(const Model& model, const pinnquad::RowSet& rows) {
  Predictions result;
  const auto unanswered = pinnquad::not_a_number;
  for (const pinnquad::FlightRows& piece : rows.pieces()) {
    const std::size_t first = result.size();
    result.resize(first + piece.rows.size(), {unanswered, unanswered, unanswered, unanswered});
    pinnquad::each_features<typename Model::Features, typename Model::Scalar>(
        pinnquad::RowSet(*piece.flight, piece.rows),
        [&](const pinnquad::Flight&, std::size_t row, const typename Model::FeatureVector& x) {
          const auto u = model.predict(x);
          for (std::size_t i = 0; i < u.size(); ++i) {
            result[first + row - piece.rows.begin][i] = static_cast<double>(u[i]);
          }
        });
  }
  return result;
}

}  // namespace programs
