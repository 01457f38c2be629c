// SPDX-License-Identifier: MIT
// A block on the ground: the shipped ones are those of their headers; rows of flights are answered as the compiled
// model answers them, with columns and windows.
#include "pinnquad/deploy/block_model.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "../examples/models/crazyflie_2_1.hpp"
#include "../examples/models/demo_quadrotor.hpp"
#include "../examples/models/structured_quadrotor.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/features/windowed.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "support/drawn_model.hpp"
#include "support/random_states.hpp"

using namespace pinnquad;

namespace {

template <class Header>
struct Shipped;
template <>
struct Shipped<DemoQuadModel> {
  static constexpr const char* block = "demo_quadrotor.block";
};
template <>
struct Shipped<CrazyflieModel> {
  static constexpr const char* block = "crazyflie_2_1.block";
};
template <>
struct Shipped<StructuredQuadModel> {
  static constexpr const char* block = "structured_quadrotor.block";
};
template <class Header>
BlockModel shipped() {
  return BlockModel(std::string(PINNQUAD_TESTS_DIR) + "/../examples/models/" + Shipped<Header>::block);
}

/// With a gap in its times and a column.
Flight drawn_flight() {
  test::RandomStates random(3);
  Flight flight;
  flight.add_column({{"battery_voltage", "V"}, {}});
  for (int i = 0; i < 60; ++i) {
    Sample sample;
    sample.time_s = 0.01 * i + (i < 30 ? 0 : 1);
    sample.linear_acceleration_m_s2 = random.vector<double>(20);
    sample.angular_acceleration_rad_s2 = random.vector<double>(40);
    sample.velocity_m_s = random.vector<double>(8);
    sample.body_rates_rad_s = random.vector<double>(6);
    sample.roll_rad = random.scalar<double>(-1, 1);
    sample.pitch_rad = random.scalar<double>(-1, 1);
    sample.yaw_rad = random.scalar<double>(-3, 3);
    sample.altitude_m = random.scalar<double>(0, 10);
    const double voltage = random.scalar<double>(14, 16);
    flight.push_back(sample, &voltage, 1);
  }
  return flight;
}

using Period = PeriodMicroseconds<15000>;  // between rows
using WithVoltage = WithColumns<PaperFeaturesWithAltitude, BatteryVoltage>;
template <class Features, class Scalar>
using OfFeatures = test::ModelOf<Network<Scalar, InputSize<Features::size>, Dense<6>, Tanh, Dense<4>>, Features>;

}  // namespace

TEST_CASE_TEMPLATE("a shipped block is that of its header", Header, DemoQuadModel, CrazyflieModel,
                   StructuredQuadModel) {
  const BlockModel block = shipped<Header>();
  CHECK(block.contents_hash() == Header::contents_hash);
  CHECK(block.name() == Header::name);
  CHECK(block.airframe_name() == Header::Vehicle::name);
  ModelView<Header> view;
  REQUIRE(ModelView<Header>::open(block.data(), block.size(), view) == Status::ok);
  CHECK(std::memcmp(view.parameters(), Header::parameters.data(), sizeof Header::parameters) == 0);
  CHECK(view.golden_commands[0] == Header::golden_commands[0]);
  CHECK(block.certificate().has_value() == has_certificate<Header>);
}

TEST_CASE("the certificate of the shipped block is that which the compiler works out of the header") {
  const Certificate own = shipped<StructuredQuadModel>().certificate().value();
  constexpr Certificate expected = certificate_of<StructuredQuadModel>();
  CHECK(own.proven());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CHECK(own.slope[axis] == doctest::Approx(expected.slope[axis]).epsilon(1e-14));
    CHECK(own.held_slope[axis] == doctest::Approx(expected.held_slope[axis]).epsilon(1e-14));
    CHECK(own.sure_step[axis] == doctest::Approx(expected.sure_step[axis]).epsilon(1e-14));
  }
  CHECK(own.thrust_slope == doctest::Approx(expected.thrust_slope).epsilon(1e-14));
  CHECK(own.rounding == doctest::Approx(expected.rounding).epsilon(1e-14));
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(own.residual_lower[i] == doctest::Approx(expected.residual_lower[i]).epsilon(1e-14));
    CHECK(own.residual_upper[i] == doctest::Approx(expected.residual_upper[i]).epsilon(1e-14));
    CHECK(own.command_bound[i] == doctest::Approx(expected.command_bound[i]).epsilon(1e-14));
  }
}

