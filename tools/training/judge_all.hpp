// SPDX-License-Identifier: MIT
// The linearized model and every network on the test rows, over the cores.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "command_line/parallel.hpp"
#include "training/judgement.hpp"
#include "training/recipe.hpp"

namespace programs {

inline constexpr const char* linear_name = "linearized";

/// One result for the linearized model, then one per training; predictions of the test rows in the same order.
inline std::vector<Result> judge_all(const TrainingPlan& plan, const std::vector<Training>& trainings,
                                     std::vector<Predictions>& predictions) {
  std::vector<Result> results(trainings.size() + 1);
  predictions.assign(results.size(), {});
  std::atomic<std::size_t> judged{0};
  const auto judge_one = [&](std::size_t i, const auto& predict, const auto& derivatives) {
    predictions[i] = predict(plan.split.test);
    results[i].test = judge(plan.airframe, plan.split.test, predictions[i]);
    results[i].test.derivatives = derivatives(plan.split.test);
    results[i].validation_error =
        judge(plan.airframe, plan.split.validation, predict(plan.split.validation)).errors.mean.mean_absolute;
    judged.fetch_add(1);
  };
  run_parallel(
      "judging " + std::to_string(results.size()) + " models", results.size(), plan.threads,
      [&] { return static_cast<double>(judged.load()) / static_cast<double>(results.size()); },
      [&](std::size_t i) {
        if (i == 0) {
          results[i].model = linear_name;
          const pinnquad::Airframe<double> airframe = plan.airframe.airframe<double>();
          judge_one(
              i, [&](const pinnquad::RowSet& rows) { return linear_predictions(airframe, rows); },
              [&](const pinnquad::RowSet& rows) {
                return derivative_figures(rows, linear_derivatives(plan.airframe));
              });
          return;
        }
        const Training& training = trainings[i - 1];
        results[i].model = training.loss.title;
        results[i].seed = training.seed;
        results[i].training_s = training.training_s;
        judge_one(
            i, [&](const pinnquad::RowSet& rows) { return training.network->predictions(rows); },
            [&](const pinnquad::RowSet& rows) { return training.network->derivatives(rows); });
      });
  return results;
}

}  // namespace programs
