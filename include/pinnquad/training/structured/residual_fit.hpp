// SPDX-License-Identifier: MIT
// The residual of a structured model: a network on what the monotone base leaves (closed_form.hpp), kept where it helps
// on rows that it has not seen. fit_monotone() hides the angular acceleration from it; fit_path_bounded() shows it, and
// keeps the network after each step from turning a slope round.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "pinnquad/loss/loss.hpp"
#include "pinnquad/model/path_bound.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/adam.hpp"
#include "pinnquad/training/checkpoint.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/optimizer.hpp"
#include "pinnquad/training/structured/closed_form.hpp"
#include "pinnquad/training/trainer.hpp"

namespace pinnquad {

/// How the residual is trained.
struct ResidualTraining {
  int epochs = 300;
  double learning_rate = 3e-3;
  double weight_decay = 1e-3;
  /// A residual is kept if it lowers the error on the validation rows by more than this share of it.
  double least_gain = 0.01;
};

namespace detail {

/// A base, its residual, and the choice between base alone and both.
template <class FeatureSet, class Predictor>
struct ResidualFit {
  Predictor predictor{};            ///< base and residual
  MonotoneBase<FeatureSet> base{};  ///< the base alone: flies where the residual is not kept
  bool residual_kept = false;
  bool finished = true;              ///< false: goes_on() stopped it
  int epoch = -1;                    ///< after which the residual was best
  double base_error = 0, error = 0;  ///< mean absolute error of the commands on the validation rows
};

template <class Threes, std::size_t Size>
constexpr std::array<const char*, static_cast<std::size_t>(Threes::others)> other_texts(
    const std::array<const char*, Size>& all) noexcept {
  std::array<const char*, static_cast<std::size_t>(Threes::others)> kept{};
  Threes::each_other(
      [&](int feature, int n) { kept[static_cast<std::size_t>(n)] = all[static_cast<std::size_t>(feature)]; });
  return kept;
}

/// A feature set without its angular accelerations.
template <class FeatureSet>
struct ResidualFeatures {
  using Threes = typename MonotoneBase<FeatureSet>::Threes;
  template <class Scalar>
  using Inputs = typename FeatureSet::template Inputs<Scalar>;

  static constexpr int size = residual_inputs<FeatureSet>;
  static constexpr int angular_acceleration = -1;

  static constexpr auto names = other_texts<Threes>(FeatureSet::names);
  static constexpr auto units = other_texts<Threes>(FeatureSet::units);

