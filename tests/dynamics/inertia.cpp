// SPDX-License-Identifier: MIT
#include "pinnquad/dynamics/rigid_body.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>

#include "pinnquad/dynamics/integrator.hpp"
#include "pinnquad/dynamics/linearized.hpp"
#include "support/linearized.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"
#include "support/uneven_airframe.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {
/// Eigen's dense matrix and LU: a formula of nobody here.
template <class Scalar>
Eigen::Matrix3d tensor(const Airframe<Scalar>& a) {
  const auto& d = a.inertia_kg_m2;
  const auto& p = a.inertia_products_kg_m2;
  Eigen::Matrix3d j;
  j << double(d[0]), double(p[0]), double(p[1]), double(p[0]), double(d[1]), double(p[2]), double(p[1]), double(p[2]),
      double(d[2]);
  return j;
}

/// The tensor of point masses: what a body can have, by its definition.
Airframe<double> of_masses(RandomStates& random) {
  Airframe<double> a = pinnquad::PaperQuadrotor::value<double>();
  Eigen::Matrix3d j = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3d r = random.vector<double>(0.2);
    j += random.scalar<double>(0.05, 0.4) * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
  }
  a.inertia_kg_m2 = {j(0, 0), j(1, 1), j(2, 2)};
  a.inertia_products_kg_m2 = {j(0, 1), j(0, 2), j(1, 2)};
  return a;
}
}  // namespace

TEST_CASE_TEMPLATE("Euler's equation with products of inertia, against dense algebra", Scalar, float, double) {
  const Airframe<Scalar> a = pinnquad::test::uneven_airframe<Scalar>();
  const Eigen::Matrix3d j = tensor(a);
  RandomStates random(81);
  for (int draw = 0; draw < draws; ++draw) {
    const Vector3<Scalar> w = random.vector<Scalar>(6), torque = random.vector<Scalar>(2);
    const Eigen::Vector3d wd = w.template cast<double>(), td = torque.template cast<double>();
    const Eigen::Vector3d expected = j.partialPivLu().solve(td - wd.cross(Eigen::Vector3d(j * wd)));
    const Vector3<Scalar> got = pinnquad::angular_acceleration(a, w, torque);
    CHECK(pinnquad::test::distance(got, expected) <= 200.0 * pinnquad::test::evaluation_tolerance<Scalar>);
    CHECK(pinnquad::test::distance(pinnquad::inertia_times<Scalar>(a, pinnquad::inertia_solved<Scalar>(a, torque)),
                                   torque) <= 2.0 * pinnquad::test::evaluation_tolerance<Scalar>);
  }
}

TEST_CASE("torque-free motion keeps angular momentum (world) and energy over many turns") {
  RandomStates random(82);
  for (int draw = 0; draw < 5; ++draw) {
    const Airframe<double> a = of_masses(random);
    REQUIRE(check_airframe(a) == Status::ok);
    State<double> state = random.state<double>();
    const auto momentum = [&a](const State<double>& s) {
      return pinnquad::body_to_world<double>(s.attitude, pinnquad::inertia_times<double>(a, s.body_rates_rad_s));
    };
    const auto energy = [&a](const State<double>& s) {
      return s.body_rates_rad_s.dot(pinnquad::inertia_times<double>(a, s.body_rates_rad_s)) / 2;
    };
    const Vector3<double> l0 = momentum(state);
    const double e0 = energy(state);
    const auto rate = [&a](const State<double>& s, double) {
      const auto motion = pinnquad::accelerations(a, s, pinnquad::Wrench<double>{}, 0.0);
      return pinnquad::detail::StateDerivative<double>{
          s.velocity_m_s, pinnquad::world_acceleration(s, motion.linear_m_s2),
          pinnquad::attitude_rate(s.attitude, s.body_rates_rad_s), motion.angular_rad_s2};
    };
    for (int i = 0; i < 4000; ++i) state = pinnquad::detail::rk4_step(state, 0.0005, rate);
    const double fourth_order = 1e-8;  // (6 rad/s x 0.5 ms)^5 x 4000 steps, with room
    CHECK(pinnquad::test::distance(momentum(state), l0) <= fourth_order * l0.norm());
    CHECK(std::fabs(energy(state) - e0) <= fourth_order * e0);
  }
}

