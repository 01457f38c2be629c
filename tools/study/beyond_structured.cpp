// SPDX-License-Identifier: MIT
// Models that are monotone by construction (training/structured/residual_fit.hpp) and no recipe's: with other features,
// on the rigid body's inverse, with a network that is shown the angular acceleration.
#include <algorithm>
#include <optional>
#include <random>

#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/outputs/rigid_body_base.hpp"
#include "study/beyond_models.hpp"
#include "study/path_bounded_fit.hpp"

namespace study {

namespace {

/// `fit_answer(context, map, how, engine, goes_on)` trains.
template <class Features, class Outputs, class Fit>
BeyondTraining train_structured(const BeyondTask& task, Slopes slopes, const Fit& fit_answer) {
  using Context = pinnquad::Context<Features, pinnquad::GivenAirframe, Outputs>;
  const auto context = pinnquad::make_context<Context>(task.split.train, task.airframe);
  std::optional<pinnquad::AxisSlopes> pinned;
  if (slopes == Slopes::pinned) pinned = pinnquad::hover_slopes(context.template airframe<double>());
  const pinnquad::AffineMap map = pinnquad::fit_monotone_base(context, task.split.train, pinned);
  pinnquad::ResidualTraining how;
  how.epochs = task.epochs;
  std::mt19937_64 engine(task.seed);
  const auto fit = fit_answer(context, map, how, engine, [&task](int) { return task.goes_on(); });
  if (!fit.finished) return {};
  // the base alone is the answer with a residual bounded to 0: one type to judge
  auto answer = fit.predictor;
  if (!fit.residual_kept) {
    auto* const residual = std::copy(fit.base.parameters.begin(), fit.base.parameters.end(), answer.parameters.begin());
    std::fill_n(residual, 8, 0.0F);  // the bounds of its four outputs stand first
  }
  const auto model = pinnquad::make_trained_model(answer, context, task.split.train);
  return {std::make_shared<programs::BlockNetwork>(pinnquad::ground_model(model), task.split.train), fit.residual_kept,
          fit.residual_kept};
}

template <int Inputs>
using Residual =
    pinnquad::Mlp<float, pinnquad::InputSize<Inputs>, pinnquad::Hidden<2, 32>, pinnquad::OutputSize<4>, pinnquad::Relu>;

/// A network that is shown no angular acceleration.
template <class Outputs>
BeyondTraining train_monotone(const BeyondTask& task, Slopes slopes) {
  using Features = pinnquad::PhysicsFeatures;
  using Network = Residual<pinnquad::residual_inputs<Features>>;
  return train_structured<Features, Outputs>(
      task, slopes, [&task](const auto& context, const auto& map, const auto& how, auto& engine, const auto& goes_on) {
        return pinnquad::fit_monotone<Network>(context, task.split.train, task.split.validation, map, how, engine,
                                               goes_on);
      });
}

}  // namespace

BeyondTraining train_structured_on_physics(const BeyondTask& task) {
  return train_monotone<pinnquad::AxisCommandOutputs>(task, Slopes::learnt);
}

BeyondTraining train_structured_on_rigid_body(const BeyondTask& task, Slopes slopes) {
  return train_monotone<pinnquad::SignedSumsOn<pinnquad::RigidBodyBase>>(task, slopes);
}

BeyondTraining train_path_bounded(const BeyondTask& task) {
  using Features = pinnquad::InverseFeatures;
  using Network = Residual<Features::size>;
  return train_structured<Features, pinnquad::AxisCommandOutputs>(
      task, Slopes::learnt,
      [&task](const auto& context, const auto& map, const auto& how, auto& engine, const auto& goes_on) {
        return fit_path_bounded<Network>(context, task.split.train, task.split.validation, map, how, engine, goes_on);
      });
}

}  // namespace study
