// SPDX-License-Identifier: MIT
#include "pinnquad/training/training_data.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/training_sets.hpp"

using namespace pinnquad;
using pinnquad::test::random_flight_rows;

namespace {

using PaperContext = Context<PaperFeatures, PaperQuadrotor>;

/// Sums over a hundred rows.
constexpr double sum_tolerance = 1e-12;

}  // namespace

TEST_CASE("the training rows have mean 0 and spread 1; other rows are scaled alike") {
  const Flight flight = random_flight_rows(150, 141);
  const auto context = make_context<PaperContext>({flight, {0, 100}});
  const auto data = standardised<double>(context, {flight, {0, 100}});
  REQUIRE(data.size() == 100);
  const auto check = [](const std::vector<double>& values, std::size_t columns) {
    for (std::size_t column = 0; column < columns; ++column) {
      double sum = 0.0, squares = 0.0;
      for (std::size_t row = 0; row < 100; ++row) {
        sum += values[row * columns + column];
        squares += values[row * columns + column] * values[row * columns + column];
      }
      CHECK(std::fabs(sum / 100) <= sum_tolerance);
      CHECK(std::fabs(squares / 100 - 1.0) <= sum_tolerance);
    }
  };
  check(data.features, 16);
  check(data.outputs, 4);
  const auto rest = standardised<double>(context, {flight, {90, 150}});
  REQUIRE(rest.size() == 60);
  for (int k = 0; k < 16; ++k) CHECK(rest.features_of(3)[k] == data.features_of(93)[k]);
  for (int k = 0; k < 4; ++k) {
    CHECK(rest.outputs_of(3)[k] == data.outputs_of(93)[k]);
    const auto i = static_cast<std::size_t>(k);
    CHECK(rest.outputs_of(59)[k] * context.output.standard_deviation[i] + context.output.mean[i] ==
          doctest::Approx(flight[149].commands[i]).epsilon(1e-12));
  }
}

TEST_CASE("with altitude: the altitude that was recorded is the last feature") {
  using pinnquad::PaperFeaturesWithAltitude;
  for (const auto& sample : random_flight_rows(20, 145)) {
    const auto x = pinnquad::sample_features<PaperFeaturesWithAltitude, double>(sample);
    const auto paper = pinnquad::sample_features<PaperFeatures, double>(sample);
    for (std::size_t i = 0; i < paper.size(); ++i) CHECK(x[i] == paper[i]);
    CHECK(x.back() == sample.altitude_m);
  }
}

TEST_CASE("features are those of X in physical units") {
  const Flight flight = random_flight_rows(30, 142);
  const auto context = make_context<PaperContext>({flight, {0, 30}});
  const auto data = standardised<double>(context, {flight, {0, 30}});
  const auto physical = [&](int row, std::size_t i) {
    return data.features_of(row)[i] * context.input.standard_deviation[i] + context.input.mean[i];
  };
  for (int row = 0; row < 30; ++row) {
    const pinnquad::Sample& s = flight[static_cast<std::size_t>(row)];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      CHECK(physical(row, i) == doctest::Approx(s.linear_acceleration_m_s2[k]).epsilon(1e-12));
      CHECK(physical(row, 3 + i) == doctest::Approx(s.angular_acceleration_rad_s2[k]).epsilon(1e-12));
      CHECK(physical(row, 6 + i) == doctest::Approx(s.velocity_m_s[k]).epsilon(1e-12));
      CHECK(physical(row, 9 + i) == doctest::Approx(s.body_rates_rad_s[k]).epsilon(1e-12));
    }
    CHECK(physical(row, 12) == doctest::Approx(s.roll_rad).epsilon(1e-12));
    CHECK(physical(row, 13) == doctest::Approx(s.pitch_rad).epsilon(1e-12));
    CHECK(physical(row, 14) == doctest::Approx(std::sin(s.yaw_rad)).epsilon(1e-12));
    CHECK(physical(row, 15) == doctest::Approx(std::cos(s.yaw_rad)).epsilon(1e-12));
  }
}

TEST_CASE("spread of the signed sums: rows of Eq. (2) over the training set") {
  const Flight flight = random_flight_rows(40, 143);
  const auto context = make_context<PaperContext>({flight, {10, 40}});
  const double rows[3][4] = {{-1, 1, 1, -1}, {1, -1, 1, -1}, {1, 1, -1, -1}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 10; i < 40; ++i) {
      double m = 0.0;
      for (std::size_t k = 0; k < 4; ++k) m += rows[axis][k] * flight[i].commands[k];
      sum += m;
      squares += m * m;
    }
    const double variance = squares / 30 - (sum / 30) * (sum / 30);
    CHECK(context.signed_sum_deviation[axis] == doctest::Approx(std::sqrt(variance)).epsilon(1e-9));
  }
}

