// SPDX-License-Identifier: MIT
// The derivatives by which a wrong sign is counted, against finite differences of the library's own network in double
// and against Eq. (2) and (3) by hand.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/nn/clip.hpp"
#include "pinnquad/nn/gelu.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "training/derivatives.hpp"

namespace {

using namespace pinnquad;

/// Rows in flight, each entry within a usual range.
std::vector<Sample> samples(std::size_t count, std::mt19937_64& engine) {
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<Sample> rows(count);
  for (Sample& row : rows) {
    for (int i = 0; i < 3; ++i) {
      row.linear_acceleration_m_s2[i] = 5 * any(engine);
      row.angular_acceleration_rad_s2[i] = 20 * any(engine);
      row.velocity_m_s[i] = 4 * any(engine);
      row.body_rates_rad_s[i] = 3 * any(engine);
    }
    row.roll_rad = 0.5 * any(engine);
    row.pitch_rad = 0.5 * any(engine);
    row.yaw_rad = 3 * any(engine);
    row.commands = {0.5, 0.5, 0.5, 0.5};
  }
  return rows;
}

/// The block of a model. Its envelope is about the features' mean.
template <class Model>
BlockModel block_of(Model model) {
  for (std::size_t i = 0; i < model.input.mean.size(); ++i) {
    model.envelope_lower[i] = model.input.mean[i] - model.input.standard_deviation[i];
    model.envelope_upper[i] = model.input.mean[i] + model.input.standard_deviation[i];
  }
  return BlockModel("model.block", model_block(model, {model.input.mean}, {"none", 0, 1, 0, 0, "none"}));
}

template <class FeatureVector>
std::vector<double> as_vector(const FeatureVector& x) {
  return {x.begin(), x.end()};
}

/// The model's commands by its own arithmetic, in double.
template <class Network, class Outputs>
void check_against_differences(const char* what) {
  CAPTURE(what);
  using Context = pinnquad::Context<PaperFeatures, Crazyflie, Outputs>;
  std::mt19937_64 engine(7);
  TrainedModel<Network, Context> model;
  model.network = initialised<Network>(engine);
  TrainedModel<typename Network::template Rebind<double>, Context> wide;
  std::uniform_real_distribution<double> spread(0.5, 3);
  const auto set = [](float& value, double& same, double to) {
    value = static_cast<float>(to);
    same = static_cast<double>(value);
  };
  for (std::size_t i = 0; i < model.input.mean.size(); ++i) {
    set(model.input.standard_deviation[i], wide.input.standard_deviation[i], spread(engine));
    set(model.input.mean[i], wide.input.mean[i], spread(engine) - 1);
  }
  for (std::size_t i = 0; i < model.output.mean.size(); ++i) {
    set(model.output.standard_deviation[i], wide.output.standard_deviation[i], spread(engine));
    set(model.output.mean[i], wide.output.mean[i], 3 + spread(engine));
  }
  for (std::size_t i = 0; i < model.network.parameters.size(); ++i) {
    wide.network.parameters[i] = static_cast<double>(model.network.parameters[i]);
  }
  const std::array<std::array<double, rotor_count>, 3> signs = {
      model.template signs<Roll>(), model.template signs<Pitch>(), model.template signs<Yaw>()};
  const BlockModel block = block_of(model);
  int both_signs[2] = {0, 0};
  for (const Sample& row : samples(50, engine)) {
    const AxisSlopes found = block.derivatives(as_vector(sample_features<PaperFeatures, double>(row)));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      CAPTURE(axis);
      // small: a kink of ReLU in between is not to be expected
      constexpr double step = 1e-6;
      auto above = sample_features<PaperFeatures, double>(row), below = above;
      above[3 + axis] += step;  // wdot_x, wdot_y, wdot_z stand behind v_dot
      below[3 + axis] -= step;
      const double slope =
          (signed_sum(signs[axis], wide.predict(above)) - signed_sum(signs[axis], wide.predict(below))) / (2 * step);
      CHECK(found[axis] == doctest::Approx(slope).epsilon(1e-5).scale(1e-3));
      ++both_signs[slope < 0 ? 1 : 0];
    }
  }
  CHECK(both_signs[0] > 10);
  CHECK(both_signs[1] > 10);
}

