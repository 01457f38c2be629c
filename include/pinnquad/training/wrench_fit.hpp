// SPDX-License-Identifier: MIT
// Trains a residual wrench (control/wrench_network.hpp) on flights: what the motion of each row has beyond the rigid
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
#include "pinnquad/control/wrench_network.hpp"
#include "pinnquad/core/body.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/adam.hpp"
#include "pinnquad/training/checkpoint.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/optimizer.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "pinnquad/training/trainer.hpp"

namespace pinnquad {

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

/// The flight with its rotors' state as columns: its commands behind the airframe's lag, less the part of it that was
/// taken out of the commands. Throws std::invalid_argument for rows that are too far apart for that lag.
Flight with_rotor_states(const Flight& flight, const Airframe<double>& airframe, double lag_removed_s = 0);

/// The part of a row's motion that is not of rotors and gravity: force / mass and angular acceleration, body.
Accelerations<double> residual_wrench_of(const Sample& sample, const Commands<double>& rotors,
                                         const Quadrotor<double, StandardAtmosphere>& vehicle);

namespace detail {

/// Calls `visit(x, y)` for each row: features, and the outputs, which are against the residual.
template <class Visit>
void each_wrench_row(const RowSet& rows, const Airframe<double>& airframe, const Visit& visit) {
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
WrenchJudgement judge_wrench(const WrenchModel& model, const RowSet& rows);

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
  const auto columns = detail::column_statistics(units, [&](const detail::RowVisit& visit) {
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

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/training/impl/wrench_fit.hpp"
#endif
