// SPDX-License-Identifier: MIT
// What the models of Table 2 predict on a set of rows.
#pragma once

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/dynamics/linearized.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"
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

/// Which rows a trained model answers: all, or those that the guard of its export lets through.
enum class Answers { all, inside_envelope };

/// A trained model on a set of rows: NaN for a row that has no features, where a window is not complete, and for one that
/// it does not answer.
template <class Model>
Predictions network_predictions(const Model& model, const pinnquad::RowSet& rows, Answers answers = Answers::all) {
  Predictions result;
  const auto unanswered = pinnquad::not_a_number;
  for (const pinnquad::FlightRows& piece : rows.pieces()) {
    const std::size_t first = result.size();
    result.resize(first + piece.rows.size(), {unanswered, unanswered, unanswered, unanswered});
    pinnquad::each_features<typename Model::Features, typename Model::Scalar>(
        pinnquad::RowSet(*piece.flight, piece.rows),
        [&](const pinnquad::Flight&, std::size_t row, const typename Model::FeatureVector& x) {
          if (answers == Answers::inside_envelope) {
            for (std::size_t i = 0; i < x.size(); ++i) {
              if (!(x[i] >= model.envelope_lower[i] && x[i] <= model.envelope_upper[i])) return;
            }
          }
          const auto u = model.predict(x);
          for (std::size_t i = 0; i < u.size(); ++i) {
            result[first + row - piece.rows.begin][i] = static_cast<double>(u[i]);
          }
        });
  }
  return result;
}

}  // namespace programs
