// SPDX-License-Identifier: MIT
#include "pinnquad/outputs/output_schema.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"
#include "pinnquad/exported/model.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/inference/pipeline.hpp"
#include "pinnquad/outputs/wrench_outputs.hpp"
#include "support/tolerances.hpp"

using pinnquad::CommandOutputs;
using pinnquad::is_output_schema;
using pinnquad::PaperQuadrotor;
using pinnquad::RotorSpeedOutputs;
using pinnquad::test::rounding;

TEST_CASE_TEMPLATE("command -> output -> command, and the slope", Schema, CommandOutputs, RotorSpeedOutputs) {
  const auto airframe = PaperQuadrotor::value<double>();
  for (double u = 0.0; u <= 1.0; u += 0.05) {
    const double output = Schema::from_command(u, airframe);
    CHECK(std::fabs(Schema::command(output, airframe) - u) <= rounding<double>(4));
  }
  const double full = Schema::from_command(1.0, airframe), step = 1e-6 * full;
  for (double share = -1.5; share <= 1.5; share += 0.1) {
    const double y = share * full;
    const double difference = (Schema::command(y + step, airframe) - Schema::command(y - step, airframe)) / (2 * step);
    const double slope = Schema::command_slope(y, airframe);
    CHECK(std::fabs(slope - difference) <=
          2e-6 * Schema::command_slope(full, airframe));  // the step, at the kink of u''
    CHECK(slope >= 0.0);
  }
}

TEST_CASE("rotor speeds: (n / n_max)^2, rev/s; a negative speed keeps its sign, a negative command has none") {
  const auto airframe = PaperQuadrotor::value<double>();
  CHECK(RotorSpeedOutputs::from_command(1.0, airframe) == doctest::Approx(8500.0 / 60.0));
  CHECK(RotorSpeedOutputs::from_command(0.25, airframe) == doctest::Approx(8500.0 / 120.0));
  CHECK(RotorSpeedOutputs::from_command(-0.1, airframe) == 0.0);
  CHECK(RotorSpeedOutputs::command(-8500.0 / 120.0, airframe) == doctest::Approx(-0.25));
}

namespace {

constexpr double curves[] = {0.0, 0.3, 0.6, 1.0};

/// Each rotor answers its command by another curve.
struct CurvedQuadrotor {
  static constexpr const char* name = "curved_quadrotor";
  template <class Scalar>
  static constexpr pinnquad::Airframe<Scalar> value() {
    pinnquad::Airframe<Scalar> airframe = PaperQuadrotor::value<Scalar>();
    for (std::size_t i = 0; i < 4; ++i) airframe.rotors[i].thrust_curve = Scalar(curves[i]);
    return airframe;
  }
};

/// The form without a rotor's index, and with nothing else.
struct HalvedOutputs : pinnquad::EachRotor<HalvedOutputs> {
  static constexpr std::array<const char*, 4> names = {"a", "b", "c", "d"};
  static constexpr std::array<const char*, 4> units = {"1", "1", "1", "1"};
  template <class Scalar>
  static Scalar from_command(Scalar command, const pinnquad::Airframe<Scalar>&, std::size_t) noexcept {
    return 2 * command;
  }
  template <class Scalar>
  static Scalar command(Scalar output, const pinnquad::Airframe<Scalar>&, std::size_t) noexcept {
    return output / 2;
  }
  template <class Scalar>
  static Scalar command_slope(Scalar, const pinnquad::Airframe<Scalar>&, std::size_t) noexcept {
    return Scalar(1) / 2;
  }
};

}  // namespace

TEST_CASE("rotor speeds of rotors with curves: each command by its own rotor, there and back, slopes") {
  using Map = pinnquad::OutputMap<RotorSpeedOutputs>;
  const auto airframe = CurvedQuadrotor::value<double>();
  const double n_max = airframe.max_rotor_speed_rev_s;
  for (double share = -1.2; share <= 1.21; share += 0.1) {
    const double n = share * n_max, step = 1e-6 * n_max;
    const double speeds[] = {n, n, n, n}, above[] = {n + step, n + step, n + step, n + step};
    const double below[] = {n - step, n - step, n - step, n - step};
    double u[4], up[4], down[4], slopes[4], again[4];
    Map::commands(static_cast<const double*>(nullptr), speeds, airframe, u);
    Map::commands(static_cast<const double*>(nullptr), above, airframe, up);
    Map::commands(static_cast<const double*>(nullptr), below, airframe, down);
    Map::slopes(static_cast<const double*>(nullptr), speeds, airframe, slopes);
    Map::from_commands(static_cast<const double*>(nullptr), static_cast<const double*>(u), airframe, again);
    for (std::size_t i = 0; i < 4; ++i) {
      CAPTURE(i);
      CAPTURE(share);
      // thrust goes with the square of the speed, whatever command makes it
      const double fraction = u[i] * (1 - curves[i] + curves[i] * std::fabs(u[i]));
      CHECK(std::fabs(fraction - share * std::fabs(share)) <= rounding<double>(16));
      CHECK(std::fabs(slopes[i] * n_max - (up[i] - down[i]) / (2 * step) * n_max) <= 1e-5);  // the step, at the kink
      CHECK(std::fabs(again[i] - (share < 0 ? 0.0 : n)) <= n_max * rounding<double>(64));
    }
  }
  // a command that is a speed fraction has a slope at rest too
  const double rest[] = {0, 0, 0, 0};
  double slopes[4];
  Map::slopes(static_cast<const double*>(nullptr), rest, airframe, slopes);
  CHECK(slopes[0] == 0.0);
  CHECK(slopes[3] == doctest::Approx(1.0 / n_max));
}

TEST_CASE("a schema rotor by rotor knows which rotor it is asked about, in a prediction as in a batch") {
  using Pipeline = pinnquad::detail::Pipeline<pinnquad::PaperFeatures, RotorSpeedOutputs, CurvedQuadrotor>;
  constexpr int lanes = 3;
  const double mean[16] = {}, ones[16] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  const pinnquad::detail::Scales<double> scales{mean, ones, mean, ones, mean, ones};
  const auto airframe = CurvedQuadrotor::value<double>();
  const double x[16 * lanes] = {};
  double answers[4 * lanes], outputs[4], commands[4];
  for (int i = 0; i < 4 * lanes; ++i) answers[i] = 5.0 * i;
  for (int s = 0; s < lanes; ++s) {
    Pipeline::command(scales, x + s, lanes, answers + s, lanes, outputs, commands);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(outputs[i] == answers[i * lanes + std::size_t(s)]);
      CHECK(commands[i] == RotorSpeedOutputs::command(outputs[i], airframe, i));
    }
  }
}

TEST_CASE("what is an output schema") {
  CHECK(is_output_schema<HalvedOutputs>);
  CHECK(is_output_schema<CommandOutputs>);
  CHECK(is_output_schema<RotorSpeedOutputs>);
  CHECK_FALSE(is_output_schema<PaperQuadrotor>);
  CHECK_FALSE(is_output_schema<int>);
}

TEST_CASE("each output has a unit of its own") {
  CHECK(std::string(pinnquad::OutputMap<CommandOutputs>::units[0]) == "1");
  CHECK(std::string(pinnquad::OutputMap<pinnquad::WrenchOutputs>::units[0]) == "N");
}
