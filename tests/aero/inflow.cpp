// SPDX-License-Identifier: MIT
#include "pinnquad/aero/inflow.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/hub_motion.hpp"
#include "support/momentum_theory.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"
#include "support/uneven_airframe.hpp"

using pinnquad::Inflow;
using pinnquad::RotorCondition;
using pinnquad::Status;
using pinnquad::Vector3;
using pinnquad::test::RandomStates;

namespace {

constexpr double pi = 3.141592653589793;

/// Newton's five steps against the root; of float its rounding, as the ratio is a difference of two numbers near 2.
template <class Scalar>
constexpr double solved = sizeof(Scalar) == 4 ? 4e-6 : 1e-12;

template <class Scalar>
Inflow::Hover<Scalar> paper_hover() {
  return Inflow{}.bound(pinnquad::PaperQuadrotor::value<Scalar>());
}

/// Static thrust coefficient and those in axial flow at 6512 rpm of the APC Slow Flyer 10x4.7 (UIUC propeller database,
/// volume 1: apcsf_10x4.7_static_kt0835 at 6528 rpm, apcsf_10x4.7_rd0841_6512).
struct Measured {
  double advance_ratio, thrust_coefficient;
};
constexpr double measured_at_rest = 0.1299;
constexpr Measured measured[] = {{0.089, 0.1201}, {0.112, 0.1171}, {0.134, 0.1129}, {0.155, 0.1101}, {0.176, 0.1059},
                                 {0.199, 0.1019}, {0.225, 0.0974}, {0.246, 0.0935}, {0.266, 0.0895}, {0.287, 0.0865},
                                 {0.308, 0.0833}, {0.332, 0.0787}, {0.357, 0.0743}, {0.378, 0.0704}, {0.395, 0.0669},
                                 {0.420, 0.0616}, {0.445, 0.0562}};

}  // namespace

TEST_CASE("climb: the thrust of a propeller in a wind tunnel, from its chords and its thrust at rest") {
  constexpr double agreement = 0.02;  // of the thrust at rest: theory's, not the tunnel's
  auto airframe = pinnquad::PaperQuadrotor::value<double>();
  airframe.thrust_coefficient = measured_at_rest;
  airframe.propeller_diameter_m = 0.254;
  const auto hover = Inflow{}.bound(airframe);
  for (const Measured& m : measured) {
    CAPTURE(m.advance_ratio);
    // V / v_h = J n D / (lambda_h pi n D)
    const double climb = m.advance_ratio / (pi * std::sqrt(2 * measured_at_rest / (pi * pi * pi)));
    CHECK(std::fabs(hover.thrust_ratio(0.0, climb) - m.thrust_coefficient / measured_at_rest) <= agreement);
  }
}

TEST_CASE_TEMPLATE("blade elements and momentum agree, by bisection, wherever the climb is not held", Scalar, float,
                   double) {
  const auto hover = paper_hover<Scalar>();
  const double ratio = std::sqrt(2 * 0.1099 / (pi * pi * pi));
  CHECK(static_cast<double>(hover.inflow_ratio) == doctest::Approx(ratio).epsilon(1e-6));
  for (int i = 0; i <= 40; ++i) {
    for (int j = -5; j <= 14; ++j) {
      const double edgewise = 0.15 * i, climb = 0.1 * j;
      const auto truth =
          pinnquad::test::disc_flow(Inflow{}.solidity * Inflow{}.lift_slope_1_rad, ratio, edgewise, climb);
      const double r = static_cast<double>(hover.thrust_ratio(Scalar(edgewise * edgewise), Scalar(climb)));
      if (!(std::fabs(r - truth.thrust_ratio) <= solved<Scalar> * truth.thrust_ratio)) {
        FAIL_CHECK("x " << edgewise << " z " << climb << ": " << r << " against " << truth.thrust_ratio);
      }
    }
  }
}

TEST_CASE("about hover: the closed form's slope in climb and curvature sideways; nothing at rest") {
  const auto hover = paper_hover<double>();
  const double k = hover.gain, h = 1e-4;
  CHECK(k == doctest::Approx(0.107 * 5.1 / (8 * hover.inflow_ratio)));
  CHECK(hover.thrust_ratio(0, 0) == doctest::Approx(1).epsilon(1e-14));
  const double slope = (hover.thrust_ratio(0, h) - hover.thrust_ratio(0, -h)) / (2 * h);
  CHECK(slope == doctest::Approx(-k / (2 + k)).epsilon(1e-6));
  const double lift = (hover.thrust_ratio(h, 0) - 1) / h;
  const double lambda = hover.inflow_ratio;
  CHECK(std::fabs(lift / ((k / 2 + 3 * (1 + k) * lambda * lambda) / (2 + k)) - 1) <= 1e-3);
}