  template <class AnyInputs>
  static Status check(const AnyInputs& in) noexcept {
    return FeatureSet::check(in);
  }
  template <class Scalar, class AnyInputs>
  static void extract(const AnyInputs& in, Scalar* x) noexcept {
    Scalar all[FeatureSet::size];
    FeatureSet::extract(in, static_cast<Scalar*>(all));
    Threes::each_other([&](int feature, int n) { x[n] = all[feature]; });
  }
};

}  // namespace detail

/// The context of a residual: that of the whole model without the angular accelerations. Its outputs are axis commands
/// without a base: a base would not find its features here.
template <class ContextType>
auto residual_context(const ContextType& context) {
  using Vehicle = typename ContextType::Vehicle;
  using Residual = Context<detail::ResidualFeatures<typename ContextType::Features>, Vehicle, AxisCommandOutputs>;
  Residual residual{static_cast<const detail::ContextAirframe<Vehicle>&>(context)};
  Residual::Features::Threes::each_other([&](int feature, int n) {
    residual.input.mean[static_cast<std::size_t>(n)] = context.input.mean[static_cast<std::size_t>(feature)];
    residual.input.standard_deviation[static_cast<std::size_t>(n)] =
        context.input.standard_deviation[static_cast<std::size_t>(feature)];
  });
  residual.output = context.output;
  residual.signed_sum_deviation = context.signed_sum_deviation;
  return residual;
}

/// Rows of the whole model's features, without the angular accelerations.
template <class FeatureSet, class Scalar, int OutputCount>
TrainingData<Scalar, residual_inputs<FeatureSet>, OutputCount> residual_rows(
    const TrainingData<Scalar, FeatureSet::size, OutputCount>& all) {
  TrainingData<Scalar, residual_inputs<FeatureSet>, OutputCount> rows;
  rows.outputs = all.outputs;
  rows.weights = all.weights;
  rows.features.reserve(static_cast<std::size_t>(all.size()) * static_cast<std::size_t>(residual_inputs<FeatureSet>));
  for (int row = 0; row < all.size(); ++row) {
    const Scalar* x = all.features_of(row);
    MonotoneBase<FeatureSet>::Threes::each_other([&](int feature, int) { rows.features.push_back(x[feature]); });
  }
  return rows;
}

namespace detail {

/// Mean absolute error of the commands over standardised rows.
template <class Predictor, class ContextType, class Data>
double command_error(const ContextType& context, const Predictor& predictor, const Data& data) {
  const auto mix = context.template output_setting<AxisCommandOutputs, double>();
  double sum = 0;
  for (int row = 0; row < data.size(); ++row) {
    float said[Predictor::outputs] = {};
    predictor.forward(data.features_of(row), said);
    double difference[4], commands[rotor_count];
    for (std::size_t k = 0; k < 4; ++k) {
      difference[k] = (static_cast<double>(said[k]) - static_cast<double>(data.outputs_of(row)[k])) *
                      context.output.standard_deviation[k];
    }
    AxisCommandOutputs::commands(static_cast<const double*>(nullptr), static_cast<const double*>(difference), mix,
                                 static_cast<double*>(commands));
    for (const double command : commands) sum += std::abs(command);
  }
  return sum / (static_cast<double>(data.size()) * rotor_count);
}

/// The least and the largest of each output over the rows: the residual's bounds.
template <class Residual, class Data, class Scalar>
void take_range(const Residual& residual, const Data& data, Scalar* lower, Scalar* upper) {
  for (int row = 0; row < data.size(); ++row) {
    Scalar said[Residual::outputs] = {};
    residual.forward(data.features_of(row), said);
    for (int k = 0; k < Residual::outputs; ++k) {
      lower[k] = row == 0 ? said[k] : std::min(lower[k], said[k]);
      upper[k] = row == 0 ? said[k] : std::max(upper[k], said[k]);
    }
  }
}

/// Trains a residual from `engine`, up to `epochs` of the schedule's. `after_batch` as Trainer::epoch() calls it; after
/// each epoch `visit(trainer, epoch)`. False where `goes_on(epoch)` stopped it.
template <class Residual, class ShownContext, class Data, class AfterBatch, class Engine, class GoesOn, class Visit>
bool train_residual(const ShownContext& shown, const Data& data, const AfterBatch& after_batch,
                    const ResidualTraining& how, int epochs, Engine& engine, const GoesOn& goes_on,
                    const Visit& visit) {
  using Optimizer = Scheduled<Adam, CosineDecay>;
  constexpr int batch = 64;
  using ResidualTrainer = Trainer<Residual, Mse, Optimizer, ShownContext, ShuffledBatches, batch>;
  static_assert(std::is_same_v<typename Residual::Scalar, float>, "pinnquad: a residual is trained in float");
  Optimizer optimizer;
  optimizer.optimizer.learning_rate = how.learning_rate;
  optimizer.optimizer.weight_decay = how.weight_decay;
  const auto trainer = std::make_unique<ResidualTrainer>(initialised<Residual>(engine), Mse{}, optimizer, shown);
  for (int epoch = 0; epoch < epochs; ++epoch) {
    if (!goes_on(epoch)) return false;
    trainer->epoch(data, {epoch, how.epochs}, engine, after_batch);
    visit(*trainer, epoch);
  }
  return true;
}

/// Base and residual, which is bounded to its outputs on its rows.
template <class Bound, class Predictor, class Base, class Residual, class Data>
Predictor base_and_residual(const Base& base, const Residual& residual, const Data& data) {
  Predictor predictor{};
  auto* to = std::copy(base.parameters.begin(), base.parameters.end(), predictor.parameters.begin());
  take_range(residual, data, to + Bound::lower, to + Bound::upper);
  std::copy(residual.parameters.begin(), residual.parameters.end(), to + Bound::own);
  return predictor;
}

/// `Bound`: the residual's type with its bounds. `shown` is the context of the features that the residual is shown,
/// `show` gives it its rows of the base's. `after_batch` as Trainer::epoch() calls it.
template <class Residual, class Bound, class Predictor, class ContextType, class ShownContext, class Show,
          class AfterBatch, class Engine, class GoesOn>
ResidualFit<typename ContextType::Features, Predictor> fit_residual(const ContextType& context,
                                                                    const ShownContext& shown, const Show& show,
                                                                    const AfterBatch& after_batch,
                                                                    const RowSet& training, const RowSet& validation,
                                                                    const AffineMap& map, const ResidualTraining& how,
                                                                    Engine& engine, const GoesOn& goes_on) {
  ResidualFit<typename ContextType::Features, Predictor> fit;
  fit.base = monotone_base<ContextType>(map);
  auto rows = standardised<float>(context, training);
  const auto unseen = standardised<float>(context, validation);
  auto left = unseen;
  take_away(map, rows);
  take_away(map, left);
  const auto data = show(std::move(rows)), validating = show(std::move(left));
  fit.base_error = fit.error = command_error(context, fit.base, unseen);

  Checkpoint<Residual> best;
  fit.finished = train_residual<Residual>(
      shown, data, after_batch, how, how.epochs, engine, goes_on,
      [&](auto& trainer, int epoch) { best.offer(epoch, trainer.validate(validating).mean_absolute, trainer); });
  if (!fit.finished || best.empty()) return fit;
  fit.epoch = best.epoch();
  fit.predictor = base_and_residual<Bound, Predictor>(fit.base, best.network(), data);
  fit.error = command_error(context, fit.predictor, unseen);
  fit.residual_kept = fit.error < (1 - how.least_gain) * fit.base_error;
  return fit;
}

/// Keeps a network that is shown the angular acceleration from turning a base's slope round. Each column of its first
/// layer that takes an angular acceleration is scaled by min(1, share slope / d). d is the path bound of its effect on
/// the other three axis commands and of what it takes off the slope of its own, so that each rotor keeps its direction
/// too. d is proportional to the column: once is enough. Each tap of a window has an equal part of the lesser of the
/// present's slope and the held one.
///   trainer.epoch(data, progress, engine, [&](auto& trained) { trained.project(projection); });
template <class ContextType, class Residual>
class PathProjection {
  using Features = typename ContextType::Features;
  using Base = MonotoneBase<Features>;
  using Path = PathBounded<Residual>;