template <class Activation>
using Net = Mlp<float, InputSize<16>, Hidden<3, 12>, OutputSize<4>, Activation>;

}  // namespace

TEST_CASE("derivatives of a network are its finite differences") {
  check_against_differences<Net<Tanh>, CommandOutputs>("tanh");
  check_against_differences<Net<Gelu>, CommandOutputs>("gelu");
  check_against_differences<Net<Relu>, CommandOutputs>("ReLU");
  check_against_differences<Net<Tanh>, RotorSpeedOutputs>("tanh, rotor speeds");
}

TEST_CASE("derivatives of a sum through a window: by an angular acceleration that is another at all instants") {
  using Window = PartlyWindowed<PhysicsFeatures, AccelerationFeatures, 3, PeriodMicroseconds<20000>>;
  using Affine = Network<double, InputSize<Window::size>, Dense<4>>;
  using Residual = Network<double, InputSize<Window::size>, Clip, Dense<7>, Tanh, Dense<4>>;
  using Model = TrainedModel<Sum<Affine, Residual>, Context<Window, GivenAirframe>>;
  std::mt19937_64 engine(6);
  std::uniform_real_distribution<double> any(-1, 1);
  Model model{GivenAirframe("paper", airframe_value<PaperQuadrotor, double>())};
  for (double& parameter : model.network.parameters) parameter = any(engine);
  for (double& spread : model.input.standard_deviation) spread = 1.5 + any(engine);
  for (double& spread : model.output.standard_deviation) spread = 1.5 + any(engine);
  for (double& mean : model.input.mean) mean = any(engine);
  const BlockModel block = block_of(model);
  const std::array<std::array<double, rotor_count>, 3> signs = {
      model.template signs<Roll>(), model.template signs<Pitch>(), model.template signs<Yaw>()};
  for (int draw = 0; draw < 50; ++draw) {
    Model::FeatureVector x{};
    for (double& feature : x) feature = any(engine);
    const AxisSlopes found = block.derivatives(as_vector(x));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      constexpr double step = 1e-6;
      auto above = x, below = x;
      for (const std::size_t first : {std::size_t{3}, std::size_t{21 + 3}, std::size_t{27 + 3}}) {
        above[first + axis] += step;
        below[first + axis] -= step;
      }
      const double slope =
          (signed_sum(signs[axis], model.predict(above)) - signed_sum(signs[axis], model.predict(below))) / (2 * step);
      CHECK(found[axis] == doctest::Approx(slope).epsilon(1e-6).scale(1e-3));
    }
  }
}

TEST_CASE("derivatives of a residual are its base's too") {
  using Net = Network<double, InputSize<16>, Dense<4>>;
  using Model = TrainedModel<Net, Context<PaperFeatures, GivenAirframe, ResidualOutputs<LinearizedBase>>>;
  const Airframe<double> airframe = airframe_value<PaperQuadrotor, double>();
  Model model{GivenAirframe("paper", airframe)};
  model.input.standard_deviation.fill(1);
  model.output.standard_deviation.fill(1);
  const BlockModel block = block_of(model);
  std::mt19937_64 engine(3);
  for (const Sample& row : samples(3, engine)) {
    const AxisSlopes found = block.derivatives(as_vector(sample_features<PaperFeatures, double>(row)));
    const double thrust_N = airframe.max_rotor_thrust_N();
    CHECK(found[0] == doctest::Approx(airframe.inertia_kg_m2[0] / (std::abs(airframe.rotors[0].y_m) * thrust_N)));
    CHECK(found[1] == doctest::Approx(airframe.inertia_kg_m2[1] / (std::abs(airframe.rotors[0].x_m) * thrust_N)));
    CHECK(found[2] == doctest::Approx(airframe.inertia_kg_m2[2] / airframe.max_rotor_torque_N_m()));
  }
}

