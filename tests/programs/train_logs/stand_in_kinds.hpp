// SPDX-License-Identifier: MIT
// Kinds of models whose worth is known: what the judgement of logged flights is judged by.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/core/random.hpp"
#include "pinnquad/evaluation/errors.hpp"
#include "training/model_kind.hpp"
#include "training/model_predictions.hpp"

namespace pinnquad_test {

/// A model that is a function of rows.
class ModelOfFunction : public programs::TrainedNetwork {
 public:
  using Function = std::function<programs::Predictions(const pinnquad::RowSet&)>;
  explicit ModelOfFunction(Function function) : function_(std::move(function)) {}

  programs::Predictions predictions(const pinnquad::RowSet& rows) const override { return function_(rows); }
  /// Of a linear model alone.
  programs::DerivativeFigures derivatives(const pinnquad::RowSet& rows) const override {
    const pinnquad::GivenAirframe airframe(pinnquad::PaperQuadrotor::name,
                                           pinnquad::airframe_value<pinnquad::PaperQuadrotor, double>());
    const auto predict = [this](const pinnquad::Sample& sample) {
      pinnquad::Flight one;
      one.push_back(sample);
      return function_(pinnquad::RowSet(one, {0, 1})).front();
    };
    pinnquad::RowSet some;  // each asks it six times
    const pinnquad::FlightRows& piece = rows.pieces().front();
    some.add(*piece.flight, {piece.rows.begin, piece.rows.begin + std::min<std::size_t>(piece.rows.size(), 20)});
    return programs::derivative_figures(some, programs::FormulaDerivatives(airframe, predict));
  }

 private:
  Function function_;
};

inline std::shared_ptr<const programs::TrainedNetwork> model_of(ModelOfFunction::Function function) {
  return std::make_shared<ModelOfFunction>(std::move(function));
}

/// A model that answers each row for itself, by `of(rows, row)`.
template <class Of>
std::shared_ptr<const programs::TrainedNetwork> by_row(Of of) {
  return model_of([of](const pinnquad::RowSet& rows) {
    programs::Predictions made;
    for (std::size_t row = 0; row < rows.size(); ++row) made.push_back(of(rows, row));
    return made;
  });
}

inline pinnquad::Commands<double> mean_commands(const pinnquad::RowSet& rows) {
  pinnquad::Commands<double> mean{};
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += rows[row].commands[i] / static_cast<double>(rows.size());
  }
  return mean;
}

inline std::string always(const programs::FitTask&) { return {}; }

/// The mean of the training commands.
inline programs::ModelKind constant_kind() {
  return {"constant", "constant", programs::TimeReach::present, false, always, [](const programs::FitTask& fit) {
            const auto mean = mean_commands(fit.training);
            return model_of([mean](const pinnquad::RowSet& rows) { return programs::Predictions(rows.size(), mean); });
          }};
}

/// Secretly the mean, and noise that its seed makes.
inline programs::ModelKind secret_mean_kind() {
  return {"network", "deep network", programs::TimeReach::present, true, always, [](const programs::FitTask& fit) {
            const auto mean = mean_commands(fit.training);
            const std::uint64_t seed = fit.seed;
            return model_of([mean, seed](const pinnquad::RowSet& rows) {
              programs::Predictions made(rows.size(), mean);
              std::mt19937_64 engine(seed);
              for (auto& row : made) {
                for (double& u : row) u += 1e-3 * (std::uniform_real_distribution<double>(-1, 1)(engine));
              }
              return made;
            });
          }};
}

/// Least squares on the paper's features.
inline programs::ModelKind linear_kind() {
  return {"linear",
          "linear, paper's features",
          programs::TimeReach::present,
          false,
          always,
          [](const programs::FitTask& fit) {
            using Features = pinnquad::PaperFeatures;
            std::vector<std::array<double, Features::size>> features;
            programs::Predictions commands;
            pinnquad::each_features<Features, double>(
                fit.training, [&](const pinnquad::Flight& flight, std::size_t row, const auto& x) {
                  features.push_back(x);
                  commands.push_back(flight[row].commands);
                });
            const auto map = pinnquad::fit_linear_regression(features, commands);
            return model_of([map](const pinnquad::RowSet& rows) {
              programs::Predictions made;
              pinnquad::each_features<Features, double>(
                  rows, [&](const pinnquad::Flight&, std::size_t, const auto& x) { made.push_back(map.predict(x)); });
              return made;
            });
          }};
}

/// The linear map of linear_kind() plus what a wrong turn of its yaw would make: worse than that map on every flight.
inline programs::ModelKind spoiled_linear_kind() {
  return {"spoiled", "spoiled linear", programs::TimeReach::present, true, always, [](const programs::FitTask& fit) {
            const auto linear = linear_kind().fit(fit);
            return model_of([linear](const pinnquad::RowSet& rows) {
              programs::Predictions made = linear->predictions(rows);
              for (std::size_t row = 0; row < made.size(); ++row) {
                for (double& u : made[row]) u += row % 2 == 0 ? 0.01 : -0.01;
              }
              return made;
            });
          }};
}

/// Knows the commands: what sees the future may.
inline programs::ModelKind oracle_kind(programs::TimeReach reach) {
  return {"oracle", "oracle", reach, false, always, [](const programs::FitTask&) {
            return by_row([](const pinnquad::RowSet& rows, std::size_t row) {
              pinnquad::Commands<double> made = rows[row].commands;
              if (row == 0) made[0] = std::nan("");  // its window is not complete there
              return made;
            });
          }};
}

inline programs::ModelKind needs_battery_kind() {
  return {"battery",
          "needs a battery",
          programs::TimeReach::present,
          false,
          [](const programs::FitTask&) { return std::string("needs battery_voltage, which the logs lack"); },
          [](const programs::FitTask&) -> std::shared_ptr<const programs::TrainedNetwork> {
            throw std::logic_error("fitted although it is not applicable");
          }};
}

}  // namespace pinnquad_test
