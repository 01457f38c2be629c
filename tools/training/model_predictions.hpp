// SPDX-License-Identifier: MIT
// Commands of the linearized model on a set of rows.
#pragma once

#include "pinnquad/aero/air_density.hpp"
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

}  // namespace programs
