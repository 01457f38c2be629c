// SPDX-License-Identifier: MIT
// Dryden gusts against the closed forms of MIL-F-8785C: scales, variances, correlations over distance, frozen field.
#include "pinnquad/aero/dryden.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using pinnquad::DrydenParameters;
using pinnquad::DrydenTurbulence;
using pinnquad::Surroundings;

namespace {
/// Mean of g(s) g(s + lag) over many independent fields.
double correlation(std::size_t axis, double lag_m, const DrydenParameters& parameters) {
  std::mt19937_64 engine(7);
  double sum = 0.0;
  constexpr int fields = 4000;
  for (int i = 0; i < fields; ++i) {
    const DrydenTurbulence<16> field(engine, parameters, 0.0);
    sum += field.gust(axis, 3.0) * field.gust(axis, 3.0 + lag_m);
  }
  return sum / fields;
}

const DrydenParameters unit{{100.0, 80.0, 50.0}, {2.0, 1.5, 1.0}};

/// The mean of 4000 products of nearly normal gusts: two standard errors of the variance are 2 sqrt(2 / 4000) of it.
constexpr double sampling_tolerance = 0.06;
}  // namespace

TEST_CASE("scales and intensities of MIL-F-8785C, low altitude") {
  // h = 100 ft = 30.48 m: base = 0.2593, L_u = 100 / 0.2593^1.2 = 505.1 ft, sigma_u / sigma_w = 0.2593^-0.4 = 1.7161
  const DrydenParameters p = DrydenParameters::low_altitude(15.0, 30.48);
  CHECK(p.length_m[0] == doctest::Approx(505.1 * 0.3048).epsilon(1e-3));
  CHECK(p.length_m[1] == p.length_m[0]);
  CHECK(p.length_m[2] == doctest::Approx(30.48).epsilon(1e-12));
  CHECK(p.intensity_m_s[2] == doctest::Approx(1.5).epsilon(1e-12));
  CHECK(p.intensity_m_s[0] == doctest::Approx(1.5 * 1.7161).epsilon(1e-3));
  // at 1000 ft the base is 1: isotropic, L = h
  const DrydenParameters top = DrydenParameters::low_altitude(15.0, 304.8);
  for (int i = 0; i < 3; ++i) CHECK(top.length_m[static_cast<std::size_t>(i)] == doctest::Approx(304.8).epsilon(1e-9));
  CHECK(DrydenParameters::low_altitude(15.0, 0.1).length_m[2] == doctest::Approx(3.048).epsilon(1e-12));
  CHECK(DrydenParameters::low_altitude(15.0, 9000.0).length_m[2] == doctest::Approx(304.8).epsilon(1e-12));
}

TEST_CASE("variance and correlation over distance: sigma^2 e^-x along, sigma^2 e^-x (1 - x/2) across and down") {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    const double variance = unit.intensity_m_s[axis] * unit.intensity_m_s[axis];
    for (const double x : {0.0, 0.5, 1.0, 3.0}) {
      CAPTURE(x);
      const double expected = variance * std::exp(-x) * (axis == 0 ? 1.0 : 1.0 - x / 2);
      CHECK(std::fabs(correlation(axis, x * unit.length_m[axis], unit) - expected) <= sampling_tolerance * variance);
    }
  }
}

TEST_CASE("one field: its energy is exact, over a long track too") {
  std::mt19937_64 engine(8);
  const DrydenTurbulence<> field(engine, unit, 0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double sum = 0.0, squares = 0.0;
    constexpr int points = 200000;
    for (int i = 0; i < points; ++i) {
      const double g = field.gust(axis, 1.7 * i);
      sum += g;
      squares += g * g;
    }
    const double variance = unit.intensity_m_s[axis] * unit.intensity_m_s[axis];
    CHECK(std::fabs(sum / points) < 0.05 * unit.intensity_m_s[axis]);
    CHECK(squares / points == doctest::Approx(variance).epsilon(0.05));
  }
}

TEST_CASE("frozen field: standing still in the wind meets the gusts that flying against still air meets") {
  std::mt19937_64 engine(9);
  const double wind = 6.0;
  const DrydenTurbulence<> field(engine, unit, wind, {0.6, 0.8});
  for (int i = 0; i < 50; ++i) {
    Surroundings<double> waiting, moving;
    waiting.time_s = 0.3 * i;
    moving.position_m = {-0.6 * wind * 0.3 * i, -0.8 * wind * 0.3 * i, -20.0};
    field.surroundings(waiting);
    field.surroundings(moving);
    CHECK((waiting.wind_m_s - moving.wind_m_s).norm() < 1e-9);
  }
}

TEST_CASE("gusts add to the wind, along and across its direction; the same engine gives the same air") {
  std::mt19937_64 first(10), again(10);
  const DrydenTurbulence<> a(first, unit, 4.0, {0.0, 1.0}), b(again, unit, 4.0, {0.0, 1.0});
  Surroundings<double> air, same;
  air.wind_m_s = same.wind_m_s = {1.0, 2.0, 3.0};
  air.position_m = same.position_m = {5.0, 7.0, -9.0};
  a.surroundings(air);
  b.surroundings(same);
  CHECK(air.wind_m_s == same.wind_m_s);
  CHECK(air.wind_m_s[0] == 1.0 - a.gust(1, 7.0));
  CHECK(air.wind_m_s[1] == 2.0 + a.gust(0, 7.0));
  CHECK(air.wind_m_s[2] == 3.0 + a.gust(2, 7.0));
  static_assert(pinnquad::changes_surroundings<DrydenTurbulence<>> && !pinnquad::makes_wrench<DrydenTurbulence<>>);
}

TEST_CASE("parameters that are no field of gusts make a vehicle's status") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto status = [](const DrydenParameters& parameters, double mean_m_s, std::array<double, 2> direction) {
    std::mt19937_64 engine(1);
    return DrydenTurbulence<4>(engine, parameters, mean_m_s, direction).status(pinnquad::Airframe<double>{});
  };
  CHECK(status(unit, 5.0, {1.0, 0.0}) == pinnquad::Status::ok);
  DrydenParameters parameters = unit;
  parameters.intensity_m_s[1] = 0.0;  // calm across
  CHECK(status(parameters, 0.0, {0.6, -0.8}) == pinnquad::Status::ok);
  for (const double bad : {-1.0, nan}) {
    parameters = unit;
    parameters.intensity_m_s[2] = bad;
    CHECK(status(parameters, 5.0, {1.0, 0.0}) == pinnquad::Status::out_of_range);
    parameters = unit;
    parameters.length_m[0] = bad;
    CHECK(status(parameters, 5.0, {1.0, 0.0}) == pinnquad::Status::out_of_range);
  }
  parameters.length_m[0] = 0.0;
  CHECK(status(parameters, 5.0, {1.0, 0.0}) == pinnquad::Status::out_of_range);
  CHECK(status(unit, nan, {1.0, 0.0}) == pinnquad::Status::out_of_range);
  CHECK(status(unit, 5.0, {0.0, 0.0}) == pinnquad::Status::out_of_range);
  CHECK(status(DrydenParameters::low_altitude(-15.0, 30.0), 5.0, {1.0, 0.0}) == pinnquad::Status::out_of_range);
  CHECK(status(DrydenParameters::low_altitude(15.0, nan), 5.0, {1.0, 0.0}) == pinnquad::Status::out_of_range);
}
