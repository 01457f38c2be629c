// SPDX-License-Identifier: MIT
#include "pinnquad/aero/drag.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"

using pinnquad::AeroCondition;
using pinnquad::QuadraticDrag;
using pinnquad::Wrench;

namespace {
template <class Scalar>
Wrench<Scalar> drag_at(const pinnquad::Vector3<Scalar>& velocity, Scalar density) {
  AeroCondition<Scalar> condition;
  condition.air_relative_velocity_m_s = velocity;
  condition.air_density_kg_m3 = density;
  return QuadraticDrag{}.wrench(condition, pinnquad::PaperQuadrotor::value<Scalar>());
}
}  // namespace

TEST_CASE_TEMPLATE("F = -k rho |v| v on each axis, with the airframe's areas, and no torque", Scalar, float, double) {
  const double k[3] = {5.38309e-3, 5.83809e-3, 0.1099301};
  pinnquad::test::RandomStates random(70);
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    const pinnquad::Vector3<Scalar> v = random.vector<Scalar>(12.0);
    const Scalar rho = random.scalar<Scalar>(0.5, 1.3);
    const Wrench<Scalar> drag = drag_at(v, rho);
    for (int i = 0; i < 3; ++i) {
      const double speed = static_cast<double>(v[i]);
      const double expected =
          std::fabs(speed) > 0.1 ? -k[i] * static_cast<double>(rho) * std::fabs(speed) * speed : 0.0;
      CHECK(std::fabs(static_cast<double>(drag.force_N[i]) - expected) <=
            pinnquad::test::rounding<Scalar>(8) * std::fabs(expected));
      CHECK(static_cast<double>(drag.force_N[i] * v[i]) <= 0.0);  // it never drives
    }
    CHECK(drag.torque_N_m == pinnquad::Vector3<Scalar>(0, 0, 0));
  }
}

TEST_CASE_TEMPLATE("the deadband: at it nothing, above it drag, on each side", Scalar, float, double) {
  const Scalar edge = pinnquad::PaperQuadrotor::value<Scalar>().drag_deadband_m_s;
  const Scalar above = std::nextafter(edge, Scalar(1));
  CHECK(drag_at<Scalar>({edge, -edge, Scalar(0)}, Scalar(1)).force_N == pinnquad::Vector3<Scalar>(0, 0, 0));
  const Wrench<Scalar> drag = drag_at<Scalar>({above, -above, above}, Scalar(1));
  CHECK(drag.force_N[0] < Scalar(0));
  CHECK(drag.force_N[1] > Scalar(0));
  CHECK(drag.force_N[2] < Scalar(0));
}

TEST_CASE_TEMPLATE("drag lets NaN through", Scalar, float, double) {
  const Scalar nan = std::numeric_limits<Scalar>::quiet_NaN();
  const Wrench<Scalar> drag = drag_at<Scalar>({nan, Scalar(1), Scalar(1)}, Scalar(1));
  CHECK(std::isnan(drag.force_N[0]));
  CHECK_FALSE(std::isnan(drag.force_N[1]));
}
