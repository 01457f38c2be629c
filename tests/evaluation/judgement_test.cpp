// SPDX-License-Identifier: MIT
#include "pinnquad/evaluation/judgement.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/nn/dense.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "support/training_sets.hpp"

using namespace pinnquad;

namespace {

using Linear = Network<double, InputSize<16>, Dense<4>>;
using Model = TrainedModel<Linear, Context<PaperFeatures, PaperQuadrotor>>;

constexpr double rounding = 1e-9;  // of sums over some hundred rows of order 1, and of the regression's moments

/// Nothing standardised; an envelope of +-`half_width` about 0.
Model linear_model(double half_width) {
  Model model;
  model.input.standard_deviation.fill(1);
  model.output.standard_deviation.fill(1);
  model.envelope_lower.fill(-half_width);
  model.envelope_upper.fill(half_width);
  for (std::size_t i = 0; i < 64; ++i) model.network.parameters[i] = 0.01 * std::cos(1.7 * double(i));
  return model;
}

std::vector<Commands<double>> flown(const RowSet& rows) {
  std::vector<Commands<double>> commands;
  for (std::size_t row = 0; row < rows.size(); ++row) commands.push_back(rows[row].commands);
  return commands;
}

/// Rows whose commands are the model's, whether or not a motor could do it.
Flight obedient_flight(const Model& model) {
  Flight flight = test::random_flight_rows(300, 5);
  for (std::size_t row = 0; row < flight.size(); ++row) flight[row].commands = model.predict(flight[row]);
  return flight;
}

}  // namespace

TEST_CASE("a step is large by half a deviation of the angular acceleration, whatever the commands are") {
  std::array<AxisSeries, 3> series;
  for (AxisSeries& s : series) {
    // deviation near 10: steps of 20 are large, of 1 are not; the predicted sum moves against the small ones alone
    s.angular_acceleration = {-10, -9, 10, 9, -10, -9, 10, 9, -10};
    s.target = {-0.10, -0.09, 0.10, 0.09, -0.10, -0.09, 0.10, 0.09, -0.10};
    s.predicted = {-0.10, -0.11, 0.10, 0.11, -0.10, -0.11, 0.10, 0.11, -0.10};
  }
  const auto check = [&] {
    const auto signs = pair_signs(series);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      CHECK(signs.all[axis] == 0.5);
      CHECK(signs.large[axis] == 0);
      CHECK(signs.of_flown[axis] == 0);
    }
  };
  check();
  for (AxisSeries& s : series) {
    for (double& sum : s.target) sum *= 1e4;
  }
  check();
}

TEST_CASE("the flown commands themselves have no error, and the signs of the flown") {
  const Flight flight = test::random_flight_rows(200, 4);
  const RowSet rows(flight, {0, 200});
  const Context<PaperFeatures, PaperQuadrotor> airframe;
  const Judgement judged = judge(airframe, rows, flown(rows));
  CHECK(judged.errors.mean.mean_absolute == 0);
  CHECK(judged.errors.mean.r_squared == 1);
  CHECK(judged.nominal_slopes == hover_slopes(airframe_value<PaperQuadrotor, double>()));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CHECK(judged.axes[axis].slope_error == 0);
    CHECK(judged.pairs.all[axis] == judged.pairs.of_flown[axis]);
    CHECK(judged.pairs.large[axis] == judged.pairs.large_of_flown[axis]);
    CHECK(judged.pairs.all[axis] > 0.3);  // commands that are not related to the motion
  }
  auto turned = flown(rows);
  for (auto& u : turned) {
    for (double& v : u) v = 1 - v;
  }
  const Judgement wrong = judge(airframe, rows, turned);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CHECK(wrong.axes[axis].slope_error == doctest::Approx(2));
    CHECK(wrong.pairs.all[axis] == doctest::Approx(1 - judged.pairs.all[axis]));
  }
  CHECK_THROWS_AS(judge(airframe, rows, {}), std::invalid_argument);
}

