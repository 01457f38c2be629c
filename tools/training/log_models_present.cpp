// SPDX-License-Identifier: MIT
// Closed forms that see the present instant: the mean of the commands, physics with fitted parameters, ridge
// regression.
#include "training/log_closed_form.hpp"
#include "training/log_kinds.hpp"

namespace programs {

namespace {

/// Of features that every log has.
std::shared_ptr<const TrainedNetwork> fit_constant(const FitTask& fit) {
  return fit_affine<pinnquad::PhysicsFeaturesWithoutVelocity>(fit, [](const auto& context, const pinnquad::RowSet&) {
    pinnquad::AffineMap map;  // standardised outputs have the mean 0
    map.inputs = std::decay_t<decltype(context)>::Features::size;
    map.outputs = pinnquad::rotor_count;
    map.weights.assign(static_cast<std::size_t>(map.inputs * map.outputs), 0.0);
    map.intercept.assign(pinnquad::rotor_count, 0.0);
    return map;
  });
}

std::shared_ptr<const TrainedNetwork> fit_physics(const FitTask& fit) {
  return with_physics_features<TimeReach::present>(fit, [&](auto tag) {
    using Features = typename decltype(tag)::type;
    return fit_affine<Features>(fit, [](const auto& context, const pinnquad::RowSet& rows) {
      const auto allocation = pinnquad::allocation(context.template airframe<double>());
      const pinnquad::RegressionSums sums =
          pinnquad::regression_sums(context, rows, 4, [&](const auto&, const pinnquad::Commands<double>& commands) {
            const std::array<double, 4> wrench = pinnquad::product(allocation, commands);
            return std::vector<double>(wrench.begin(), wrench.end());
          });
      return solved_physics(sums, {Features::names.begin(), Features::names.end()}, allocation, context.output);
    });
  });
}

}  // namespace

ModelKind log_constant() {
  return {"constant",        "mean of the commands", TimeReach::present,   false,
          always_applicable, fit_constant,           takes_validation_rows};
}
ModelKind log_physics() {
  return {"physics",   "physics, parameters fitted", TimeReach::present, false, always_applicable,
          fit_physics, takes_validation_rows};
}
ModelKind log_ridge() {
  return {"ridge",           "ridge on physics features",       TimeReach::present,   false,
          always_applicable, fit_log_ridge<TimeReach::present>, takes_validation_rows};
}

}  // namespace programs