TEST_CASE("fast sideways flight: Glauert's high-speed limit, induced velocity T / (2 rho A V)") {
  const auto hover = paper_hover<double>();
  const double x = 12, r = hover.thrust_ratio(x * x, 0), lambda = hover.inflow_ratio, k = hover.gain;
  const double induced = ((1 + k) * (1 + 1.5 * lambda * lambda * x * x) - r) / k;
  CHECK(induced * x == doctest::Approx(r).epsilon(2e-3));
}

TEST_CASE_TEMPLATE("any climb and descent: the ratio stays positive, falls all the way and has no step", Scalar, float,
                   double) {
  const auto hover = paper_hover<Scalar>();
  double before = std::numeric_limits<double>::infinity(), slope_before = 0;
  const double step = 0.01;
  for (int i = -1000; i <= 1000; ++i) {
    const double r = static_cast<double>(hover.thrust_ratio(Scalar(0), Scalar(i * step)));
    const bool falls = r > 0.1 && r <= before + (sizeof(Scalar) == 4 ? 1e-6 : 0);
    if (!falls) FAIL_CHECK("z " << i * step << ": " << r << " after " << before);
    if (sizeof(Scalar) == 8 && i > -999) {
      const double slope = (r - before) / step;
      if (std::fabs(slope - slope_before) > 0.05) FAIL_CHECK("slope steps at z " << i * step);
      slope_before = slope;
    } else {
      slope_before = (r - before) / step;
    }
    before = r;
  }
}

TEST_CASE_TEMPLATE("each hub's force in three dimensions, of tilted rotors too", Scalar, float, double) {
  const auto airframe = pinnquad::test::uneven_airframe<Scalar>();
  const auto hover = Inflow{}.bound(airframe);
  RandomStates random(140);
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    RotorCondition<Scalar> c;
    c.air_relative_velocity_m_s = random.vector<Scalar>(6.0);
    c.body_rates_rad_s = random.vector<Scalar>(3.0);
    c.air_density_kg_m3 = random.scalar<Scalar>(0.9, 1.3);
    for (Scalar& thrust : c.rotor_thrust_N) thrust = random.scalar<Scalar>(0.0, 8.0);
    // v_h = sqrt(T / (2 rho A)) in this air
    const double area = pi * 0.2286 * 0.2286 / 4, weight = static_cast<double>(airframe.mass_kg) * 9.80665;
    const double v_h = std::sqrt(weight / 4 / (2 * static_cast<double>(c.air_density_kg_m3) * area));
    Vector3<double> force = Vector3<double>::Zero(), torque = Vector3<double>::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      const auto [arm, axis, v] = pinnquad::test::hub_motion(c, airframe.rotors[i]);
      const double climb = v.dot(axis), edgewise = (v - axis * climb).squaredNorm();
      const double r = static_cast<double>(hover.thrust_ratio(Scalar(edgewise / (v_h * v_h)), Scalar(climb / v_h)));
      const Vector3<double> lift = axis * ((r - 1) * static_cast<double>(c.rotor_thrust_N[i]));
      force += lift;
      torque += pinnquad::cross<double>(arm, lift);
    }
    const auto w = Inflow{}.bound(airframe).wrench(c, airframe);
    const double tolerance = pinnquad::test::rounding<Scalar>(2000);
    CHECK(pinnquad::test::distance(w.force_N, force) <= tolerance);
    CHECK(pinnquad::test::distance(w.torque_N_m, torque) <= tolerance);
  }
}

TEST_CASE("a rolling vehicle is damped: the side that goes up lifts less") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  RotorCondition<double> c;
  c.air_density_kg_m3 = 1.225;
  c.rotor_thrust_N = {3.7, 3.7, 3.7, 3.7};
  c.body_rates_rad_s = Vector3<double>(1, 0, 0);
  const auto w = Inflow{}.bound(airframe).wrench(c, airframe);
  const auto hover = paper_hover<double>();
  const double expected = -4 * 3.7 * hover.gain / (2 + hover.gain) * 0.243952 * 0.243952 / hover.induced_velocity_m_s;
  CHECK(std::fabs(w.torque_N_m[0] / expected - 1) <= 1e-3);
  CHECK(std::fabs(w.torque_N_m[1]) <= 1e-12);
}

TEST_CASE("values that are none of a propeller's are refused") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  CHECK(Inflow{}.status(airframe) == Status::ok);
  CHECK(Inflow{0.0, 5.1}.status(airframe) == Status::out_of_range);
  CHECK(Inflow{1.1, 5.1}.status(airframe) == Status::out_of_range);
  CHECK(Inflow{0.1, -1.0}.status(airframe) == Status::out_of_range);
  CHECK(Inflow{0.1, std::numeric_limits<double>::quiet_NaN()}.status(airframe) == Status::out_of_range);
  static_assert(pinnquad::uses_rotor_wrench<Inflow> && pinnquad::uses_rotor_wrench<Inflow::Hover<float>>);
}
