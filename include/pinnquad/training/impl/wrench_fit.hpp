// SPDX-License-Identifier: MIT
// Bodies of wrench_fit.hpp.
#pragma once

#include "pinnquad/training/wrench_fit.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY const std::vector<ColumnName>& rotor_columns() {
  static const std::vector<ColumnName> columns = wanted_columns<WrenchFeatures>();
  return columns;
}

}  // namespace detail

PINNQUAD_BODY Flight with_rotor_states(const Flight& flight, const Airframe<double>& airframe, double lag_removed_s) {
  const double lag_s = std::max(0.0, airframe.rise_time_constant_s(0) - lag_removed_s);
  const double period_s = sample_period_s(RowSet(flight, {0, flight.size()}));
  if (lag_s > 0 && !(period_s > 0 && period_s <= lag_s)) {
    throw std::invalid_argument("flight '" + flight.name + "': expected rows at most " + std::to_string(lag_s) +
                                " s apart, as the rotors lag, found " + std::to_string(period_s) +
                                " s (fly --interval)");
  }
  Flight result = flight;
  std::array<std::vector<double>, rotor_count> states;
  RotorFollower<double> rotors(lag_s);
  constexpr double control_step_s = 0.002;
  double before_s = 0;
  for (std::size_t row = 0; row < flight.size(); ++row) {
    const Sample& sample = flight[row];
    const double step_s = sample.time_s - before_s;
    if (row == 0 || step_s > 5 * period_s) {
      rotors.restart(sample.commands);
    } else {  // as a loop does between the rows
      const double parts = std::max(1.0, std::ceil(step_s / control_step_s - 1e-6));
      for (double part = 0; part < parts; ++part) {
        static_cast<void>(rotors.follow(0, step_s / parts, sample.commands));
      }
    }
    before_s = sample.time_s;
    for (std::size_t i = 0; i < states.size(); ++i) states[i].push_back(rotors.then()[i]);
  }
  for (std::size_t i = 0; i < states.size(); ++i) {
    result.add_column({detail::rotor_columns()[i], std::move(states[i])});
  }
  return result;
}

PINNQUAD_BODY Accelerations<double> residual_wrench_of(const Sample& sample, const Commands<double>& rotors,
                                                       const Quadrotor<double, StandardAtmosphere>& vehicle) {
  const Airframe<double>& airframe = vehicle.airframe();
  const auto motion = sample_inputs<MotionInputs<double>>(sample);
  State<double> state;
  state.position_m[2] = vehicle.site().ground_z_m - sample.altitude_m;
  const Wrench<double> made = vehicle.rotors().wrench(rotors, vehicle.rotor_scale(vehicle.surroundings(state, 0.0)));
  return {
      SpecificForce::of<double>(motion) - made.force_N / airframe.mass_kg,
      motion.angular_acceleration_rad_s2 - angular_acceleration(airframe, motion.body_rates_rad_s, made.torque_N_m)};
}

PINNQUAD_BODY WrenchJudgement judge_wrench(const WrenchModel& model, const RowSet& rows) {
  const detail::Scales<float> scales{model.input.mean.data(),     model.input.standard_deviation.data(),
                                     model.output.mean.data(),    model.output.standard_deviation.data(),
                                     model.envelope_lower.data(), model.envelope_upper.data()};
  const WrenchNetwork<WrenchNet> network(scales, model.network.parameters.data());
  std::array<double, 6> sum{}, squares{}, errors{};
  double count = 0;
  detail::each_wrench_row(rows, model.template airframe<double>(), [&](const auto& x, const auto& y) {
    const Accelerations<double> said =
        network(WrenchInputs<double>{{x[0], x[1], x[2]}, {x[3], x[4], x[5]}, {x[6], x[7], x[8], x[9]}});
    for (std::size_t k = 0; k < 6; ++k) {
      const double made = k < 3 ? said.linear_m_s2[int(k)] : said.angular_rad_s2[int(k) - 3];
      sum[k] += y[k];
      squares[k] += y[k] * y[k];
      errors[k] += (made + y[k]) * (made + y[k]);
    }
    ++count;
  });
  WrenchJudgement judged;
  for (std::size_t k = 0; k < 6; ++k) {
    const double variance = squares[k] / count - sum[k] / count * (sum[k] / count);
    judged.deviation[k] = std::sqrt(std::max(0.0, variance));
    judged.r_squared[k] = variance > 0 ? 1 - errors[k] / count / variance : 0.0;
  }
  return judged;
}

}  // namespace pinnquad
