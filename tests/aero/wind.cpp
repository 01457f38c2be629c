// SPDX-License-Identifier: MIT
#include "pinnquad/aero/wind.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "support/tolerances.hpp"

using pinnquad::Surroundings;
using pinnquad::Vector3;

TEST_CASE_TEMPLATE("winds add up and leave the density alone", Scalar, float, double) {
  Surroundings<Scalar> air;
  const Scalar density = air.air_density_kg_m3;
  pinnquad::ConstantWind{{1.0, 2.0, -0.5}}.surroundings(air);
  pinnquad::ConstantWind{{0.5, -1.0, 0.0}}.surroundings(air);
  CHECK(air.wind_m_s == Vector3<Scalar>(Scalar(1.5), Scalar(1), Scalar(-0.5)));
  CHECK(air.air_density_kg_m3 == density);
}

TEST_CASE_TEMPLATE("the paper's D3: 2.5 sin(pi t / 5) + 2.5 m/s towards north", Scalar, float, double) {
  for (int i = 0; i < 300; ++i) {
    const double t = 0.37 * i;
    Surroundings<Scalar> air;
    air.time_s = Scalar(t);
    pinnquad::PeriodicWind{}.surroundings(air);
    const double expected = 2.5 * std::sin(3.14159265358979323846 * t / 5.0) + 2.5;
    // the phase reaches 70 rad and carries its own rounding
    CHECK(std::fabs(static_cast<double>(air.wind_m_s[0]) - expected) <= pinnquad::test::rounding<Scalar>(400));
    CHECK(air.wind_m_s[1] == Scalar(0));
    CHECK(air.wind_m_s[2] == Scalar(0));
  }
}

TEST_CASE("a periodic wind: mean, amplitude, period and direction are what they say") {
  pinnquad::PeriodicWind wind;
  wind.direction = {0.0, 0.6, -0.8};
  wind.mean_m_s = 1.0;
  wind.amplitude_m_s = 3.0;
  wind.period_s = 4.0;
  const auto at = [&](double t) {
    Surroundings<double> air;
    air.time_s = t;
    air.wind_m_s = Vector3<double>(7, 0, 0);
    wind.surroundings(air);
    return air.wind_m_s;
  };
  const double tolerance = pinnquad::test::rounding<double>(50);
  CHECK(pinnquad::test::distance(at(0.0), Vector3<double>(7, 0.6, -0.8)) <= tolerance);
  CHECK(pinnquad::test::distance(at(1.0), Vector3<double>(7, 2.4, -3.2)) <= tolerance);
  CHECK(pinnquad::test::distance(at(3.0), Vector3<double>(7, -1.2, 1.6)) <= tolerance);
  CHECK(pinnquad::test::distance(at(5.0), at(1.0)) <= tolerance);
}
