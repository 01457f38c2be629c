// SPDX-License-Identifier: MIT
// The rigid body's inverse without the angular acceleration, on an airframe whose inertia has products and whose rotors
// have curves: against the rotors' own inverse, slopes against differences; and signed sums on it, there and back.
#include "pinnquad/outputs/rigid_body_base.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/rigid_body.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"
#include "support/slope_differences.hpp"

using namespace pinnquad;

namespace {

using Sums = SignedSumsOn<RigidBodyBase>;
constexpr int features = PhysicsFeatures::size;
static_assert(PhysicsFeatures::names[RigidBodyBase::force_z][2] == 'z' &&
              PhysicsFeatures::names[RigidBodyBase::body_rates][0] == 'w' &&
              PhysicsFeatures::names[RigidBodyBase::body_rates][2] == 'x');

Airframe<double> crooked() {
  Airframe<double> airframe = PaperQuadrotor::value<double>();
  airframe.inertia_products_kg_m2 = {1.1e-3, -0.7e-3, 0.4e-3};
  const double curves[] = {0.0, 0.3, 0.6, 0.2};
  for (std::size_t i = 0; i < rotor_count; ++i) airframe.rotors[i].thrust_curve = curves[i];
  REQUIRE(check_airframe(airframe) == Status::ok);
  return airframe;
}

struct Point {
  double x[features] = {0.3, -0.2, -9.1, 4.0, -3.0, 0.5, 1.3, -2.1, 0.7};

  Point() {
    for (int i = 9; i < features; ++i) x[i] = 0.1 * i;
  }
};

}  // namespace

TEST_CASE("its commands make the thrust and the torque that hold the body rates") {
  const Airframe<double> airframe = crooked();
  const Point at;
  double u[rotor_count];
  RigidBodyBase::commands(static_cast<const double*>(at.x), RigidBodyBase::prepare(airframe), static_cast<double*>(u));
  const Vector3<double> rates(at.x[6], at.x[7], at.x[8]);
  Wrench<double> wrench;
  wrench.force_N = Vector3<double>(0, 0, airframe.mass_kg * at.x[2]);
  wrench.torque_N_m = cross<double>(rates, inertia_times(airframe, rates));
  const Commands<double> expected = Rotors<double>(airframe).commands(wrench, 1.0);
  for (std::size_t i = 0; i < rotor_count; ++i) CHECK(u[i] == doctest::Approx(expected[i]).epsilon(1e-12));

  Point turning;
  for (int axis = 0; axis < 3; ++axis) turning.x[3 + axis] += 100;
  double same[rotor_count];
  RigidBodyBase::commands(static_cast<const double*>(turning.x), RigidBodyBase::prepare(airframe),
                          static_cast<double*>(same));
  for (int i = 0; i < rotor_count; ++i) CHECK(same[i] == u[i]);
}

TEST_CASE("its slopes are central differences, and none is by the angular acceleration") {
  const auto body = RigidBodyBase::prepare(crooked());
  Point at;
  double slopes[rotor_count * features] = {};
  RigidBodyBase::slopes<features>(static_cast<const double*>(at.x), body, static_cast<double*>(slopes));
  test::check_slopes(static_cast<double*>(at.x), features, slopes,
                     [&](const double* x, double* commands) { RigidBodyBase::commands(x, body, commands); });
  for (int i = 0; i < rotor_count; ++i) {
    for (int k = 3; k < 6; ++k) CHECK(slopes[i * features + k] == 0);
  }
}

TEST_CASE("signed sums on it: there and back; 0 are its own commands") {
  const Airframe<double> airframe = crooked();
  const auto body = Sums::prepare(airframe);
  const Point at;
  const double* x = at.x;
  const double u[rotor_count] = {0.31, 0.62, 0.44, 0.57};
  double y[4], again[rotor_count], base[rotor_count];
  Sums::from_commands(x, static_cast<const double*>(u), body, static_cast<double*>(y));
  Sums::commands(x, static_cast<const double*>(y), body, static_cast<double*>(again));
  for (int i = 0; i < rotor_count; ++i) CHECK(again[i] == doctest::Approx(u[i]).epsilon(1e-14));
  const double nothing[4] = {};
  Sums::commands(x, static_cast<const double*>(nothing), body, static_cast<double*>(again));
  RigidBodyBase::commands(x, body.base, static_cast<double*>(base));
  for (int i = 0; i < rotor_count; ++i) CHECK(again[i] == base[i]);
}

TEST_CASE("a rotor that gives way to more thrust gives way most at command 0: no thrust slope is below the least") {
  // The centre of mass lies outside the rotors' rectangle: about one diagonal the shares of the thrust are < 0.
  Airframe<double> airframe = PaperQuadrotor::value<double>();
  for (auto& rotor : airframe.rotors) rotor.x_m += 0.3;
  const auto shares = RigidBodyBase::prepare(airframe).map;
  int giving_way = 0;
  for (std::size_t i = 0; i < rotor_count; ++i) {
    if (!(shares.by[i][0] < 0)) continue;
    airframe.rotors[i].thrust_curve = 0.5;
    ++giving_way;
  }
  REQUIRE(giving_way > 0);
  const auto body = RigidBodyBase::prepare(airframe);
  double x[features] = {}, u[rotor_count];
  const double step_m_s2 = 1e-6;
  x[RigidBodyBase::force_z] = -step_m_s2;
  RigidBodyBase::commands(static_cast<const double*>(x), body, static_cast<double*>(u));
  const double rise = (u[0] + u[1] + u[2] + u[3]) / step_m_s2;
  CHECK(RigidBodyBase::least_thrust_slope(airframe) <= rise + 1e-9);
  CHECK(RigidBodyBase::least_thrust_slope(airframe) == doctest::Approx(rise).epsilon(1e-4));
}

TEST_CASE("of curved thrust the least thrust slope is below each between commands 0 and 1, and near one of them") {
  Airframe<double> airframe = crooked();
  for (auto& rotor : airframe.rotors) rotor.x_m += 0.03;
  const double least = RigidBodyBase::least_thrust_slope(airframe);
  const auto body = RigidBodyBase::prepare(airframe);
  double nearest = 1e300;
  int inside = 0;
  for (double force = -0.5; force > -40; force -= 0.5) {
    double x[features] = {}, less[features] = {}, u[rotor_count], u_of_less[rotor_count];
    x[RigidBodyBase::force_z] = force;
    less[RigidBodyBase::force_z] = force + 1e-4;
    RigidBodyBase::commands(static_cast<const double*>(x), body, static_cast<double*>(u));
    RigidBodyBase::commands(static_cast<const double*>(less), body, static_cast<double*>(u_of_less));
    if (*std::max_element(u, u + rotor_count) > 1) continue;
    double rise = 0;
    for (std::size_t i = 0; i < rotor_count; ++i) rise += (u[i] - u_of_less[i]) / 1e-4;
    CHECK(rise >= least - 1e-9);
    nearest = std::min(nearest, rise - least);
    ++inside;
  }
  CHECK(inside > 10);
  CHECK(nearest < 0.1 * least);
}
