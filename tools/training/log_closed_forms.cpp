// SPDX-License-Identifier: MIT
// Models of logged flights that nobody trains: the mean of the commands and the last ones, the airframe's formula,
// linear and ridge regression, physics with fitted parameters. They need no rows to stop by: all that are not held out
// are fitted, the penalty by leaving out trajectories.
#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/deploy/fitted_model.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/regression/ridge.hpp"
#include "pinnquad/training/structured/closed_form.hpp"
#include "training/log_features.hpp"
#include "training/log_kinds.hpp"

namespace programs {

namespace {

using Model = std::shared_ptr<const TrainedNetwork>;
using pinnquad::AffineMap, pinnquad::FitContext, pinnquad::GroundFeatures, pinnquad::RegressionSums, pinnquad::RowSet;

/// Training and validation.
RowSet rows_not_held_out(const FitTask& fit) {
  RowSet rows = fit.training;
  for (const pinnquad::FlightRows& piece : fit.validation.pieces()) rows.add(*piece.flight, piece.rows);
  return rows;
}

/// `solve(context, rows)` gives the map of standardised features to standardised outputs.
template <class Outputs = pinnquad::CommandOutputs, class Solve>
Model fit_affine(const FitTask& fit, const GroundFeatures& features, const Solve& solve) {
  const RowSet rows = rows_not_held_out(fit);
  const pinnquad::GivenAirframe airframe = fit.given_airframe();
  FitContext context =
      pinnquad::fit_context(fit.shared->keep(features), pinnquad::ground_outputs<Outputs>(airframe), airframe, rows);
  const AffineMap map = solve(context, rows);
  return std::make_shared<ExportableNetwork>(pinnquad::affine_model(context, map, rows), rows);
}

/// Standardised outputs have the mean 0.
AffineMap no_map(const FitContext& context) {
  AffineMap map;
  map.inputs = context.inputs();
  map.outputs = context.outputs();
  map.weights.assign(static_cast<std::size_t>(map.inputs * map.outputs), 0.0);
  map.intercept.assign(static_cast<std::size_t>(map.outputs), 0.0);
  return map;
}

/// Least squares; ridge regression with a penalty that is found by leaving out each group in turn. One group alone: no
/// penalty.
AffineMap solved(const FitContext& context, const RowSet& rows, bool ridge) {
  const std::vector<RegressionSums> groups = pinnquad::regression_sums(context, pinnquad::left_out_groups(rows));
  RegressionSums all = groups.front();
  for (std::size_t i = 1; i < groups.size(); ++i) all += groups[i];
  return pinnquad::fit_ridge(all, ridge && groups.size() > 1 ? pinnquad::choose_penalty(groups) : 0.0);
}

/// The columns that the thrust and the torques about x, y, z depend on.
const std::array<std::vector<std::string>, 4> physics_terms = {{{"s_z", "v_bz", "vv_bz", "battery_voltage"},
                                                                {"wdot_x", "w_yz", "w_x", "v_by"},
                                                                {"wdot_y", "w_zx", "w_y", "v_bx"},
                                                                {"wdot_z", "w_xy", "w_z"}}};

/// Physics with parameters that are fitted: thrust along -z by the specific force (mass over thrust coefficient), the
/// velocity along z and its square (inflow, drag) and the battery; the torque about each axis by the angular
/// acceleration (inertia over effectiveness), the product of the other two rates (gyroscopic), the rate (damping) and
/// the velocity across (flapping); each with a trim. What the features have not is left out.
AffineMap solved_physics(const FitContext& context, const RowSet& rows) {
  const auto allocation = pinnquad::allocation(context.airframe);
  const RegressionSums sums =
      pinnquad::regression_sums(context, rows, 4, [&](const double*, const pinnquad::Commands<double>& commands) {
        const std::array<double, 4> made = pinnquad::product(allocation, commands);
        return std::vector<double>(made.begin(), made.end());
      });
  pinnquad::AllocationMatrix<double> inverse{};
  if (pinnquad::invert_allocation(allocation, inverse) != pinnquad::Status::ok) {
    throw std::invalid_argument("the airframe's rotors can't make every thrust and torque");
  }
  std::array<AffineMap, 4> wrench;
  for (std::size_t part = 0; part < wrench.size(); ++part) {
    std::vector<bool> taken;
    for (const std::string& name : context.features.names) {
      const std::vector<std::string>& terms = physics_terms[part];
      taken.push_back(std::find(terms.begin(), terms.end(), name) != terms.end());
    }
    wrench[part] = pinnquad::fit_ridge(sums, 0.0, taken);
  }
  AffineMap map = no_map(context);
  const std::size_t inputs = context.features.size();
  for (std::size_t rotor = 0; rotor < pinnquad::rotor_count; ++rotor) {
    map.intercept[rotor] = -context.output_mean[rotor] / context.output_deviation[rotor];
    for (std::size_t part = 0; part < wrench.size(); ++part) {
      const double share = inverse[rotor][part] / context.output_deviation[rotor];
      map.intercept[rotor] += share * wrench[part].intercept[part];
      for (std::size_t i = 0; i < inputs; ++i) {
        map.weights[rotor * inputs + i] += share * wrench[part].weights[part * inputs + i];
      }
    }
  }
  return map;
}

Model fit_constant(const FitTask& fit) {
  const auto every_log_has = feature_names<pinnquad::PhysicsFeaturesWithoutVelocity>();
  return fit_affine(fit, pinnquad::named_features(every_log_has.type, every_log_has.names, every_log_has.units),
                    [](const FitContext& context, const RowSet&) { return no_map(context); });
}

Model fit_physics(const FitTask& fit) {
  return fit_affine(fit, physics_features(fit, TimeReach::present), solved_physics);
}

Model fit_linear(const FitTask& fit) {
  const auto paper = feature_names<pinnquad::PaperFeatures>();
  return fit_affine(fit, log_features(fit, TimeReach::present, paper, paper),
                    [](const FitContext& context, const RowSet& rows) { return solved(context, rows, false); });
}

/// A residual of 0 on Eq. (3) inverted.
Model fit_linearized(const FitTask& fit) {
  const auto paper = feature_names<pinnquad::PaperFeatures>();
  return fit_affine<pinnquad::ResidualOutputs<pinnquad::LinearizedBase>>(
      fit, pinnquad::named_features(paper.type, paper.names, paper.units), [](FitContext& context, const RowSet&) {
        std::fill(context.output_mean.begin(), context.output_mean.end(), 0.0);
        return no_map(context);
      });
}

template <TimeReach Reach>
Model fit_log_ridge(const FitTask& fit) {
  return fit_affine(fit, physics_features(fit, Reach),
                    [](const FitContext& context, const RowSet& rows) { return solved(context, rows, true); });
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

/// A closed form of this name.
ModelKind closed_form(const char* key, const char* title, std::string (*not_applicable)(const FitTask&),
                      Model (*fit)(const FitTask&), TimeReach reach = TimeReach::present) {
  return {key, title, reach, false, not_applicable, fit, takes_validation_rows, nullptr, true, true};
}

}  // namespace

ModelKind log_last_commands() {
  ModelKind kind{"last_commands",    "commands 100 ms ago",
                 TimeReach::present, false,
                 always_applicable,  [](const FitTask&) -> Model { return std::make_shared<LastCommands>(); }};
  kind.exportable = false;
  return kind;
}
ModelKind log_constant() { return closed_form("constant", "mean of the commands", always_applicable, fit_constant); }
ModelKind log_physics() { return closed_form("physics", "physics, parameters fitted", always_applicable, fit_physics); }
ModelKind log_linear() { return closed_form("linear", "linear on the paper's features", needs_velocity, fit_linear); }
ModelKind log_linearized() {
  return closed_form("linearized", "linearized model of the airframe", needs_velocity, fit_linearized);
}
ModelKind log_ridge() {
  return closed_form("ridge", "ridge on physics features", always_applicable, fit_log_ridge<TimeReach::present>);
}
ModelKind log_ridge_causal() {
  return closed_form("ridge_causal", "ridge, the last 160 ms", needs_window, fit_log_ridge<TimeReach::causal>,
                     TimeReach::causal);
}
ModelKind log_ridge_centred() {
  return closed_form("ridge_centred", "ridge, 80 ms to both sides", needs_window, fit_log_ridge<TimeReach::centred>,
                     TimeReach::centred);
}

}  // namespace programs
