// SPDX-License-Identifier: MIT
#include "pinnquad/inference/output_schema.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"
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

TEST_CASE("what is an output schema") {
  CHECK(is_output_schema<CommandOutputs>);
  CHECK(is_output_schema<RotorSpeedOutputs>);
  CHECK_FALSE(is_output_schema<PaperQuadrotor>);
  CHECK_FALSE(is_output_schema<int>);
}