TEST_CASE("rotor speeds: outputs in rev/s") {
  const Flight flight = random_flight_rows(20, 144);
  using SpeedContext = Context<PaperFeatures, PaperQuadrotor, RotorSpeedOutputs>;
  const auto context = make_context<SpeedContext>({flight, {0, 20}});
  const auto data = standardised<double>(context, {flight, {0, 20}});
  for (int row = 0; row < 20; ++row) {
    for (std::size_t k = 0; k < 4; ++k) {
      const double speed_rev_s =
          data.outputs_of(row)[k] * context.output.standard_deviation[k] + context.output.mean[k];
      const double n_max_rev_s = 8500.0 / 60.0;
      CHECK(speed_rev_s == doctest::Approx(n_max_rev_s * std::sqrt(flight[static_cast<std::size_t>(row)].commands[k])));
    }
  }
}

TEST_CASE("a column that varies only by rounding or noise gets the spread 1, one that varies more its own") {
  // m/s: below 0.01 it stands still
  for (const double noise : {1e-17, 1e-12, 1e-6, 0.005}) {
    CAPTURE(noise);
    Flight flight = random_flight_rows(60, 146);
    for (std::size_t i = 0; i < 60; ++i) flight[i].velocity_m_s[1] = 2.5 + (i % 2 == 0 ? noise : -noise);
    CHECK(make_context<PaperContext>({flight, {0, 60}}).input.standard_deviation[7] == 1.0);
    CHECK(pinnquad::still_features<PaperFeatures>({flight, {0, 60}}) == std::vector<std::string>{"v_by"});
  }
  Flight flight = random_flight_rows(60, 146);
  for (std::size_t i = 0; i < 60; ++i) flight[i].velocity_m_s[1] = 2.5 + (i % 2 == 0 ? 0.02 : -0.02);
  CHECK(make_context<PaperContext>({flight, {0, 60}}).input.standard_deviation[7] == doctest::Approx(0.02));
  CHECK(pinnquad::still_features<PaperFeatures>({flight, {0, 60}}).empty());
}

TEST_CASE("yaw 0 all flight: sine and cosine stand still, and so does a yaw that is not 0") {
  for (const double yaw : {0.0, 0.7, -2.1}) {
    Flight flight = random_flight_rows(60, 147);
    for (auto& sample : flight) sample.yaw_rad = yaw;
    CHECK(pinnquad::still_features<PaperFeatures>({flight, {0, 60}}) == std::vector<std::string>{"sin_yaw", "cos_yaw"});
    const auto context = make_context<PaperContext>({flight, {0, 60}});
    CHECK(context.input.standard_deviation[14] == 1.0);
    CHECK(context.input.standard_deviation[15] == 1.0);
  }
}

TEST_CASE("a column that does not vary gets the spread 1, whatever its value") {
  for (const double still : {0.0, 0.1, -0.3, 1.0 / 3.0, 12345.678}) {
    CAPTURE(still);
    Flight flight = random_flight_rows(77, 145);
    for (auto& sample : flight) sample.velocity_m_s[1] = still;
    const auto context = make_context<PaperContext>({flight, {0, 77}});
    CHECK(context.input.standard_deviation[7] == 1.0);
    const auto data = standardised<double>(context, {flight, {0, 77}});
    CHECK(std::fabs(data.features_of(5)[7]) <= 1e-9);  // the mean's rounding
  }
}

TEST_CASE("rows of many flights are one set: as if they had been flown in one, with the weights of their flights") {
  const Flight whole = random_flight_rows(150, 149);
  pinnquad::Dataset dataset;
  Flight first, second;
  first.name = "first";
  second.name = "second";
  second.weight = 2.5;
  for (std::size_t i = 0; i < 150; ++i) (i < 90 ? first : second).push_back(whole[i]);
  dataset.add(first);
  dataset.add(second);
  pinnquad::RowSet rows;
  rows.add(dataset[0], {0, 90});
  rows.add(dataset[1], {0, 30});

  const auto context = make_context<PaperContext>(rows);
  const auto expected = make_context<PaperContext>({whole, {0, 120}});
  CHECK(context.input.mean == expected.input.mean);
  CHECK(context.input.standard_deviation == expected.input.standard_deviation);
  CHECK(context.output.mean == expected.output.mean);
  CHECK(context.signed_sum_deviation == expected.signed_sum_deviation);
  const auto data = standardised<float>(context, rows);
  const auto one = standardised<float>(expected, {whole, {0, 120}});
  CHECK(data.features == one.features);
  CHECK(data.outputs == one.outputs);
  CHECK(one.weights.empty());
  REQUIRE(data.weights.size() == 120);
  CHECK(data.weights[89] == 1);
  CHECK(data.weights[90] == 2.5);
}
