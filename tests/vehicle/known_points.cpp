// SPDX-License-Identifier: MIT
// The library against rows of a second formula that was itself confirmed against the independent simulator.
#include "vehicle/known_points.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"
#include "support/compare_with_plain.hpp"
#include "support/tolerances.hpp"

namespace {

/// The float vehicle: rounding of a hundred operations, and Conyers' coefficients, which nearly cancel.
template <class Scalar>
inline constexpr double row_tolerance = sizeof(Scalar) == 4 ? 2e-5 : 1e-11;

bool clips(const plain::Point& p) {
  return std::min({p.u1, p.u2, p.u3, p.u4}) < 0.0 || std::max({p.u1, p.u2, p.u3, p.u4}) > 1.0;
}

}  // namespace

TEST_CASE("the rows hold what they are meant to: wind, clipped rotors, ground effect") {
  int wind = 0, clipped = 0, ground = 0, still = 0;
  for (const known::Row& row : known::rows) {
    (row.point.wind_x != 0.0 ? wind : still) += 1;
    clipped += clips(row.point) ? 1 : 0;
    ground += row.result.ground_force[2] != 0.0 ? 1 : 0;
  }
  CHECK(wind >= 8);
  CHECK(still >= 8);
  CHECK(clipped >= 4);
  CHECK(ground >= 6);
}

TEST_CASE("the plain formula still gives its rows") {
  const double tolerance = pinnquad::test::second_formula_tolerance;
  for (const known::Row& row : known::rows) {
    const pinnquad::test::Differences d = pinnquad::test::differences(plain::evaluate(row.point), row.result);
    CHECK(d.density <= tolerance);
    CHECK(d.rotor_force <= tolerance);
    CHECK(d.rotor_torque <= tolerance);
    CHECK(d.drag_force <= tolerance);
    CHECK(d.ground_force <= tolerance);
    CHECK(d.acceleration <= tolerance);
    CHECK(d.body_derivative <= tolerance);
    CHECK(d.angular <= tolerance);
  }
}

TEST_CASE_TEMPLATE("the library gives the rows of the plain formula", Scalar, float, double) {
  const double tolerance = row_tolerance<Scalar>;
  const auto airframe = pinnquad::ReferenceQuadrotor15::value<Scalar>();
  for (const known::Row& row : known::rows) {
    const pinnquad::test::Differences d =
        pinnquad::test::differences(pinnquad::test::evaluate(airframe, row.point), row.result);
    CAPTURE(row.point.pz);
    CHECK(d.density <= tolerance);
    CHECK(d.rotor_force <= tolerance);
    CHECK(d.rotor_torque <= tolerance);
    CHECK(d.drag_force <= tolerance);
    CHECK(d.ground_force <= tolerance);
    CHECK(d.acceleration <= tolerance);
    CHECK(d.body_derivative <= tolerance);
    CHECK(d.angular <= tolerance);
  }
}