 public:
  /// `map`: the base, standardised by `context`; its slopes are above 0. Throws std::invalid_argument for another one,
  /// and for a share outside 0 to below 1.
  PathProjection(const ContextType& context, const AffineMap& map, double share = 0.9) {
    if (!(share >= 0 && share < 1)) throw std::invalid_argument("path projection: expected a share from 0 to below 1");
    Base::Threes::each([&](int place, int tap) { places_[static_cast<std::size_t>(tap)] = place; });
    for (std::size_t k = 0; k < 4; ++k) output_deviation_[k] = context.output.standard_deviation[k];
    for (int axis = 0; axis < 3; ++axis) {
      double present = 0, held = 0;
      for (int tap = 0; tap < Base::taps; ++tap) {
        const int place = places_[static_cast<std::size_t>(tap)] + axis;
        const double deviation = context.input.standard_deviation[static_cast<std::size_t>(place)];
        deviation_[static_cast<std::size_t>(3 * tap + axis)] = deviation;
        const double slope = map.weights.at(static_cast<std::size_t>((1 + axis) * Features::size + place)) *
                             output_deviation_[static_cast<std::size_t>(1 + axis)] / deviation;
        if (tap == 0) present = slope;
        held += slope;
      }
      const double least = std::min(present, held);
      if (!(least > 0)) throw std::invalid_argument("path projection: expected a base whose slopes are above 0");
      allowed_[static_cast<std::size_t>(axis)] = share * least / Base::taps;
    }
  }

