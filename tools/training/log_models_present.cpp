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
      const pinnquad::RegressionSums sums = pinnquad::regression_sums(
          pinnquad::fit_context(context), rows, 4, [&](const double*, const pinnquad::Commands<double>& commands) {
            const std::array<double, 4> wrench = pinnquad::product(allocation, commands);
            return std::vector<double>(wrench.begin(), wrench.end());
          });
      return solved_physics(sums, {Features::names.begin(), Features::names.end()}, allocation, context.output);
    });
  });
}

/// No model of the vehicle: a motor goes on as it did. What a model of the motion has to be better than.
class LastCommands : public TrainedNetwork {
 public:
  /// The mean of the commands 100 to 150 ms before a row; NaN where none was logged then.
  Predictions predictions(const pinnquad::RowSet& rows) const override {
    constexpr double youngest_s = 0.1, oldest_s = 0.15, rounding_s = 1e-6;
    Predictions result;
    for (const pinnquad::FlightRows& piece : rows.pieces()) {
      const pinnquad::Flight& flight = *piece.flight;
      for (std::size_t row = piece.rows.begin; row < piece.rows.end; ++row) {
        pinnquad::Commands<double> mean{};
        double count = 0;
        for (std::size_t past = row; past > piece.rows.begin; --past) {
          const double age_s = flight[row].time_s - flight[past - 1].time_s;
          if (age_s > oldest_s + rounding_s) break;
          if (age_s < youngest_s - rounding_s) continue;
          for (std::size_t motor = 0; motor < mean.size(); ++motor) mean[motor] += flight[past - 1].commands[motor];
          ++count;
        }
        for (double& command : mean) command = count > 0 ? command / count : pinnquad::not_a_number;
        result.push_back(mean);
      }
    }
    return result;
  }
  DerivativeFigures derivatives(const pinnquad::RowSet& /*rows*/) const override { return {}; }
};

}  // namespace

ModelKind log_last_commands() {
  ModelKind kind{
      "last_commands",
      "commands 100 ms ago",
      TimeReach::present,
      false,
      always_applicable,
      [](const FitTask&) -> std::shared_ptr<const TrainedNetwork> { return std::make_shared<LastCommands>(); }};
  kind.exportable = false;
  return kind;
}
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
