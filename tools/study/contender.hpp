// SPDX-License-Identifier: MIT
// A contender of the study, its type erased: a model of Table 2 or a variant of the ablation, and how it is trained.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <tuple>

#include <nlohmann/json.hpp>

#include "command_line/interrupt.hpp"
#include "pinnquad/training/checkpoint.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "pinnquad/training/trainer.hpp"
#include "study/closed_loop.hpp"
#include "study/flights.hpp"
#include "study/models.hpp"
#include "study/networks.hpp"
#include "study/recipe.hpp"
#include "training/judgement.hpp"
#include "training/model_predictions.hpp"

namespace study {

/// A flight made ready for one data set of Table 2.
template <class DataSet>
struct Material {
  using Features = typename DataSet::Features;
  using Context = pinnquad::Context<Features, Airframe>;

  explicit Material(const pinnquad::Flight& rows)
      : flight(rows),
        split(pinnquad::split_contiguous(rows.size(), DataSet::shares)),
        context(pinnquad::make_context<Context>({rows, split.train})),
        data(pinnquad::standardised<float>(context, {rows, split.train})),
        validation(pinnquad::standardised<float>(context, {rows, split.validation})) {}

  const pinnquad::Flight& flight;
  pinnquad::detail::Split<pinnquad::IndexRange> split;
  Context context;
  pinnquad::TrainingData<float, Features::size, pinnquad::rotor_count> data;
  pinnquad::TrainingData<float, Features::size, pinnquad::rotor_count> validation;
};

/// Made once per flight, when the first training asks.
template <class DataSet>
class Materials {
 public:
  const Material<DataSet>& of(const programs::StudyFlight& id, const pinnquad::Flight& rows) {
    const std::lock_guard<std::mutex> lock(mutex_);
    auto& made = made_[id];
    if (!made) made = std::make_unique<Material<DataSet>>(rows);
    return *made;
  }

 private:
  std::mutex mutex_;
  std::map<programs::StudyFlight, std::unique_ptr<Material<DataSet>>> made_;
};

/// Data that all trainings share. Safe to use from many threads.
class Workshop {
 public:
  explicit Workshop(Flights flights) : flights_(std::move(flights)) {}

  const Flights& flights() const { return flights_; }
  template <class DataSet>
  const Material<DataSet>& material(std::uint64_t flight_seed) {
    const programs::StudyFlight id{DataSet::Flight::name, flight_seed};
    return std::get<Materials<DataSet>>(materials_).of(id, flights_.at(id));
  }
  /// Set when another training failed: this one stops too.
  void stop() { stopped_.store(true); }
  bool stopped() const { return stopped_.load() || programs::interrupted(); }
  /// Rows seen by all optimisers so far.
  void count(long long rows) { rows_done_.fetch_add(rows); }
  long long rows_done() const { return rows_done_.load(); }

