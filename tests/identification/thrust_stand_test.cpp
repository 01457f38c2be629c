// SPDX-License-Identifier: MIT
#include "pinnquad/identification/thrust_stand.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"

using pinnquad::fit_thrust_stand;
using pinnquad::Status;
using pinnquad::ThrustStandFit;
using pinnquad::ThrustStandRow;

namespace {
std::vector<ThrustStandRow> stand(double most_N, double curve, double ratio_m, double noise_N, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::vector<ThrustStandRow> rows;
  for (int i = 2; i <= 20; ++i) {
    const double u = 0.05 * i;
    const double thrust = most_N * ((1 - curve) * u + curve * u * u);
    const double error = noise_N * pinnquad::standard_normal(engine);
    rows.push_back({u, thrust + error, ratio_m * thrust});
  }
  return rows;
}
double squared_error(const std::vector<ThrustStandRow>& rows, double most_N, double curve) {
  double sum = 0;
  for (const ThrustStandRow& row : rows) {
    const double error = row.thrust_N - most_N * ((1 - curve) * row.command + curve * row.command * row.command);
    sum += error * error;
  }
  return sum;
}
}  // namespace

TEST_CASE("a row begins with a motor that is told nothing and gives nothing") {
  const ThrustStandRow row;
  CHECK(row.command == 0);
  CHECK(row.thrust_N == 0);
  CHECK(row.torque_N_m == 0);
}

TEST_CASE("without noise the truth comes back") {
  for (const double curve : {0.0, 0.3, 0.85, 1.0}) {
    ThrustStandFit fit;
    REQUIRE(fit_thrust_stand(stand(7.5, curve, 0.016, 0, 1), fit) == Status::ok);
    CHECK(fit.max_thrust_N == doctest::Approx(7.5).epsilon(1e-10));
    CHECK(std::fabs(fit.thrust_curve - curve) <= 1e-10);
    CHECK(fit.torque_over_thrust_m == doctest::Approx(0.016).epsilon(1e-10));
    CHECK(fit.thrust_error_N <= 1e-9);
    CHECK(fit.torque_error_N_m <= 1e-9);
  }
}

TEST_CASE("with noise no parameters nearby are better, and the error is the noise") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto rows = stand(7.5, 0.6, 0.016, 0.05, seed);
    ThrustStandFit fit;
    REQUIRE(fit_thrust_stand(rows, fit) == Status::ok);
    const double best = squared_error(rows, fit.max_thrust_N, fit.thrust_curve);
    for (const double step : {-1e-4, 1e-4}) {
      CHECK(squared_error(rows, fit.max_thrust_N + step, fit.thrust_curve) > best);
      CHECK(squared_error(rows, fit.max_thrust_N, fit.thrust_curve + step) > best);
    }
    CHECK(fit.thrust_error_N == doctest::Approx(std::sqrt(best / 19)));
    CHECK(fit.thrust_error_N < 0.1);
    CHECK(std::fabs(fit.thrust_curve - 0.6) < 0.15);
  }
}

TEST_CASE("a curve beyond the ends is the nearest end") {
  ThrustStandFit fit;
  REQUIRE(fit_thrust_stand(stand(5, -0.4, 0.01, 0, 1), fit) == Status::ok);  // bends down: a motor that sags
  CHECK(fit.thrust_curve == 0);
  REQUIRE(fit_thrust_stand(stand(5, 1.1, 0.01, 0, 1), fit) == Status::ok);
  CHECK(fit.thrust_curve == 1);
}

TEST_CASE("an airframe with the fit makes the stand's thrust and torque") {
  ThrustStandFit fit;
  REQUIRE(fit_thrust_stand(stand(7.5, 0.6, 0.016, 0, 1), fit) == Status::ok);
  pinnquad::Airframe<double> a = pinnquad::PaperQuadrotor::value<double>();
  REQUIRE(pinnquad::apply(fit, pinnquad::rated_air_density_kg_m3<double>, a) == Status::ok);
  CHECK(a.max_rotor_thrust_N() == doctest::Approx(7.5).epsilon(1e-10));
  CHECK(a.max_rotor_torque_N_m() == doctest::Approx(0.016 * 7.5).epsilon(1e-10));
  for (const auto& rotor : a.rotors) CHECK(rotor.thrust_curve == doctest::Approx(0.6).epsilon(1e-9));
  REQUIRE(pinnquad::apply(fit, 1.0, a) == Status::ok);  // measured in thin air: more in the rated one
  CHECK(a.max_rotor_thrust_N() == doctest::Approx(7.5 * 1.225).epsilon(1e-10));
  a.propeller_diameter_m = 0;
  CHECK(pinnquad::apply(fit, 1.225, a) == Status::out_of_range);
}

TEST_CASE("rows that say nothing or nonsense are refused and the fit is untouched") {
  ThrustStandFit fit;
  fit.max_thrust_N = 42;
  CHECK(fit_thrust_stand({}, fit) == Status::no_solution);
  CHECK(fit_thrust_stand({{0.5, 1, 0.1}, {0.5, 1.1, 0.1}}, fit) == Status::no_solution);
  CHECK(fit_thrust_stand({{0.0, 0, 0}, {0.5, 1.1, 0.1}}, fit) == Status::no_solution);
  CHECK(fit_thrust_stand({{0.2, 0, 0}, {0.5, 0, 0}}, fit) == Status::no_solution);
  CHECK(fit_thrust_stand({{0.2, std::nan(""), 0}, {0.5, 1, 0}}, fit) == Status::not_finite);
  CHECK(fit_thrust_stand({{0.2, -1, 0}, {0.5, 1, 0}}, fit) == Status::out_of_range);
  CHECK(fit_thrust_stand({{20, 1, 0}, {50, 2, 0}}, fit) == Status::out_of_range);            // per cent
  CHECK(fit_thrust_stand({{0.2, 1e200, 0}, {0.5, 3e200, 1}}, fit) == Status::out_of_range);  // squares overflow
  CHECK(fit.max_thrust_N == 42);
}
