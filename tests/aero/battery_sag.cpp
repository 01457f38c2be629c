// SPDX-License-Identifier: MIT
#include "pinnquad/aero/battery_sag.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/vehicle/inverse.hpp"

using pinnquad::BatterySag;
using pinnquad::Quadrotor;
using pinnquad::Status;

TEST_CASE_TEMPLATE("thrust goes with the square of the voltage, which falls in a line and stays", Scalar, float,
                   double) {
  const auto scale_at = [](double time_s, double already) {
    pinnquad::Surroundings<Scalar> air;
    air.time_s = Scalar(time_s);
    air.thrust_scale = Scalar(already);
    BatterySag{12.0, 9.0, 600}.surroundings(air);
    return static_cast<double>(air.thrust_scale);
  };
  CHECK(scale_at(-5, 1) == doctest::Approx(1));
  CHECK(scale_at(0, 1) == doctest::Approx(1));
  CHECK(scale_at(200, 1) == doctest::Approx(11.0 * 11.0 / 144));
  CHECK(scale_at(600, 1) == doctest::Approx(81.0 / 144));
  CHECK(scale_at(9000, 1) == doctest::Approx(81.0 / 144));
  CHECK(scale_at(600, 0.5) == doctest::Approx(81.0 / 288));
}

TEST_CASE("the inverse asks for more as the battery sags") {
  const Quadrotor<double, BatterySag> vehicle(pinnquad::PaperQuadrotor::value<double>());
  pinnquad::Commands<double> full{}, half{};
  REQUIRE(inverse_commands(vehicle, pinnquad::State<double>{}, {}, 0.0, full) == Status::ok);
  REQUIRE(inverse_commands(vehicle, pinnquad::State<double>{}, {}, 450.0, half) == Status::ok);
  CHECK(half[0] / full[0] == doctest::Approx(12.6 * 12.6 / (11.55 * 11.55)).epsilon(1e-12));
}

TEST_CASE("voltages that are none are refused") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  CHECK(BatterySag{}.status(airframe) == Status::ok);
  CHECK(BatterySag{12, 13, 900}.status(airframe) == Status::out_of_range);
  CHECK(BatterySag{12, 0, 900}.status(airframe) == Status::out_of_range);
  CHECK(BatterySag{12, 10, 0}.status(airframe) == Status::out_of_range);
  CHECK(BatterySag{std::numeric_limits<double>::quiet_NaN(), 10, 900}.status(airframe) == Status::out_of_range);
}
