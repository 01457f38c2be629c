// SPDX-License-Identifier: MIT
#include "pinnquad/evaluation/judgement.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
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

/// y_k = sum_i cos(1.7 (i + 1)(k + 1)) x_i + 0.1 k, nothing standardised.
Model linear_model() {
  Model model;
  model.input.standard_deviation.fill(1);
  model.output.standard_deviation.fill(1);
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i < 16; ++i) model.network.parameters[std::size_t(16 * k + i)] = std::cos(1.7 * (i + 1) * (k + 1));
    model.network.parameters[std::size_t(64 + k)] = 0.1 * k;
  }
  return model;
}

/// Rows whose commands are the model's, moved by `offset`, whether or not a motor could do it.
Flight obedient_flight(const Model& model, double offset) {
  Flight flight = test::random_flight_rows(300, 5);
  for (std::size_t row = 0; row < flight.size(); ++row) {
    const auto u = model.predict(flight[row]);
    for (std::size_t k = 0; k < 4; ++k) flight[row].commands[k] = u[k] + offset;
  }
  return flight;
}

}  // namespace

TEST_CASE("errors of a model on rows: none where it answers what was flown, the offset where all is offset") {
  const Model model = linear_model();
  const Flight flight = obedient_flight(model, 0), moved = obedient_flight(model, 0.25);
  const RowSet all(flight, {0, flight.size()}), part(moved, {50, 90});
  const auto none = model_errors(model, all), offset = model_errors(model, part);
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(none.per_motor[k].mean_absolute == doctest::Approx(0).scale(1).epsilon(rounding));
    CHECK(none.per_motor[k].r_squared == doctest::Approx(1).epsilon(rounding));
    CHECK(offset.per_motor[k].mean_absolute == doctest::Approx(0.25).epsilon(rounding));
    CHECK(offset.per_motor[k].root_mean_square == doctest::Approx(0.25).epsilon(rounding));
  }
}

TEST_CASE("the verdict on a model: the regression is fitted to the training rows, both are judged by the test rows") {
  const Model model = linear_model();
  Flight flight = obedient_flight(model, 0);
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
