// SPDX-License-Identifier: MIT
// A ridge through a window over a part of its features, with a network on top, from rows to what flies:
// header text, block, guard, self test, Jacobian.
#include <doctest/doctest.h>

#include <limits>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/deploy/golden_features.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/exported/run_time_model.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/inference/batched_inverse.hpp"
#include "pinnquad/inference/command_jacobian.hpp"
#include "pinnquad/inference/self_test.hpp"
#include "pinnquad/nn/clip.hpp"
#include "pinnquad/nn/silu.hpp"
#include "pinnquad/regression/ridge.hpp"
#include "pinnquad/training/structured/closed_form.hpp"
#include "support/block_bytes.hpp"
#include "support/random_network.hpp"
#include "support/training_sets.hpp"

using namespace pinnquad;
using pinnquad::test::BlockBytes;

namespace {

using Features =
    PartlyWindowed<WithColumns<PhysicsFeatures, BatteryVoltage>, AccelerationFeatures, 3, PeriodMicroseconds<20000>>;
using Setting = Context<Features, PaperQuadrotor>;
using Affine = decltype(affine_answer<Setting>(AffineMap{}));
using Residual = Network<float, InputSize<Features::size>, Clip, Dense<6>, Silu, Dense<4>>;

/// A motion that wanders, its commands by specific force, angular acceleration and voltage.
Flight flight() {
  constexpr std::size_t rows = 150;
  std::mt19937_64 engine(5);
  Flight made = test::random_flight_rows(rows, 6);
  made.name = "made";
  std::vector<double> volts;
  for (std::size_t row = 0; row < rows; ++row) {
    Sample& sample = made[row];
    sample.time_s = 0.02 * static_cast<double>(row);
    volts.push_back(uniform(engine, 14, 16.8));
    const double s_z = sample_features<SpecificForce, double>(sample)[2];
    for (std::size_t i = 0; i < 4; ++i) {
      sample.commands[i] = 0.9 - 0.04 * s_z - 0.05 * volts.back() +
                           (i % 2 == 0 ? 0.002 : -0.002) * sample.angular_acceleration_rad_s2[0] +
                           uniform(engine, -0.01, 0.01);
    }
  }
  made.add_column({{"battery_voltage", "V"}, volts});
  return made;
}

struct Fitted {
  Flight of = flight();
  RowSet rows{of, {0, of.size()}};
  Setting context = make_context<Setting>(rows);
  AffineMap map = fit_ridge(regression_sums(context, rows), 1e-3);
};

template <class Answer>
void check_export(const Fitted& fitted, const Answer& answer, const std::string& expected_network) {
  const auto model = make_trained_model(answer, fitted.context, fitted.rows);
  using Model = std::decay_t<decltype(model)>;
  const auto golden = golden_features(model, fitted.rows);
  std::ostringstream header;
  write_model(header, "Ridge", model, golden, Provenance{});
  CHECK(header.str().find("using Network = " + expected_network + ";") != std::string::npos);
  CHECK(header.str().find("using Features = pinnquad::PartlyWindowed<pinnquad::WithColumns<pinnquad::PhysicsFeatures, "
                          "pinnquad::BatteryVoltage>, pinnquad::AccelerationFeatures, 3, "
                          "pinnquad::PeriodMicroseconds<20000>") != std::string::npos);
  CHECK(header.str().find("wdot_z[-2] [rad/s^2]") != std::string::npos);

  const BlockBytes bytes(model_block(model, golden, Provenance{}));
  ModelView<Model> view;
  REQUIRE(ModelView<Model>::open(bytes.data(), bytes.size(), view) == Status::ok);
  const InverseDynamics<ModelView<Model>> inverse(view);
  CHECK(self_test(inverse) == Status::ok);

  int answered = 0;
  each_features<Features, float>(fitted.rows, [&](const Flight&, std::size_t row, const auto& x) {
    Commands<float> u{}, same{};
    REQUIRE(inverse.predict_features(x.data(), u) == Status::ok);
    const Commands<float> expected = model.predict(x);
    for (std::size_t i = 0; i < 4; ++i) CHECK(u[i] == doctest::Approx(double(expected[i])).epsilon(1e-5));
    ++answered;
    if (row % 50 != 3) return;
    std::vector<float> by_x(4 * std::size_t(Features::size));
    REQUIRE(predict_with_jacobian(inverse, x.data(), same.data(), by_x.data()) == Status::ok);
    for (int tap = 0; tap < 3; ++tap) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto k = std::size_t(angular_acceleration_at<Features>(tap) + axis);
        auto above = x, below = x;
        constexpr float step = 0.5F;  // a float's rounding is far below, the network's curve too
        above[k] += step;
        below[k] -= step;
        for (std::size_t i = 0; i < 4; ++i) {
          const float slope = (model.predict(above)[i] - model.predict(below)[i]) / (2 * step);
          CHECK(by_x[i * std::size_t(Features::size) + k] == doctest::Approx(double(slope)).epsilon(2e-3).scale(0.005));
        }
      }
    }
  });
  CHECK(answered == 148);

  // as a loop flies it: warming up, then answers; of a voltage that it never saw those of the range's edge
  InputHistory<Features, float> history;
  const FlightInputs<WithColumns<PhysicsFeatures, BatteryVoltage>::Inputs<float>> recorded(fitted.rows.pieces()[0]);
  Commands<float> u{};
  for (std::size_t row = 0; row < 4; ++row) {
    InputHistory<Features, float>::Present present;
    REQUIRE(recorded.read(row, present));
    static_cast<void>(history.take(present, 0.02 * double(row)));
    CHECK(inverse.predict(history.inputs(), u) == (row < 2 ? Status::warming_up : Status::ok));
  }
  const auto at_voltage = [&](float volts) {
    auto inputs = history.inputs();
    inputs.template column<BatteryVoltage>() = volts;
    std::vector<float> x(static_cast<std::size_t>(Features::size));
    Features::extract(inputs, x.data());
    return x;
  };
  const std::size_t voltage = PhysicsFeatures::size;
  for (const auto& [edge, beyond] :
       {std::pair(model.envelope_lower[voltage], 9.0F), std::pair(model.envelope_upper[voltage], 25.0F)}) {
    const std::vector<float> x = at_voltage(beyond);
    Commands<float> at_edge{}, further{}, at_once{}, at_run_time{};
    REQUIRE(inverse.predict_features(at_voltage(edge).data(), at_edge) == Status::ok);
    CHECK(at_edge != u);
    CHECK(inverse.predict_features(x.data(), further) == Status::ok);
    CHECK(further == at_edge);
    Status status{};
    predict_batch(inverse, x.data(), at_once.data(), &status, 1);
    CHECK(status == Status::ok);
    for (std::size_t i = 0; i < 4; ++i) CHECK(at_once[i] == doctest::Approx(double(at_edge[i])).epsilon(1e-6));
    const auto opened = std::make_unique<RunTimeModel<float>>();
    REQUIRE(RunTimeModel<float>::open(bytes.data(), bytes.size(), *opened) == Status::ok);
    CHECK(opened->inside_envelope(x.data()));
    std::vector<float> work(opened->workspace());
    opened->commands(x.data(), at_run_time.data(), work.data());
    CHECK(at_run_time == at_edge);
  }
  auto none = history.inputs();
  none.template column<BatteryVoltage>() = std::numeric_limits<float>::quiet_NaN();
  CHECK(inverse.predict(none, u) == Status::not_finite);
}

}  // namespace

TEST_CASE("a ridge with a network on its residual exports, opens, tests itself and flies") {
  const Fitted fitted;
  std::mt19937_64 engine(8);
  Residual residual;
  test::fill_uniform(residual.parameters, engine, 0.3);
  check_export(fitted, sum_of(affine_answer<Setting>(fitted.map), residual),
               "pinnquad::Sum<pinnquad::Network<float, pinnquad::InputSize<34>, pinnquad::Dense<4>>, "
               "pinnquad::Network<float, pinnquad::InputSize<34>, pinnquad::Clip, pinnquad::Dense<6>, pinnquad::Silu, "
               "pinnquad::Dense<4>>>");
}
