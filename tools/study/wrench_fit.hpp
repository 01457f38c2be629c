// SPDX-License-Identifier: MIT
// Trains a residual wrench (study/wrench_network.hpp) on flights: what the motion of each row has beyond the rigid
// body under its rotors, in the air of the paper's site.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/control/rotor_follower.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/adam.hpp"
#include "pinnquad/training/checkpoint.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/optimizer.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "pinnquad/training/trainer.hpp"
#include "study/wrench_network.hpp"

namespace study {

using namespace pinnquad;

/// The training of a residual wrench.
struct WrenchTraining {
  int epochs = 100;
  double learning_rate = 3e-3;
  double weight_decay = 1e-4;
  std::uint64_t seed = 1;
  int most_rows = 15000;  ///< of more training rows every second, third ... is taken
};

using WrenchContext = Context<WrenchFeatures, GivenAirframe, AccelerationOutputs>;
using WrenchModel = TrainedModel<WrenchNet, WrenchContext>;

namespace detail {
inline const std::vector<ColumnName>& rotor_columns() {
  static const std::vector<ColumnName> columns = wanted_columns<WrenchFeatures>();
  return columns;
}
}  // namespace detail

/// The flight with its rotors' state as columns: its commands behind the airframe's lag, less the part of it that was
/// taken out of the commands. Throws std::invalid_argument for rows that are too far apart for that lag.
inline Flight with_rotor_states(const Flight& flight, const pinnquad::Airframe<double>& airframe,
                                double lag_removed_s = 0) {
  const double lag_s = std::max(0.0, airframe.rise_time_constant_s(0) - lag_removed_s);
  const double period_s = sample_period_s(RowSet(flight, {0, flight.size()}));
  if (lag_s > 0 && !(period_s > 0 && period_s <= lag_s)) {
    throw std::invalid_argument("flight '" + flight.name + "': expected rows at most " + std::to_string(lag_s) +
                                " s apart, as the rotors lag, found " + std::to_string(period_s) +
                                " s (fly --interval)");
  }
  Flight result = flight;
  std::array<std::vector<double>, rotor_count> states;
  pinnquad::detail::RotorFollower<double> rotors(lag_s);
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

/// The part of a row's motion that is not of rotors and gravity: force / mass and angular acceleration, body.
inline Accelerations<double> residual_wrench_of(const Sample& sample, const Commands<double>& rotors,
                                                const Quadrotor<double, StandardAtmosphere>& vehicle) {
  const pinnquad::Airframe<double>& airframe = vehicle.airframe();
  const auto motion = sample_inputs<MotionInputs<double>>(sample);
  State<double> state;
  state.position_m[2] = vehicle.site().ground_z_m - sample.altitude_m;
  const Wrench<double> made = vehicle.rotors().wrench(rotors, vehicle.rotor_scale(vehicle.surroundings(state, 0.0)));
  return {
      SpecificForce::of<double>(motion) - made.force_N / airframe.mass_kg,
      motion.angular_acceleration_rad_s2 - angular_acceleration(airframe, motion.body_rates_rad_s, made.torque_N_m)};
}

namespace detail {

/// Calls `visit(x, y)` for each row: features, and the outputs, which are against the residual.
template <class Visit>
void each_wrench_row(const RowSet& rows, const pinnquad::Airframe<double>& airframe, const Visit& visit) {
  const Quadrotor<double, StandardAtmosphere> vehicle(airframe, paper_site<double>());
  each_features<WrenchFeatures, double>(rows, [&](const Flight& flight, std::size_t row, const auto& x) {
    const Accelerations<double> residual = residual_wrench_of(flight[row], {x[6], x[7], x[8], x[9]}, vehicle);
    std::array<double, 6> y{};
    for (int i = 0; i < 3; ++i) {
      y[std::size_t(i)] = -residual.linear_m_s2[i];
      y[std::size_t(3 + i)] = -residual.angular_rad_s2[i];
    }
    visit(x, y);
  });
}

}  // namespace detail

/// Share of the variance of each component of the residual wrench that the model explains on these rows, beside the
/// mean of the rows; their standard deviation.
struct WrenchJudgement {
  std::array<double, 6> r_squared{}, deviation{};
};
/// Of a model that was fitted, on rows that it has not seen.
inline WrenchJudgement judge_wrench(const WrenchModel& model, const RowSet& rows) {
  const pinnquad::detail::Scales<float> scales{model.input.mean.data(),     model.input.standard_deviation.data(),
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

/// A residual wrench of the training rows, the epoch chosen by the validation rows. Flights: with_rotor_states().
/// `goes_on(epoch)` is asked before each epoch. Throws std::invalid_argument for rows that are too few.
template <class GoesOn>
WrenchModel fit_wrench(const RowSet& training, const RowSet& validation, const GivenAirframe& airframe,
                       const WrenchTraining& how, const GoesOn& goes_on) {
  using Data = TrainingData<float, WrenchNet::inputs, WrenchNet::outputs>;
  using Optimizer = Scheduled<Adam, CosineDecay>;
  using WrenchTrainer = Trainer<WrenchNet, Mse, Optimizer, WrenchContext>;
  const auto value = airframe.airframe<double>();
  if (training.size() < 256 || validation.size() < 64) {
    throw std::invalid_argument("residual wrench: expected 256 rows to train on and 64 to validate by, found " +
                                std::to_string(training.size()) + " and " + std::to_string(validation.size()));
  }
  WrenchContext context{airframe};
  std::vector<std::string_view> units(WrenchFeatures::units.begin(), WrenchFeatures::units.end());
  units.insert(units.end(), AccelerationOutputs::units.begin(), AccelerationOutputs::units.end());
  const auto columns = pinnquad::detail::column_statistics(units, [&](const pinnquad::detail::RowVisit& visit) {
    detail::each_wrench_row(training, value, [&](const auto& x, const auto& y) {
      std::array<double, 16> row{};
      std::copy(y.begin(), y.end(), std::copy(x.begin(), x.end(), row.begin()));
      visit(row.data());
    });
  });
  for (std::size_t i = 0; i < 16; ++i) {
    auto& mean = i < 10 ? context.input.mean[i] : context.output.mean[i - 10];
    auto& deviation = i < 10 ? context.input.standard_deviation[i] : context.output.standard_deviation[i - 10];
    mean = columns[i].mean;
    deviation = columns[i].scale();
  }
  const auto standardised = [&](const RowSet& rows, std::size_t step) {
    Data data;
    std::size_t row = 0;
    detail::each_wrench_row(rows, value, [&](const auto& x, const auto& y) {
      if (row++ % step != 0) return;
      for (std::size_t i = 0; i < x.size(); ++i) {
        data.features.push_back(
            static_cast<float>((x[i] - context.input.mean[i]) / context.input.standard_deviation[i]));
      }
      for (std::size_t k = 0; k < y.size(); ++k) {
        data.outputs.push_back(
            static_cast<float>((y[k] - context.output.mean[k]) / context.output.standard_deviation[k]));
      }
    });
    return data;
  };
  const auto most = static_cast<std::size_t>(how.most_rows);
  const Data data = standardised(training, (training.size() + most - 1) / most);
  const Data validating = standardised(validation, (validation.size() + most - 1) / most);
  std::mt19937_64 engine(how.seed);
  Optimizer optimizer;
  optimizer.optimizer.learning_rate = how.learning_rate;
  optimizer.optimizer.weight_decay = how.weight_decay;
  const auto trainer = std::make_unique<WrenchTrainer>(initialised<WrenchNet>(engine), Mse{}, optimizer, context);
  Checkpoint<WrenchNet> best;
  for (int epoch = 0; epoch < how.epochs && goes_on(epoch); ++epoch) {
    trainer->epoch(data, {epoch, how.epochs}, engine);
    best.offer(epoch, trainer->validate(validating).mean_squared, *trainer);
  }
  return make_trained_model(best.network(), context, training);
}

}  // namespace study
