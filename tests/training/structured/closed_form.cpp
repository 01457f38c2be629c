// SPDX-License-Identifier: MIT
// Closed forms between a dataset's rows and a trained model.
#include "pinnquad/training/structured/closed_form.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/features/windowed.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "pinnquad/regression/ridge.hpp"
#include "support/random_network.hpp"
#include "support/training_sets.hpp"

using namespace pinnquad;

namespace {

using Window = PartlyWindowed<PhysicsFeatures, AccelerationFeatures, 3, PeriodMicroseconds<20000>>;
using Setting = Context<Window, PaperQuadrotor>;

/// Commands that are affine in the specific force of now and the angular acceleration of 20 ms ago.
Flight flight_of(const std::string& name, const std::string& trajectory, std::size_t rows, std::uint64_t seed) {
  Flight flight = test::random_flight_rows(rows, seed);
  flight.name = name;
  flight.trajectory = trajectory;
  for (std::size_t row = 0; row < rows; ++row) {
    Sample& sample = flight[row];
    sample.time_s = 0.02 * static_cast<double>(row);
    const double s_z = sample_features<SpecificForce, double>(sample)[2];
    const double late = row > 0 ? flight[row - 1].angular_acceleration_rad_s2[0] : 0.0;
    for (std::size_t i = 0; i < 4; ++i) sample.commands[i] = 0.1 - 0.04 * s_z + (i < 2 ? 0.002 : -0.002) * late;
  }
  return flight;
}

}  // namespace

TEST_CASE("rows are left out by trajectory, repeats together; else by flight; else by quarters") {
  const Flight a = flight_of("a1", "circle", 10, 1), b = flight_of("b", "", 12, 2), c = flight_of("a2", "circle", 8, 3),
               d = flight_of("d", "", 5, 4);
  RowSet rows(a, {0, 10});
  for (const Flight* flight : {&b, &c, &d}) rows.add(*flight, {0, flight->size()});
  const std::vector<RowSet> trajectories = left_out_groups(rows);
  REQUIRE(trajectories.size() == 3);
  CHECK(trajectories[0].size() == 18);
  CHECK(trajectories[0].pieces()[1].flight == &c);
  CHECK(trajectories[1].size() == 12);
  CHECK(trajectories[2].size() == 5);
  RowSet repeats(a, {0, 10});
  repeats.add(c, {2, 8});
  const std::vector<RowSet> flights = left_out_groups(repeats);
  REQUIRE(flights.size() == 2);
  CHECK(flights[1].size() == 6);
  const std::vector<RowSet> quarters = left_out_groups(RowSet(b, {1, 11}));
  REQUIRE(quarters.size() == 4);
  std::size_t next = 1;
  for (const RowSet& quarter : quarters) {
    CHECK(quarter.pieces()[0].rows.begin == next);
    next = quarter.pieces()[0].rows.end;
  }
  CHECK(next == 11);
  CHECK(left_out_groups({}).empty());
}

TEST_CASE("a flight whose windows never fill has no sums") {
  const Flight a = flight_of("a", "", 30, 1), brief = flight_of("brief", "", 2, 2);
  RowSet rows(a, {0, 30});
  const auto context = make_context<Setting>(rows);
  rows.add(brief, {0, 2});
  const std::vector<RegressionSums> sums = regression_sums(context, left_out_groups(rows));
  REQUIRE(sums.size() == 1);
  CHECK(sums[0].rows() == 28);
}

TEST_CASE("what is affine in the features is found, through a window, and the model says it in physical units") {
  const Flight a = flight_of("a", "", 400, 1), b = flight_of("b", "", 400, 2), unseen = flight_of("c", "", 50, 3);
  RowSet rows(a, {0, 400});
  rows.add(b, {0, 400});
  const auto context = make_context<Setting>(rows);
  const auto sums = regression_sums(context, left_out_groups(rows));
  RegressionSums all = sums[0];
  all += sums[1];
  const auto model = make_trained_model(affine_answer<Setting>(fit_ridge(all, choose_penalty(sums))), context, rows);
  int answered = 0;
  each_features<Window, float>(RowSet(unseen, {0, 50}), [&](const Flight& flight, std::size_t row, const auto& x) {
    const Commands<float> u = model.predict(x);
    for (std::size_t i = 0; i < 4; ++i) CHECK(double(u[i]) == doctest::Approx(flight[row].commands[i]).epsilon(1e-4));
    ++answered;
  });
  CHECK(answered == 48);
}

TEST_CASE("a sum with a network adds the network's answer; what the map says is taken away of the rows it learns") {
  const Flight a = flight_of("a", "", 60, 1);
  const RowSet rows(a, {0, 60});
  const auto context = make_context<Setting>(rows);
  const AffineMap map = fit_ridge(regression_sums(context, rows), 0.1);
  const auto affine = affine_answer<Setting>(map);
  Network<float, InputSize<Window::size>, Dense<5>, Tanh, Dense<4>> network;
  std::mt19937_64 engine(7);
  test::fill_uniform(network.parameters, engine, 0.3);
  const auto sum = sum_of(affine, network);
  const auto whole = standardised<float>(context, rows);
  auto data = whole;
  take_away(map, data);
  REQUIRE(data.size() == 58);
  for (int row = 0; row < data.size(); ++row) {
    const float* x = data.features_of(row);
    float y[4], first[4], second[4];
    sum.forward(x, y);
    affine.forward(x, first);
    network.forward(x, second);
    for (int k = 0; k < 4; ++k) {
      CHECK(y[k] == doctest::Approx(double(first[k] + second[k])));
      CHECK(data.outputs_of(row)[k] ==
            doctest::Approx(double(whole.outputs_of(row)[k] - first[k])).epsilon(1e-4).scale(1));
    }
  }
  AffineMap other = map;
  other.inputs = 3;
  CHECK_THROWS_AS(affine_answer<Setting>(other), std::invalid_argument);
}