  void operator()(typename Residual::Parameters& parameters) const noexcept {
    constexpr int rows = Residual::template Layer<0>::outputs;
    for (int tap = 0; tap < Base::taps; ++tap) {
      for (int axis = 0; axis < 3; ++axis) {
        const int place = places_[static_cast<std::size_t>(tap)] + axis;
        const double most =
            danger(Path::bound(parameters.data(), place), axis) / deviation_[static_cast<std::size_t>(3 * tap + axis)];
        const double allowed = allowed_[static_cast<std::size_t>(axis)];
        if (!(most > allowed)) continue;
        const auto factor = static_cast<typename Residual::Scalar>(allowed / most);
        for (int row = 0; row < rows; ++row) {
          parameters[static_cast<std::size_t>(row * Residual::inputs + place)] *= factor;
        }
      }
    }
  }

 private:
  double danger(const detail::PathBound<4>& bound, int axis) const noexcept {
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      const double below = -bound.lower[k], worst = std::max(below, bound.upper[k]);
      sum += (k == 1 + axis ? below : worst) * output_deviation_[static_cast<std::size_t>(k)];
    }
    return sum;
  }

  std::array<int, static_cast<std::size_t>(Base::taps)> places_{};
  std::array<double, static_cast<std::size_t>(3 * Base::taps)> deviation_{};
  std::array<double, 4> output_deviation_{};
  std::array<double, 3> allowed_{};
};

}  // namespace detail

/// A residual that is not shown the angular acceleration, on the base `map`, bounded to its outputs on the training
/// rows. `Residual`: a float Network of residual_inputs<Features> features and 4 outputs. `goes_on(epoch)` is asked
/// before each epoch. Throws std::invalid_argument for rows that are too few.
template <class Residual, class ContextType, class Engine, class GoesOn>
auto fit_monotone(const ContextType& context, const RowSet& training, const RowSet& validation, const AffineMap& map,
                  const ResidualTraining& how, Engine& engine, const GoesOn& goes_on) {
  using Features = typename ContextType::Features;
  return detail::fit_residual<Residual, MonotoneResidual<Features, Residual>, MonotonePredictor<Features, Residual>>(
      context, residual_context(context), [](const auto& rows) { return residual_rows<Features>(rows); },
      [](const auto&) {}, training, validation, map, how, engine, goes_on);
}

/// As fit_monotone(), but the residual is shown all features. `Residual`: at most 3 Dense layers with activations of
/// slope 0 to 1 between them (model/path_bound.hpp). `share`: of a slope, the most that the residual may take away.
template <class Residual, class ContextType, class Engine, class GoesOn>
auto fit_path_bounded(const ContextType& context, const RowSet& training, const RowSet& validation,
                      const AffineMap& map, const ResidualTraining& how, Engine& engine, const GoesOn& goes_on,
                      double share = 0.9) {
  const detail::PathProjection<ContextType, Residual> projection(context, map, share);
  return detail::fit_residual<Residual, Saturated<PathBounded<Residual>>,
                              PathBoundedPredictor<typename ContextType::Features, Residual>>(
      context, context, [](auto rows) { return rows; }, [&](auto& trained) { trained.project(projection); }, training,
      validation, map, how, engine, goes_on);
}

}  // namespace pinnquad