 private:
  Flights flights_;
  std::tuple<Materials<D1>, Materials<D2>, Materials<D3>, Materials<D1Test40>, Materials<D1Test80>> materials_;
  std::atomic<bool> stopped_{false};
  std::atomic<long long> rows_done_{0};
};

/// One training of one contender.
struct Assignment {
  std::uint64_t flight_seed = 0;
  std::uint64_t seed = 0;
  int epochs = 0;
  bool best_weights = false;
  int patience = 0;
};

/// Its results.
struct Outcome {
  programs::Judgement test;
  double validation_mae = std::numeric_limits<double>::quiet_NaN();  ///< NaN where nothing is left to validate with
  double training_s = 0;
  bool best_weights = false;   ///< which weights were judged
  bool residual_kept = false;  ///< of a model that is a base and a network on it
  bool proven = false;         ///< its certificate holds (exported/certificate.hpp)
  LoopFigures loop;            ///< of a model that was flown
  pinnquad::IndexRange test_rows;
  programs::Predictions predictions;  ///< of the test rows
};

struct Contender {
  std::string id;
  std::string flight;             ///< d1, d2 or d3
  bool trained = true;            ///< false: a formula, the same for every seed
  bool more_flights = false;      ///< part of the main comparison
  std::size_t training_rows = 0;  ///< of the flight's plan: what an epoch costs
  nlohmann::json description;
  /// Of a seed; empty: the one of that name.
  std::function<std::vector<programs::StudyFlight>(std::uint64_t flight_seed)> flights{};
  /// Throws programs::Interrupted where it was stopped.
  std::function<void(Workshop&, const Assignment&, Outcome&)> run;
};

template <class DataSet>
Contender contender(std::string id, nlohmann::json description) {
  const std::size_t rows = DataSet::Flight::plan().samples;
  const auto split = pinnquad::split_contiguous(rows, DataSet::shares);
  Contender result;
  result.id = id;
  result.flight = DataSet::Flight::name;
  result.training_rows = split.train.size();
  result.description = std::move(description);
  result.description["id"] = std::move(id);
  result.description["data_set"] = DataSet::name;
  result.description["flight"] = DataSet::Flight::name;
  result.description["features"] = DataSet::Features::size;
  result.description["train_rows"] = split.train.size();
  result.description["validation_rows"] = split.validation.size();
  result.description["test_rows"] = split.test.size();
  return result;
}

/// `predictions_of(range)` judged on the test rows, and on the validation rows if there are any.
template <class DataSet, class PredictionsOf>
void judge(const Material<DataSet>& material, const PredictionsOf& predictions_of, Outcome& outcome) {
  const auto& airframe = material.context;
  const auto& split = material.split;
  outcome.test_rows = split.test;
  outcome.predictions = predictions_of(split.test);
  outcome.test = programs::judge(airframe, {material.flight, split.test}, outcome.predictions);
  if (split.validation.empty()) return;
  outcome.validation_mae =
      programs::judge(airframe, {material.flight, split.validation}, predictions_of(split.validation))
          .errors.mean.mean_absolute;
}

/// Model 1: Eq. (3) inverted.
template <class DataSet>
Contender linear_contender(const std::string& id, nlohmann::json description) {
  Contender result = contender<DataSet>(id, std::move(description));
  result.trained = false;
  result.run = [](Workshop& workshop, const Assignment& assignment, Outcome& outcome) {
    const Material<DataSet>& material = workshop.material<DataSet>(assignment.flight_seed);
    judge(
        material,
        [&](const pinnquad::IndexRange& range) {
          return programs::linear_predictions(pinnquad::airframe_value<Airframe, double>(), {material.flight, range});
        },
        outcome);
  };
  return result;
}

/// A network of one type under one loss. A seed gives initial weights and batch order, alike for every contender.
template <class DataSet, class Network, class Order, class Loss, class OptimizerType>
Contender trained_contender(const std::string& id, nlohmann::json description, const Loss& loss,
                            const OptimizerType& optimizer_used) {
  Contender result = contender<DataSet>(id, std::move(description));
  result.run = [loss, optimizer_used](Workshop& workshop, const Assignment& assignment, Outcome& outcome) {
    using Trainer =
        pinnquad::Trainer<Network, Loss, OptimizerType, typename Material<DataSet>::Context, Order, batch_size>;
    const Material<DataSet>& material = workshop.material<DataSet>(assignment.flight_seed);
    const auto start = std::chrono::steady_clock::now();
    std::mt19937_64 engine(assignment.seed);
    const auto trainer =
        std::make_unique<Trainer>(pinnquad::initialised<Network>(engine), loss, optimizer_used, material.context);
    const bool chooses = DataSet::chooses_weights && (assignment.best_weights || assignment.patience > 0);
    const auto best = std::make_unique<pinnquad::Checkpoint<Network>>();
    const int patience = chooses ? assignment.patience : 0;
    for (int epoch = 0; epoch < assignment.epochs && !best->is_stale(epoch, patience); ++epoch) {
      if (workshop.stopped()) throw programs::Interrupted{};
      trainer->epoch(material.data, {epoch, assignment.epochs}, engine);
      if (chooses) best->offer(epoch, trainer->validate(material.validation).mean_absolute, *trainer);
      workshop.count(material.data.size());
    }
    outcome.best_weights = chooses && assignment.best_weights && !best->empty();
    outcome.training_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const auto model = pinnquad::make_trained_model(outcome.best_weights ? best->network() : trainer->network(),
                                                    material.context, {material.flight, material.split.train});
    judge(
        material,
        [&](const pinnquad::IndexRange& range) {
          return pinnquad::predicted_commands(model, {material.flight, range});
        },
        outcome);
  };
  return result;
}

}  // namespace study
