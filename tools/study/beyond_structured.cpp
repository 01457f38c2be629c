// SPDX-License-Identifier: MIT
// Models that are monotone by construction (training/monotone_fit.hpp): on a ridge, and on the rigid body's inverse.
#include <random>

#include "pinnquad/inference/motion_parts.hpp"
#include "pinnquad/inference/rigid_body_inverse.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/training/monotone_fit.hpp"
#include "study/beyond_models.hpp"

namespace study {

namespace {

template <class Outputs>
BeyondTraining train_structured(const BeyondTask& task, Slopes slopes) {
  using Features = pinnquad::PhysicsFeatures;
  using Context = pinnquad::Context<Features, pinnquad::GivenAirframe, Outputs>;
  using Residual = pinnquad::Mlp<float, pinnquad::InputSize<pinnquad::residual_inputs<Features>>,
                                 pinnquad::Hidden<2, 32>, pinnquad::OutputSize<4>, pinnquad::Relu>;
  const auto context = pinnquad::make_context<Context>(task.split.train, task.airframe);
  pinnquad::SlopeRule rule;
  if (slopes == Slopes::pinned) rule.pinned = pinnquad::hover_slopes(context.template airframe<double>());
  const pinnquad::AffineMap map = pinnquad::fit_monotone_base(context, task.split.train, rule);
  pinnquad::ResidualTraining how;
  how.epochs = task.epochs;
  std::mt19937_64 engine(task.seed);
  const auto fit = pinnquad::fit_monotone<Residual>(context, task.split.train, task.split.validation, map, how, engine,
                                                    [&task](int) { return task.goes_on(); });
  if (!fit.finished) return {};
  // the base alone is the answer with a residual bounded to 0: one type to judge
  auto answer = fit.answer;
  if (!fit.residual_kept) {
    using Bound = pinnquad::MonotoneResidual<Features, Residual>;
    auto* const residual = std::copy(fit.base.parameters.begin(), fit.base.parameters.end(), answer.parameters.begin());
    for (int k = 0; k < 4; ++k) residual[Bound::lower + k] = residual[Bound::upper + k] = 0;
  }
  const auto model = pinnquad::make_trained_model(answer, context, task.split.train);
  return {std::make_shared<JudgedModelOf<std::decay_t<decltype(model)>>>(model), fit.residual_kept, fit.residual_kept};
}

}  // namespace

BeyondTraining train_structured_on_ridge(const BeyondTask& task, Slopes slopes) {
  return train_structured<pinnquad::SignedSumOutputs>(task, slopes);
}

BeyondTraining train_structured_on_rigid_body(const BeyondTask& task, Slopes slopes) {
  return train_structured<pinnquad::SignedSumsOn<pinnquad::RigidBodyInverse>>(task, slopes);
}

}  // namespace study
