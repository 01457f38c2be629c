// SPDX-License-Identifier: MIT
// What the models of Table 2 predict on a block of a flight's rows.
#pragma once

#include "judgement.hpp"
#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/sample_inputs.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/dynamics/linearized.hpp"
#include "pinnquad/dynamics/site.hpp"
#include "pinnquad/evaluation/linear_regression.hpp"

namespace programs {

/// Model 1 on a block of rows. The air's density is that of the paper's site at the row's altitude.
template <class Vehicle>
Predictions linear_predictions(const pinnquad::Flight& flight, const pinnquad::IndexRange& range) {
  using namespace pinnquad;
  const Airframe<double> airframe = airframe_value<Vehicle, double>();
  const Rotors<double> rotors(airframe);
  const Site<double> site = paper_site<double>();
  Predictions result;
  for (std::size_t row = range.begin; row < range.end; ++row) {
    const Sample& sample = flight[row];
    const double density = standard_atmosphere_density_kg_m3(site.elevation_m + sample.altitude_m);
    result.push_back(linearized_commands(
        airframe, rotors, Accelerations<double>{sample.linear_acceleration_m_s2, sample.angular_acceleration_rad_s2},
        site.gravity_m_s2, density / standard_air_density_kg_m3<double>));
  }
  return result;
}

/// Linear regression of the commands on the features, fitted on the training rows, on a block of rows.
template <class Features>
Predictions regression_predictions(const pinnquad::Flight& flight, const pinnquad::IndexRange& training,
                                   const pinnquad::IndexRange& range) {
  std::vector<std::array<double, static_cast<std::size_t>(Features::size)>> features;
  Predictions commands;
  for (std::size_t row = training.begin; row < training.end; ++row) {
    features.push_back(pinnquad::sample_features<Features, double>(flight[row]));
    commands.push_back(flight[row].commands);
  }
  const auto regression = pinnquad::fit_linear_regression(features, commands);
  Predictions result;
  for (std::size_t row = range.begin; row < range.end; ++row) {
    result.push_back(regression.predict(pinnquad::sample_features<Features, double>(flight[row])));
  }
  return result;
}

/// A trained model on a block of rows.
template <class Model>
Predictions network_predictions(const Model& model, const pinnquad::Flight& flight, const pinnquad::IndexRange& range) {
  Predictions result;
  for (std::size_t row = range.begin; row < range.end; ++row) {
    const auto u = model.predict(flight[row]);
    result.push_back(
        {static_cast<double>(u[0]), static_cast<double>(u[1]), static_cast<double>(u[2]), static_cast<double>(u[3])});
  }
  return result;
}

}  // namespace programs
