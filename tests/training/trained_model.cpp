// SPDX-License-Identifier: MIT
#include "pinnquad/training/trained_model.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>
#include <string_view>
#include <type_traits>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/structured/closed_form.hpp"
#include "pinnquad/training/training_data.hpp"
#include "support/batch_norm_networks.hpp"
#include "support/plain_network.hpp"
#include "support/training_sets.hpp"

using namespace pinnquad;
using pinnquad::test::random_flight_rows;

namespace {

template <class Scalar>
using Small = Mlp<Scalar, InputSize<16>, Hidden<1, 7>, OutputSize<4>, Relu>;
using PaperContext = Context<PaperFeatures, PaperQuadrotor>;

/// Sums of at most 16 terms, twice, in float: some 1e-6 of values of order 1.
constexpr double float_tolerance = 5e-6;

}  // namespace

TEST_CASE_TEMPLATE("predict() is scale, plain forward pass, scale back", ContextType, PaperContext,
                   Context<PaperFeatures, PaperQuadrotor, RotorSpeedOutputs>) {
  const Flight flight = random_flight_rows(60, 151);
  std::mt19937_64 engine(152);
  const auto context = make_context<ContextType>({flight, {0, 60}});
  const auto net = initialised<Small<float>>(engine);
  const auto model = make_trained_model(net, context, {flight, {0, 60}});
  for (const auto& sample : flight) {
    const auto x = pinnquad::sample_features<PaperFeatures, double>(sample);
    std::vector<double> z(16);
    for (std::size_t i = 0; i < 16; ++i) z[i] = (x[i] - context.input.mean[i]) / context.input.standard_deviation[i];
    const auto y = plain::forward({{16, 7, 4}, plain::Activation::relu}, net.parameters, z).outputs;
    const auto commands = model.predict(sample);
    for (std::size_t i = 0; i < 4; ++i) {
      double expected = y[i] * context.output.standard_deviation[i] + context.output.mean[i];
      if constexpr (std::is_same_v<typename ContextType::Outputs, RotorSpeedOutputs>) {
        const double n_max_rev_s = 8500.0 / 60.0;
        expected = std::copysign(expected * expected / (n_max_rev_s * n_max_rev_s), expected);
      }
      CHECK(std::fabs(static_cast<double>(commands[i]) - expected) <= float_tolerance);
    }
  }
}

TEST_CASE("the envelope: the range of the training rows, a tenth wider on both sides") {
  Flight flight = random_flight_rows(100, 153);
  flight[20].velocity_m_s[0] = -30.0;
  flight[40].velocity_m_s[0] = 20.0;
  flight[80].velocity_m_s[0] = 500.0;  // not a training row
  std::mt19937_64 engine(154);
  const auto context = make_context<PaperContext>({flight, {0, 60}});
  const auto model = make_trained_model(initialised<Small<double>>(engine), context, {flight, {0, 60}});
  CHECK(model.envelope_lower[6] == doctest::Approx(-35.0));
  CHECK(model.envelope_upper[6] == doctest::Approx(25.0));
  for (std::size_t row = 0; row < 60; ++row) {
    const auto x = pinnquad::sample_features<PaperFeatures, double>(flight[row]);
    for (std::size_t i = 0; i < 16; ++i) {
      CHECK(x[i] > model.envelope_lower[i]);
      CHECK(x[i] < model.envelope_upper[i]);
    }
  }
}

TEST_CASE("the envelope of an affine model: a motion twice as great, of which squares are four times as great") {
  using Setting = Context<pinnquad::PhysicsFeatures, PaperQuadrotor>;
  const Flight flight = random_flight_rows(60, 155);
  const pinnquad::RowSet rows(flight, {0, 60});
  const auto context = make_context<Setting>(rows);
  const auto affine = pinnquad::affine_answer<Setting>(fit_ridge(regression_sums(context, rows), 1e-3));
  const auto model = make_trained_model(affine, context, rows);
  const auto columns = pinnquad::detail::feature_statistics<pinnquad::PhysicsFeatures>(rows);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    CAPTURE(pinnquad::PhysicsFeatures::names[i]);
    const double half = (columns[i].highest - columns[i].lowest) / 2;
    const std::string_view unit = pinnquad::PhysicsFeatures::units[i];
    const double reach = unit == "m^2/s^2" || unit == "rad^2/s^2" ? 3 : 1;
    CHECK(double(model.envelope_lower[i]) == doctest::Approx(columns[i].lowest - reach * half).epsilon(1e-5));
    CHECK(double(model.envelope_upper[i]) == doctest::Approx(columns[i].highest + reach * half).epsilon(1e-5));
  }
  CHECK(pinnquad::detail::affine_reach("m") == 0);  // a height above the ground
}

