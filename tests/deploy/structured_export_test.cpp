// SPDX-License-Identifier: MIT
// A structured model that is exported as a value is that of its types to the byte: header, block, what trust asks; and
// so is one whose features are known by name alone. So are closed forms.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "pinnquad/core/random.hpp"
#include "pinnquad/deploy/export_model.hpp"
#include "pinnquad/deploy/structured_model.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/evaluation/judgement.hpp"
#include "pinnquad/features/extra_columns.hpp"
#include "pinnquad/features/windowed.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"

using namespace pinnquad;

namespace {

/// Commands that curve with the velocity: the residual finds something.
Dataset curved_flights() {
  std::mt19937_64 engine(3);
  Flight flight(1200);
  flight.name = "curved";
  ExtraColumn battery{{BatteryVoltage::name, BatteryVoltage::unit}, {}};
  const auto airframe = PaperQuadrotor::value<double>();
  for (std::size_t row = 0; row < flight.size(); ++row) {
    Sample& sample = flight[row];
    sample.time_s = 0.05 * static_cast<double>(row);
    sample.altitude_m = uniform(engine, 1, 4);
    for (int i = 0; i < 3; ++i) {
      sample.linear_acceleration_m_s2[i] = uniform(engine, -3, 3);
      sample.angular_acceleration_rad_s2[i] = uniform(engine, -20, 20);
      sample.velocity_m_s[i] = uniform(engine, -2, 2);
      sample.body_rates_rad_s[i] = uniform(engine, -2, 2);
    }
    battery.values.push_back(uniform(engine, 14, 16));
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
      double u = 0.5 + 0.1 * std::cos(1.5 * sample.velocity_m_s[0]) - 0.02 * (battery.values.back() - 15);
      for (int axis = 0; axis < 3; ++axis) {
        u += allocation_signs(airframe, axis)[rotor] * 0.004 * sample.angular_acceleration_rad_s2[axis];
      }
      sample.commands[rotor] = u;
    }
  }
  flight.add_column(battery);
  return Dataset(flight);
}

template <class Scalar>
std::string text_of(const GroundModel<Scalar>& model, const RowSet& rows) {
  std::ostringstream out;
  write_model(out, "Same", model, golden_features(model, rows), {});
  return out.str();
}

/// Equal, or none for both.
bool same(const std::vector<Commands<double>>& a, const std::vector<Commands<double>>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Commands<double>& x, const Commands<double>& y) {
    return x == y || (std::isnan(x[0]) && std::isnan(y[0]));
  });
}

template <class Features>
GroundFeatures by_name_of() {
  const GroundFeatures typed = ground_features<Features>();
  GroundFeatures named = named_features(typed.type, typed.names, typed.units, typed.window);
  CHECK(named.accelerations == typed.accelerations);
  CHECK(named.columns.size() == typed.columns.size());
  return named;
}

template <class Features>
bool compare(bool with_residual) {
  const Dataset flights = curved_flights();
  const RowSplit split = split_for_training(flights);
  const GivenAirframe airframe = given_airframe<PaperQuadrotor>();
  StructuredSettings settings;
  settings.seeds = 1;
  settings.residual.epochs = 8;
  if (!with_residual) settings.residual.least_gain = 1;
  const StructuredFits::Fit fit = fit_structured<Features, Features>(split, airframe, settings).best();
  const GroundModel<float>& value = fit.model;
  using Setting = Context<Features, GivenAirframe, AxisCommandOutputs>;
  using Base = TrainedModel<MonotoneBase<Features>, Setting>;
  using Whole = TrainedModel<MonotonePredictor<Features, StructuredResidual<residual_inputs<Features>>>, Setting>;
  const StructuredSet by_name =
      structured_set(by_name_of<Features>(), airframe, detail::residual_trainer<StructuredResidual<32>>());
  const StructuredFits::Fit named = fit_structured(StructuredBases(by_name, {}, split), settings).best();
  CHECK(named.parameters == fit.parameters);
  CHECK(text_of(named.model, split.train) == text_of(value, split.train));
  const auto same_as = [&](auto tag) {
    using Model = typename decltype(tag)::type;
    typename Model::Network predictor{};
    REQUIRE(fit.parameters.size() == predictor.parameters.size());
    std::copy(fit.parameters.begin(), fit.parameters.end(), predictor.parameters.begin());
    const auto context = make_context<Setting>(split.train, airframe);
    const GroundModel<float> of_types = ground_model(make_trained_model(predictor, context, split.train));
    CHECK(text_of(value, split.train) == text_of(of_types, split.train));
    const auto golden = golden_features(value, split.train);
    CHECK(model_block(value, golden, {}) == model_block(of_types, golden, {}));
    constexpr double shrinkage = FittedTrust::Settings{}.shrinkage;
    const auto joint = detail::fit_joint_distribution(value, split.train, shrinkage);
    CHECK(joint.whitening == detail::fit_joint_distribution(of_types, split.train, shrinkage).whitening);
    CHECK(trust_series(value, joint, split.validation).errors ==
          trust_series(of_types, joint, split.validation).errors);
    CHECK(same(predicted_commands(value, split.test, true), predicted_commands(of_types, split.test, true)));
    CHECK(judge(value, split).verdict.answered_share == judge(of_types, split).verdict.answered_share);
  };
  fit.has_residual ? same_as(std::common_type<Whole>{}) : same_as(std::common_type<Base>{});
  return fit.has_residual;
}

}  // namespace

