// SPDX-License-Identifier: MIT
// An airframe that a program was given trains what the same airframe as a type does, bit for bit, and its export
// brings it along.
#include <doctest/doctest.h>

#include <memory>
#include <random>
#include <sstream>
#include <string>

#include "pinnquad/data/row_set.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/loss/local_monotonicity.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/outputs/wrench_outputs.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "pinnquad/training/trainer.hpp"

namespace {

using namespace pinnquad;

using Net = Network<double, InputSize<16>, Dense<6>, Relu, Dense<4>>;
using Loss =
    PhysicsInformed<Mse, Weighted<LocalMonotonicity<Roll>, Constant>, Weighted<LocalMonotonicity<Yaw>, Constant>>;

/// Motions and commands drawn at random, 10 ms apart but for one gap.
Flight some_flight() {
  std::mt19937_64 engine(3);
  Flight flight(400);
  for (int i = 0; i < 400; ++i) {
    Sample sample;
    sample.time_s = 0.01 * i + (i >= 200 ? 0.5 : 0.0);
    for (int k = 0; k < 3; ++k) {
      sample.linear_acceleration_m_s2[k] = uniform(engine, -5, 5);
      sample.angular_acceleration_rad_s2[k] = uniform(engine, -40, 40);
      sample.velocity_m_s[k] = uniform(engine, -2, 2);
      sample.body_rates_rad_s[k] = uniform(engine, -3, 3);
    }
    for (double& u : sample.commands) u = uniform(engine, 0.2, 0.9);
    flight[std::size_t(i)] = sample;
  }
  return flight;
}

GivenAirframe given_crazyflie() { return {Crazyflie::name, Crazyflie::value<double>()}; }

template <class ContextType>
auto trained(const Flight& flight, const detail::ContextAirframe<typename ContextType::Vehicle>& airframe) {
  const RowSet rows(flight, {0, 400});
  const auto context = make_context<ContextType>(rows, airframe);
  const auto data = standardised<double>(context, rows);
  std::mt19937_64 engine(7);
  using TrainerType = Trainer<Net, Loss, Adam, ContextType>;
  const auto trainer = std::make_unique<TrainerType>(initialised<Net>(engine), Loss{}, Adam{}, context);
  for (int epoch = 0; epoch < 3; ++epoch) trainer->epoch(data, Progress{epoch, 3}, engine);
  return make_trained_model(trainer->network(), context, rows);
}

}  // namespace

TEST_CASE_TEMPLATE("a given airframe trains what its type does, bit for bit", Schema, CommandOutputs, RotorSpeedOutputs,
                   WrenchOutputs) {
  const Flight flight = some_flight();
  using Known = Context<PaperFeatures, Crazyflie, Schema>;
  using Given = Context<PaperFeatures, GivenAirframe, Schema>;
  const auto known = trained<Known>(flight, {});
  const auto given = trained<Given>(flight, given_crazyflie());
  CHECK(given.network.parameters == known.network.parameters);
  CHECK(given.input.mean == known.input.mean);
  CHECK(given.output.standard_deviation == known.output.standard_deviation);
  CHECK(given.envelope_upper == known.envelope_upper);
  CHECK(given.airframe_name() == std::string("crazyflie_2_1"));
  for (std::size_t i = 0; i < 400; i += 50) {
    const auto a = given.predict(flight[i]), b = known.predict(flight[i]);
    for (std::size_t k = 0; k < 4; ++k) CHECK(a[k] == doctest::Approx(b[k]).epsilon(1e-12));
  }
  // the block is the one that the type's header opens
  const std::vector<typename std::decay_t<decltype(given)>::FeatureVector> golden = {
      sample_features<PaperFeatures, double>(flight[0])};
  const auto block = model_block(given, golden, {});
  ModelView<std::decay_t<decltype(known)>> view;
  CHECK(ModelView<std::decay_t<decltype(known)>>::open(block.data(), block.size(), view) == Status::ok);
}

TEST_CASE("a given airframe stands before its model, and the model names it") {
  const Flight flight = some_flight();
  const auto model = trained<Context<PaperFeatures, GivenAirframe>>(flight, given_crazyflie());
  std::ostringstream out;
  Provenance from;
  from.sample_period_s = sample_period_s(RowSet(flight, {0, 400}));
  write_model(out, "MyQuad", model, {sample_features<PaperFeatures, double>(flight[0])}, from);
  const std::string header = out.str();
  CHECK(header.find("struct MyQuadAirframe {") < header.find("struct MyQuad {"));
  for (const char* line : {"static constexpr const char* name = \"crazyflie_2_1\";", "using Vehicle = MyQuadAirframe;",
                           "    a.mass_kg = Scalar(0.027);", "sample_period_s = 0.01",
                           "command_meaning = pinnquad::CommandMeaning::thrust;"}) {
    CAPTURE(line);
    CHECK(header.find(line) != std::string::npos);
  }
}

TEST_CASE("a given airframe that can't fly is refused") {
  Airframe<double> heavy = Crazyflie::value<double>();
  heavy.mass_kg = 1;
  CHECK_THROWS_WITH_AS((GivenAirframe("heavy", heavy)), "the airframe 'heavy' can't fly", std::invalid_argument);
}

TEST_CASE("the sample period of rows is the median step, none where flights differ") {
  const Flight flight = some_flight();
  CHECK(sample_period_s(RowSet(flight, {0, 400})) == 0.01);
  CHECK(sample_period_s(RowSet(flight, {5, 6})) == 0.0);
  Flight slower = flight;
  for (std::size_t i = 0; i < 400; ++i) slower[i].time_s *= 2;
  RowSet both(flight, {0, 100});
  both.add(slower, {0, 100});
  CHECK(sample_period_s(both) == 0.0);
}