TEST_CASE_TEMPLATE("required_wrench and accelerations with products are each other's inverse", Scalar, float, double) {
  const Airframe<Scalar> a = pinnquad::test::uneven_airframe<Scalar>();
  RandomStates random(83);
  for (int draw = 0; draw < draws; ++draw) {
    const State<Scalar> state = random.state<Scalar>();
    const pinnquad::Accelerations<Scalar> motion = random.motion<Scalar>();
    const pinnquad::Accelerations<Scalar> back =
        pinnquad::accelerations(a, state, pinnquad::required_wrench(a, state, motion, Scalar(9.8)), Scalar(9.8));
    CHECK(pinnquad::test::distance(back.angular_rad_s2, motion.angular_rad_s2) <=
          200.0 * pinnquad::test::evaluation_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("products that are next to nothing change next to nothing", Scalar, float, double) {
  const Airframe<Scalar> diagonal = pinnquad::PaperQuadrotor::value<Scalar>();
  Airframe<Scalar> full = diagonal;
  full.inertia_products_kg_m2 = {Scalar(1e-18), Scalar(0), Scalar(0)};
  RandomStates random(84);
  for (int draw = 0; draw < draws; ++draw) {
    const Vector3<Scalar> w = random.vector<Scalar>(6), torque = random.vector<Scalar>(2);
    CHECK(pinnquad::test::distance(pinnquad::angular_acceleration(full, w, torque),
                                   pinnquad::angular_acceleration(diagonal, w, torque)) <=
          200.0 * pinnquad::test::evaluation_tolerance<Scalar>);
    CHECK(pinnquad::angular_acceleration<true>(diagonal, w, torque) ==
          pinnquad::angular_acceleration(diagonal, w, torque));
  }
}

TEST_CASE("any body of point masses is allowed; one whose mass would be negative somewhere is not") {
  RandomStates random(85);
  for (int draw = 0; draw < draws; ++draw) CHECK(check_airframe(of_masses(random)) == Status::ok);
  for (int draw = 0; draw < draws; ++draw) {
    // principal moments that break the triangle inequality, turned any way: S has a negative eigenvalue
    const auto q = random.attitude<double>();
    const Eigen::Matrix3d r = Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
    const Eigen::Matrix3d j = r * Eigen::Vector3d(0.01, 0.012, 0.0225).asDiagonal() * r.transpose();
    Airframe<double> a = pinnquad::PaperQuadrotor::value<double>();
    a.inertia_kg_m2 = {j(0, 0), j(1, 1), j(2, 2)};
    a.inertia_products_kg_m2 = {j(0, 1), j(0, 2), j(1, 2)};
    CHECK(check_airframe(a) == Status::invalid_airframe);
  }
  Airframe<double> a = pinnquad::PaperQuadrotor::value<double>();
  a.inertia_products_kg_m2[0] = 0.016;  // more than sqrt(Jx Jy)
  CHECK(check_airframe(a) == Status::invalid_airframe);
  a.inertia_products_kg_m2[0] = std::nan("");
  CHECK(check_airframe(a) == Status::invalid_airframe);
}

TEST_CASE("Eq. (3) with uneven rotors: the slope of the nonlinear model at hover, and its inverse") {
  const Airframe<double> a = pinnquad::test::uneven_airframe<double>();
  const pinnquad::Rotors<double> rotors(a);
  const double g = 9.80665;
  pinnquad::Wrench<double> hover;
  hover.force_N[2] = -a.mass_kg * g;
  const pinnquad::Commands<double> u0 = rotors.commands(hover, 1.0);
  const double h = 1e-6;
  for (std::size_t i = 0; i < 4; ++i) {
    pinnquad::Commands<double> more = u0, less = u0;
    more[i] += h;
    less[i] -= h;
    const auto full = [&](const pinnquad::Commands<double>& u) {
      return pinnquad::accelerations(a, State<double>{}, rotors.wrench(u, 1.0), g);
    };
    const auto linear = [&](const pinnquad::Commands<double>& u) {
      return pinnquad::test::linearized_accelerations(a, 0.0, 0.0, rotors.wrench(u, 1.0), g);
    };
    const Vector3<double> d1 = full(more).linear_m_s2 - full(less).linear_m_s2,
                          d2 = linear(more).linear_m_s2 - linear(less).linear_m_s2;
    const Vector3<double> w1 = full(more).angular_rad_s2 - full(less).angular_rad_s2,
                          w2 = linear(more).angular_rad_s2 - linear(less).angular_rad_s2;
    CHECK(pinnquad::test::distance(d1, d2) <= 1e-8 * d1.norm());
    CHECK(pinnquad::test::distance(w1, w2) <= 1e-8 * w1.norm());
  }
  const pinnquad::Commands<double> u{0.4, 0.5, 0.6, 0.7};
  CHECK(pinnquad::test::distance(
            pinnquad::linearized_commands(
                a, rotors, pinnquad::test::linearized_accelerations(a, 0.1, -0.1, rotors.wrench(u, 0.9), g), g, 0.9),
            u) <= 1e-12);
}