TEST_CASE("with a residual, with the altitude and a column, of a window") {
  CHECK(compare<InverseFeatures>(true));
  CHECK(compare<WithColumns<InverseFeaturesWithAltitude, BatteryVoltage>>(true));
  CHECK_FALSE(compare<InverseFeatures>(false));
  compare<PartlyWindowed<InverseFeatures, InverseAccelerations, 3, PeriodMicroseconds<50000>, Centred>>(true);
}

TEST_CASE("a closed form of features by name, of a base and of a window") {
  const Dataset flights = curved_flights();
  const RowSet rows = split_for_training(flights).train;
  const GivenAirframe airframe = given_airframe<PaperQuadrotor>();
  const auto same = [&](auto features, auto outputs) {
    using Features = typename decltype(features)::type;
    using Setting = Context<Features, GivenAirframe, typename decltype(outputs)::type>;
    const auto context = make_context<Setting>(rows, airframe);
    const FitContext by_name =
        fit_context(by_name_of<Features>(), ground_outputs<typename Setting::Outputs>(airframe), airframe, rows);
    const AffineMap map = fit_ridge(regression_sums(context, rows), 0.1);
    const AffineMap of_names = fit_ridge(regression_sums(by_name, rows), 0.1);
    CHECK(map.weights == of_names.weights);
    const GroundModel<float> typed = ground_model(make_trained_model(affine_answer<Setting>(map), context, rows));
    CHECK(text_of(affine_model(by_name, of_names, rows), rows) == text_of(typed, rows));
  };
  using Paper = WithColumns<PaperFeatures, BatteryVoltage>;
  same(std::common_type<Paper>{}, std::common_type<CommandOutputs>{});
  same(std::common_type<PaperFeatures>{}, std::common_type<ResidualOutputs<LinearizedBase>>{});
  same(std::common_type<PartlyWindowed<Paper, AccelerationFeatures, 3, PeriodMicroseconds<50000>>>{},
       std::common_type<CommandOutputs>{});
}

TEST_CASE("names that are no feature set, a map of another size, rows without features") {
  const Dataset flights = curved_flights();
  const RowSet rows = split_for_training(flights).train;
  const GivenAirframe airframe = given_airframe<PaperQuadrotor>();
  CHECK_THROWS_AS(named_features("Set", {"w_x"}, {"m"}), std::invalid_argument);             // another unit
  CHECK_THROWS_AS(named_features("Set", {"w_x", "w_y"}, {"rad/s"}), std::invalid_argument);  // a unit is missing
  CHECK_THROWS_AS(named_features("Set", {"w_x", "w_x"}, {"rad/s", "rad/s"}), std::invalid_argument);
  const GroundFeatures rates = named_features("Set", {"w_x", "w_y"}, {"rad/s", "rad/s"});
  const auto trainer = detail::residual_trainer<StructuredResidual<16>>();
  CHECK_THROWS_AS(structured_set(rates, airframe, trainer), std::invalid_argument);  // no angular acceleration
  const auto commands = ground_outputs<CommandOutputs>(airframe);
  CHECK_THROWS_AS(affine_model(fit_context(rates, commands, airframe, rows), AffineMap{}, rows), std::invalid_argument);
  CHECK_THROWS_AS(fit_context(rates, commands, airframe, RowSet{}), std::invalid_argument);
}