TEST_CASE("a residual that sees the angular acceleration, without a bound of its paths: no certificate") {
  using Base = MonotoneBase<PhysicsFeatures>;
  const auto block_of = [](auto residual) {
    using Predictor = Sum<Base, Saturated<decltype(residual)>>;
    using Model = test::ModelOf<Predictor, PhysicsFeatures, AxisCommandOutputs>;
    Model model = test::drawn_model<Model>(4);
    auto* const parameters = model.network.parameters.data();
    for (int i = 0; i < 3 * Base::taps; ++i) parameters[Base::slopes + i] = 1;
    for (int k = 0; k < 4; ++k) {
      parameters[Base::parameter_count + k] = -0.2F;
      parameters[Base::parameter_count + 4 + k] = 0.2F;
    }
    return BlockModel("drawn.block", test::drawn_block(model));
  };
  using Seeing = Network<float, InputSize<PhysicsFeatures::size>, Dense<8>, Tanh, Dense<4>>;
  CHECK_FALSE(block_of(Seeing{}).certificate().has_value());
}

TEST_CASE("commands are affine in outputs that are commands or a wrench; a rotor's thrust is the square of its speed") {
  const auto is_affine = [](auto outputs) {
    using Affine = Network<float, InputSize<PaperFeatures::size>, Dense<4>>;
    using Model = test::ModelOf<Affine, PaperFeatures, decltype(outputs)>;
    return BlockModel("drawn.block", test::drawn_block(test::drawn_model<Model>(4))).has_affine_schema();
  };
  CHECK(is_affine(CommandOutputs{}));
  CHECK(is_affine(WrenchOutputs{}));
  CHECK_FALSE(is_affine(RotorSpeedOutputs{}));
}

TEST_CASE_TEMPLATE("rows are answered as the compiled model answers them, to the bit", Model,
                   OfFeatures<PaperFeatures, float>, OfFeatures<WithVoltage, double>,
                   OfFeatures<Windowed<WithVoltage, 3, Period>, float>,
                   OfFeatures<Windowed<WithVoltage, 3, Period, Centred>, double>) {
  using Scalar = typename Model::Scalar;
  using Features = typename Model::Features;
  const Model model = test::drawn_model<Model>(4);
  const BlockModel block("drawn.block", test::drawn_block(model));
  const Flight flight = drawn_flight();
  RowSet rows(flight, {2, 40});
  rows.add(flight, {45, 60});
  std::vector<Commands<double>> expected;
  std::vector<bool> inside;
  each_features<Features, Scalar>(rows, [&](const Flight&, std::size_t, const auto& x) {
    const auto u = model.predict(x);
    expected.push_back({double(u[0]), double(u[1]), double(u[2]), double(u[3])});
    inside.push_back(
        detail::inside_envelope(model.envelope_lower.data(), x.data(), model.envelope_upper.data(), x.size()));
  });
  std::size_t seen = 0, last = 0;
  block.answer(rows, [&](std::size_t row, const BlockModel::AnsweredRow& answered) {
    REQUIRE(seen < expected.size());
    CHECK(answered.commands == expected[seen]);
    CHECK(answered.inside_envelope == inside[seen]);
    CHECK((seen == 0 || row > last));
    last = row;
    ++seen;
  });
  CHECK(seen == expected.size());
  CHECK(seen > 20);
  CHECK(is_windowed<Features> == (seen < rows.size()));
  CHECK(last < rows.size());
}

TEST_CASE("a flight without a column that the model asks for is refused") {
  using Model = OfFeatures<WithVoltage, float>;
  const BlockModel block("drawn.block", test::drawn_block(test::drawn_model<Model>(4)));
  Flight flight;
  flight.push_back(Sample{});
  CHECK_THROWS_AS(block.answer(RowSet(flight, {0, 1}), [](std::size_t, const BlockModel::AnsweredRow&) {}),
                  std::invalid_argument);
}

TEST_CASE("texts of a block are fit for a terminal") {
  test::ModelOf<Network<float, InputSize<16>, Dense<4>>, PaperFeatures> model;
  model = test::drawn_model(4, model);
  const auto block = model_block(model, {model.input.mean}, Provenance{"a\x1b[2Jflight", 0, 1, 0, 0, "none"}, "Drawn");
  CHECK(BlockModel("drawn.block", block).provenance("training_data") == "a?[2Jflight");
  CHECK(BlockModel("drawn.block", block).provenance("no such word").empty());
}
