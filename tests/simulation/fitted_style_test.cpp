// SPDX-License-Identifier: MIT
// What a vehicle can do, for pilots: the rotor with most to do decides, in thrust and not in commands.
#include "pinnquad/simulation/fitted_style.hpp"

#include <doctest/doctest.h>

#include "pinnquad/aero/drag.hpp"
#include "support/uneven_airframe.hpp"

using namespace pinnquad;

TEST_CASE(
    "hover takes the share of thrust that leaves the controller's limit, of even rotors and of uneven ones with "
    "curves") {
  for (Airframe<double> airframe : {PaperQuadrotor::value<double>(), test::uneven_airframe<double>()}) {
    airframe.mass_kg *= 1.4;
    const Quadrotor<double> quadrotor(airframe, Site<double>{});
    const double hover = hover_command(quadrotor, Vector3<double>::Zero());
    CHECK(flight_limits(airframe, 1.0).max_specific_force_m_s2 ==
          doctest::Approx(0.97 * standard_gravity_m_s2<double> / hover).epsilon(1e-12));
  }
}

TEST_CASE(
    "the first rotor is not asked alone: a vehicle whose others work harder climbs as slowly as its mirror image") {
  Airframe<double> front = PaperQuadrotor::value<double>(), rear = front;
  for (auto& rotor : front.rotors) rotor.x_m -= 0.08;  // front rotors, the first among them, are nearer and give more
  for (auto& rotor : rear.rotors) rotor.x_m += 0.08;
  const PilotStyle a = pilot_style(Quadrotor<double, QuadraticDrag>(front, Site<double>{}, {}),
                                   Vector3<double>::Zero()),
                   b = pilot_style(Quadrotor<double, QuadraticDrag>(rear, Site<double>{}, {}), Vector3<double>::Zero());
  CHECK(a.max_climb_m_s == doctest::Approx(b.max_climb_m_s));
  CHECK(a.max_yaw_rate_rad_s == doctest::Approx(b.max_yaw_rate_rad_s));
  CHECK(a.max_climb_m_s <
        pilot_style(Quadrotor<double, QuadraticDrag>(PaperQuadrotor::value<double>(), Site<double>{}, {}),
                    Vector3<double>::Zero())
            .max_climb_m_s);
}