TEST_CASE("the verdict on a model: the regression is fitted to the training rows, both are judged by the test rows") {
  const Model model = linear_model(1e3);
  Flight flight = obedient_flight(model);
  const RowSet training(flight, {0, 200}), test(flight, {200, 300});
  const Verdict linear = verdict_on(model, training, test);
  CHECK(linear.test_r_squared == doctest::Approx(1).epsilon(rounding));
  CHECK(linear.linear_regression_r_squared == doctest::Approx(1).epsilon(rounding));
  CHECK(linear.worst_motor_r_squared == doctest::Approx(1).epsilon(rounding));

  Model constant = model;  // the means of the test rows: R^2 is 0
  constant.network.parameters.fill(0);
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t row = 200; row < 300; ++row) constant.output.mean[k] += flight[row].commands[k] / 100;
  }
  const Verdict flat = verdict_on(constant, training, test);
  CHECK(flat.test_r_squared == doctest::Approx(0).scale(1).epsilon(rounding));
  CHECK(flat.linear_regression_r_squared == doctest::Approx(1).epsilon(rounding));
  CHECK_FALSE(flat.beats_linear_regression());

  // training rows that say the opposite: the regression follows them, the model does not
  for (std::size_t row = 0; row < 200; ++row) {
    for (double& u : flight[row].commands) u = -u;
  }
  const Verdict opposite = verdict_on(model, training, test);
  CHECK(opposite.test_r_squared == doctest::Approx(1).epsilon(rounding));
  CHECK(opposite.linear_regression_r_squared < 0);
  CHECK(opposite.beats_linear_regression());

  CHECK_THROWS_AS(verdict_on(model, RowSet(), test), std::invalid_argument);
  CHECK_THROWS_AS(verdict_on(model, training, RowSet()), std::invalid_argument);
}

TEST_CASE("a model on a split: test rows judge, validation rows give their error, the verdict is beside regression") {
  const Flight flight = test::random_flight_rows(500, 5);
  const RowSplit split{RowSet(flight, {0, 300}), RowSet(flight, {300, 400}), RowSet(flight, {400, 500})};
  const Model model = linear_model(1e3);
  const Judgement judged = judge(model, split);
  CHECK(judged.errors.mean.root_mean_square == model_errors(model, split.test).mean.root_mean_square);
  CHECK(judged.validation_error == model_errors(model, split.validation).mean.mean_absolute);
  const Verdict verdict = verdict_on(model, split.train, split.test);  // its features are the paper's
  CHECK(judged.verdict.test_r_squared == verdict.test_r_squared);
  CHECK(judged.verdict.linear_regression_r_squared == verdict.linear_regression_r_squared);
  CHECK(judged.verdict.worst_motor_r_squared == verdict.worst_motor_r_squared);
}

TEST_CASE("a model of a window is judged by the rows that have one; pairs of rows end with a flight") {
  using Features = Windowed<PaperFeatures, 3, PeriodMicroseconds<50000>>;
  TrainedModel<Network<double, InputSize<Features::size>, Dense<4>>, Context<Features, PaperQuadrotor>> model;
  model.input.standard_deviation.fill(1);
  model.output.standard_deviation.fill(1);
  for (std::size_t i = 0; i < 64; ++i) model.network.parameters[i] = 0.01 * std::cos(1.7 * double(i));
  const Flight flight = test::random_flight_rows(500, 5), other = test::random_flight_rows(60, 8);
  RowSplit split{RowSet(flight, {0, 300}), RowSet(flight, {300, 400}), RowSet(flight, {400, 500})};
  split.test.add(other, {0, 60});
  const Judgement judged = judge(model, split);
  CHECK(judged.errors.mean.root_mean_square == model_errors(model, split.test).mean.root_mean_square);
  CHECK(std::isfinite(judged.verdict.test_r_squared));
  CHECK(judged.verdict.answered_share == 0);  // its envelope is a point
  for (std::size_t axis = 0; axis < 3; ++axis) CHECK(std::isfinite(judged.axes[axis].sign_violation_share));
  const auto series =
      axis_series(GivenAirframe("x", airframe_value<PaperQuadrotor, double>()), split.test, flown(split.test));
  CHECK(series[0].starts == std::vector<std::size_t>{0, 100});
}

TEST_CASE("the commands of a model, row by row; NaN where the guard of its export declines") {
  const Flight flight = test::random_flight_rows(100, 6);
  RowSet rows(flight, {0, 40});
  rows.add(flight, {60, 100});
  const Model model = linear_model(8);
  const auto all = predicted_commands(model, rows), inside = predicted_commands(model, rows, true);
  REQUIRE(all.size() == 80);
  int declined = 0;
  for (std::size_t row = 0; row < all.size(); ++row) {
    CHECK(all[row] == model.predict(rows[row]));
    bool within = true;
    for (const double x : sample_features<PaperFeatures, double>(rows[row])) within = within && std::abs(x) <= 8;
    CHECK(std::isnan(inside[row][0]) == !within);
    if (within) CHECK(inside[row] == all[row]);
    declined += within ? 0 : 1;
  }
  CHECK(declined > 0);
}
