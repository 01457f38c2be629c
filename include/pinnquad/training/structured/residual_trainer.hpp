// SPDX-License-Identifier: MIT
// The training of a structured model's residual. Rows are standardised numbers, whatever the features: compiled once
// for each network type.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "pinnquad/loss/loss.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/adam.hpp"
#include "pinnquad/training/described_predictor.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/optimizer.hpp"
#include "pinnquad/training/structured/fit_context.hpp"
#include "pinnquad/training/trainer.hpp"

namespace pinnquad {

/// How the residual is trained.
struct ResidualTraining {
  int epochs = 300;  ///< 0: no residual, where the validation rows are fitted too
  double learning_rate = 3e-3;
  double weight_decay = 1e-3;
  /// A residual is kept if it lowers the error on the validation rows by more than this share of it.
  double least_gain = 0.01;
};

/// Asked before each epoch; false stops the training.
using GoesOn = std::function<bool(int epoch)>;

namespace detail {

/// Rows of standardised features and outputs, row-major: a TrainingData whose sizes are values.
struct FitRows {
  int inputs = 0;
  std::vector<float> features, outputs;

  int size() const noexcept { return inputs > 0 ? static_cast<int>(features.size()) / inputs : 0; }
  const float* features_of(int row) const noexcept { return features.data() + std::ptrdiff_t{row} * inputs; }
  const float* outputs_of(int row) const noexcept {
    return outputs.data() + std::ptrdiff_t{row} * AxisCommandOutputs::size;
  }
};

/// Rows of a context.
inline FitRows fit_rows(const FitContext& context, const RowSet& from) {
  FitRows rows{context.inputs(), {}, {}};
  context.each_standardised(from, [&](const Flight&, std::size_t, const double* x, const double* y) {
    for (int i = 0; i < context.inputs(); ++i) rows.features.push_back(static_cast<float>(x[i]));
    for (int k = 0; k < context.outputs(); ++k) rows.outputs.push_back(static_cast<float>(y[k]));
  });
  return rows;
}

/// A residual in training: the network's type is behind it.
class ResidualTrainer {
 public:
  using Make = std::function<std::unique_ptr<ResidualTrainer>(const FitContext& context, const FitRows& training,
                                                              const FitRows& unseen, const ResidualTraining& how,
                                                              std::mt19937_64& engine)>;
  virtual ~ResidualTrainer() = default;
  virtual void epoch(const Progress& progress, std::mt19937_64& engine) = 0;
  /// Mean absolute error on the rows that it is not trained on, in the units of the outputs.
  virtual double validate() = 0;
  /// Its outputs on the same rows, row-major, standardised.
  virtual std::vector<float> predictions() = 0;
  /// In the layout of Network::parameters.
  virtual std::vector<float> parameters() const = 0;
};

/// The residual of a model, as a value: its place in the predictor, and its training.
struct ResidualKind {
  PredictorText network;    ///< the residual alone
  PredictorText base;       ///< the base alone
  PredictorText predictor;  ///< base and bounded residual
  bool shown_accelerations = false;
  ResidualTrainer::Make trainer;
};

/// Features of a network of so many inputs, for the trainer that sees numbers alone.
template <int Size>
struct ShownNumbers {
  template <class Scalar>
  using Inputs = MotionInputs<Scalar>;
  static constexpr int size = Size;
  static constexpr int angular_acceleration = -1;
  static constexpr std::array<const char*, static_cast<std::size_t>(Size)> names{};
  static constexpr std::array<const char*, static_cast<std::size_t>(Size)> units{};

  template <class Scalar>
  static Status check(const MotionInputs<Scalar>& /*in*/) noexcept {
    return Status::ok;
  }
  template <class Scalar>
  static void extract(const MotionInputs<Scalar>& /*in*/, Scalar* /*x*/) noexcept {}
};

/// Trains `Network`, which may have more inputs than the rows have features: those are 0, their weights stay 0, and the
/// others have the bits of a network without them. `AfterBatch` as Trainer::epoch() calls it.
template <class Network, class AfterBatch>
class ResidualTrainerOf : public ResidualTrainer {
  using Shown = Context<ShownNumbers<Network::inputs>, GivenAirframe, AxisCommandOutputs>;
  using Optimizer = Scheduled<Adam, CosineDecay>;
  using OwnTrainer = Trainer<Network, Mse, Optimizer, Shown, ShuffledBatches, 64>;
  using Data = typename OwnTrainer::Data;
  static_assert(std::is_same_v<typename Network::Scalar, float>, "pinnquad: a residual is trained in float");