TEST_CASE("the envelope of a feature that stands still: about where it stood, by its unit") {
  Flight flight = random_flight_rows(100, 158);
  for (auto& sample : flight) {
    sample.yaw_rad = 0;
    sample.velocity_m_s[2] = 1.25;
    sample.roll_rad = -0.1;
    sample.angular_acceleration_rad_s2[2] = 0;
  }
  std::mt19937_64 engine(159);
  const auto context = make_context<PaperContext>({flight, {0, 60}});
  const auto model = make_trained_model(initialised<Small<float>>(engine), context, {flight, {0, 60}});
  const auto stands = [&](std::size_t i, double value, double margin) {
    CHECK(double(model.envelope_lower[i]) == doctest::Approx(value - margin).epsilon(1e-6));
    CHECK(double(model.envelope_upper[i]) == doctest::Approx(value + margin).epsilon(1e-6));
  };
  stands(5, 0, 0.5);       // rad/s^2
  stands(8, 1.25, 0.1);    // m/s
  stands(12, -0.1, 0.05);  // rad
  stands(14, 0, 0.05);     // 1
  stands(15, 1, 0.05);
  // every row, and rows near it, lie inside as the flight side computes them: in float, through a quaternion
  for (const double moved : {0.0, 0.04, -0.04}) {
    for (auto sample : flight) {
      sample.yaw_rad += moved;
      sample.roll_rad += moved;
      sample.velocity_m_s[2] += moved;
      const auto x = pinnquad::sample_features<PaperFeatures, float>(sample);
      for (const std::size_t i : {std::size_t{5}, std::size_t{8}, std::size_t{12}, std::size_t{14}, std::size_t{15}}) {
        CHECK(x[i] >= model.envelope_lower[i]);
        CHECK(x[i] <= model.envelope_upper[i]);
      }
    }
  }
}

TEST_CASE("weights that weigh nothing are exported as 0, no others") {
  const Flight flight = random_flight_rows(10, 155);
  Small<float> net{};
  net.parameters[0] = 1e-30F;
  net.parameters[1] = -1e-42F;  // denormal
  net.parameters[2] = 1e-19F;
  net.parameters[3] = -0.25F;
  const auto model = make_trained_model(net, make_context<PaperContext>({flight, {0, 10}}), {flight, {0, 10}});
  CHECK(model.network.parameters[0] == 0.0F);
  CHECK(model.network.parameters[1] == 0.0F);
  CHECK(model.network.parameters[2] == 1e-19F);
  CHECK(model.network.parameters[3] == -0.25F);
}

TEST_CASE("batch norm is folded: the model holds plain layers and predicts what the trained network does") {
  using Normed = pinnquad::BatchNormMlp<float, InputSize<16>, Hidden<1, 7>, OutputSize<4>, Relu>;
  const Flight flight = random_flight_rows(60, 156);
  std::mt19937_64 engine(157);
  const auto context = make_context<PaperContext>({flight, {0, 60}});
  const auto net = pinnquad::test::random_batch_norm_network<Normed>(engine);
  const auto model = make_trained_model(net, context, {flight, {0, 60}});
  CHECK((std::is_same_v<std::decay_t<decltype(model)>::Network, Small<float>>));
  for (const auto& sample : flight) {
    const auto x = pinnquad::sample_features<PaperFeatures, float>(sample);
    std::array<float, 16> z{};
    std::array<float, 4> y{};
    model.input.standardise(x.data(), z.data());
    net.forward(z.data(), y.data());
    const auto commands = model.predict(sample);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(std::fabs(commands[i] - (y[i] * model.output.standard_deviation[i] + model.output.mean[i])) <=
            float(float_tolerance));
    }
  }
}