TEST_CASE("rows that a window leaves without an answer are told by NaN, the others stand in their places") {
  using Window = PartlyWindowed<PhysicsFeatures, AccelerationFeatures, 3, PeriodMicroseconds<20000>, Centred>;
  using Model = TrainedModel<Network<float, InputSize<Window::size>, Dense<4>>, Context<Window, GivenAirframe>>;
  Model model{GivenAirframe("paper", airframe_value<PaperQuadrotor, double>())};
  model.input.standard_deviation.fill(1);
  model.output.standard_deviation.fill(1);
  model.network.parameters[3] = 1;  // u1: the present angular acceleration about x
  std::mt19937_64 engine(4);
  Flight flights[2];
  RowSet rows;
  for (Flight& flight : flights) {
    for (const Sample& sample : samples(6, engine)) {
      flight.push_back(sample);
      flight[flight.size() - 1].time_s = 0.02 * double(flight.size());
    }
    rows.add(flight, {1, 6});
  }
  const programs::Predictions predictions = pinnquad::predicted_commands(model, rows);
  REQUIRE(predictions.size() == 10);
  for (std::size_t row = 0; row < 10; ++row) {
    const bool complete = row % 5 > 0 && row % 5 < 4;
    CHECK(std::isfinite(predictions[row][0]) == complete);
    if (complete) CHECK(predictions[row][0] == doctest::Approx(rows[row].angular_acceleration_rad_s2[0]));
  }
}

TEST_CASE("the share counts rows below 0; what is not finite is told") {
  std::mt19937_64 engine(3);
  Flight flight;
  for (const Sample& sample : samples(4, engine)) flight.push_back(sample);
  const RowSet rows(flight, {0, 4});
  int row = 0;
  const programs::DerivativeFigures found = programs::derivative_figures(rows, [&row](const Sample&) {
    ++row;
    return programs::AxisSlopes{row == 2 ? -1e-9 : 0.0, row < 4 ? -1.0 - row : 1.0, row == 1 ? std::nan("") : 1.0};
  });
  CHECK(found.wrong_share[0] == 0.25);
  CHECK(found.wrong_share[1] == 0.75);
  CHECK(std::isnan(found.wrong_share[2]));
  CHECK(found.least[0] == -1e-9);
  CHECK(found.least[1] == -4);
  CHECK(found.median[1] == -2);
  CHECK(found.sees_acceleration);
  CHECK(std::isnan(found.least[2]));
  const programs::DerivativeFigures none =
      programs::derivative_figures({}, [](const Sample&) { return programs::AxisSlopes{}; });
  CHECK(std::isnan(none.wrong_share[0]));
  CHECK(std::isnan(none.least[0]));
}

TEST_CASE("large steps are those of more than half a deviation; rows that do not count split a flight") {
  // asked: 0 1 0 10 0, deviation 4.4; the sum goes against the two small steps, and against one of the two large ones
  std::array<programs::AxisSeries, 3> series;
  for (programs::AxisSeries& s : series) s = {{0, 1, 0, 10, 0}, {0, 1, 0, 1, 0}, {0, -1, 0, 1, 2}};
  const programs::PairSigns pairs = programs::pair_signs(series);
  CHECK(pairs.all[1] == 0.75);
  CHECK(pairs.large[1] == 0.5);
  CHECK(pairs.of_flown[1] == 0);
  CHECK(pairs.large_of_flown[1] == 0);
  std::mt19937_64 engine(4);
  Flight flight;
  for (const Sample& sample : samples(6, engine)) flight.push_back(sample);
  programs::Predictions made(5);
  for (std::size_t i = 0; i < made.size(); ++i) made[i][0] = static_cast<double>(i);
  const programs::PredictedRows left =
      programs::rows_that_count(RowSet(flight, {1, 6}), made, {false, true, true, false, true});
  REQUIRE(left.rows.pieces().size() == 2);
  CHECK(left.rows.pieces()[0].rows.begin == 2);
  CHECK(left.rows.pieces()[0].rows.end == 4);
  CHECK(left.rows.pieces()[1].rows.begin == 5);
  CHECK(left.predictions[2][0] == 4);
  CHECK(left.rows.size() == left.predictions.size());
}