 public:
  ResidualTrainerOf(const FitContext& context, const FitRows& training, const FitRows& unseen,
                    const ResidualTraining& how, std::mt19937_64& engine, const AfterBatch& after_batch)
      : inputs_(training.inputs),
        training_(data_of(training)),
        unseen_(data_of(unseen)),
        after_batch_(after_batch),
        trainer_(initial(training.inputs, engine), Mse{}, optimizer_of(how), shown(context)) {}

  void epoch(const Progress& progress, std::mt19937_64& engine) override {
    trainer_.epoch(training_, progress, engine, after_batch_);
  }
  double validate() override { return trainer_.validate(unseen_).mean_absolute; }
  std::vector<float> predictions() override {
    std::vector<float> all;
    all.reserve(unseen_.outputs.size());
    trainer_.each_prediction(unseen_, [&all](int, int, double said) { all.push_back(static_cast<float>(said)); });
    return all;
  }
  std::vector<float> parameters() const override {
    const Network network = trainer_.network();
    const float* from = network.parameters.data();
    std::vector<float> all;
    for (int row = 0; row < first_width; ++row) {
      all.insert(all.end(), from + row * Network::inputs, from + row * Network::inputs + inputs_);
    }
    all.insert(all.end(), from + first_width * Network::inputs, from + network.parameters.size());
    return all;
  }

 private:
  static constexpr int first_width = Network::template Layer<0>::outputs;

  static Network initial(int inputs, std::mt19937_64& engine) {
    if (inputs == Network::inputs) return initialised<Network>(engine);
    Network network;
    unroll<Network::layer_count>([&](auto index) {
      constexpr int layer = decltype(index)::value;
      float* const parameters = network.parameters.data() + Network::Sizes::offset(index);
      if constexpr (layer > 0) {
        detail::initialise(typename Network::template Layer<layer>{}, parameters, engine);
      } else {
        const double limit = std::sqrt(6.0 / (inputs + first_width));
        for (int i = 0; i < first_width * inputs; ++i) {
          parameters[i / inputs * Network::inputs + i % inputs] = static_cast<float>(uniform(engine, -limit, limit));
        }
      }
    });
    return network;
  }
  static Optimizer optimizer_of(const ResidualTraining& how) {
    Optimizer optimizer;
    optimizer.optimizer.learning_rate = how.learning_rate;
    optimizer.optimizer.weight_decay = how.weight_decay;
    return optimizer;
  }
  static Shown shown(const FitContext& context) {
    Shown shown{GivenAirframe("", context.airframe)};
    std::copy(context.output_mean.begin(), context.output_mean.end(), shown.output.mean.begin());
    std::copy(context.output_deviation.begin(), context.output_deviation.end(),
              shown.output.standard_deviation.begin());
    return shown;
  }
  static Data data_of(const FitRows& rows) {
    Data data;
    data.outputs = rows.outputs;
    data.features.resize(static_cast<std::size_t>(rows.size()) * Network::inputs);
    for (int row = 0; row < rows.size(); ++row) {
      std::copy_n(rows.features_of(row), rows.inputs, data.features.data() + std::ptrdiff_t{row} * Network::inputs);
    }
    return data;
  }

  int inputs_;
  Data training_, unseen_;
  AfterBatch after_batch_;
  OwnTrainer trainer_;
};

struct NoProjection {
  template <class Trainer>
  void operator()(Trainer& /*trainer*/) const {}
};

/// `Trained`: the network that trains, of as many inputs as the residual or of more.
template <class Trained, class AfterBatch = NoProjection>
ResidualTrainer::Make residual_trainer(const AfterBatch& after_batch = {}) {
  return [after_batch](const FitContext& context, const FitRows& training, const FitRows& unseen,
                       const ResidualTraining& how, std::mt19937_64& engine) -> std::unique_ptr<ResidualTrainer> {
    return std::make_unique<ResidualTrainerOf<Trained, AfterBatch>>(context, training, unseen, how, engine,
                                                                    after_batch);
  };
}

template <class Residual, class Predictor, class Base, class AfterBatch>
ResidualKind residual_kind(bool shown_accelerations, const AfterBatch& after_batch) {
  return {predictor_text<Residual>(), predictor_text<Base>(), predictor_text<Predictor>(), shown_accelerations,
          residual_trainer<Residual>(after_batch)};
}

}  // namespace detail
}  // namespace pinnquad
