// SPDX-License-Identifier: MIT
#include "pinnquad/aero/ground_effect.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/plain_dynamics.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"

using pinnquad::AeroCondition;
using pinnquad::CheesemanBennett;
using pinnquad::Conyers;
using pinnquad::Vector3;
using pinnquad::Wrench;

namespace {
/// The paper's airframe with the motor spacing of 690 mm in full digits.
template <class Scalar>
pinnquad::Airframe<Scalar> airframe_690() {
  pinnquad::Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  const Scalar arm = Scalar(0.24395183950935892);  // 0.345 / sqrt(2)
  const Scalar sign[4][2] = {{1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
  for (std::size_t i = 0; i < 4; ++i) {
    airframe.rotors[i].x_m = sign[i][0] * arm;
    airframe.rotors[i].y_m = sign[i][1] * arm;
  }
  return airframe;
}

/// In float the coefficients of Conyers' polynomials are differences of terms a hundred times larger.
template <class Scalar>
inline constexpr double conyers_tolerance = pinnquad::test::rounding<Scalar>(500);

template <class Scalar>
Scalar conyers(double x) {
  return Conyers{}.thrust_ratio(Scalar(x), airframe_690<Scalar>());
}
}  // namespace

TEST_CASE_TEMPLATE("Cheeseman-Bennett: closed form, limits, and 1 where it does not hold", Scalar, float, double) {
  const auto ratio = [](double x) {
    return static_cast<double>(CheesemanBennett{}.thrust_ratio(Scalar(x), airframe_690<Scalar>()));
  };
  const double tolerance = pinnquad::test::rounding<Scalar>(8);
  CHECK(ratio(0.5) == doctest::Approx(4.0 / 3.0).epsilon(tolerance));
  CHECK(ratio(1.0) == doctest::Approx(16.0 / 15.0).epsilon(tolerance));
  CHECK(ratio(2.0) == doctest::Approx(64.0 / 63.0).epsilon(tolerance));
  CHECK(ratio(1e9) == doctest::Approx(1.0).epsilon(tolerance));
  CHECK(ratio(0.25) == 1.0);
  CHECK(ratio(0.1) == 1.0);
  CHECK(ratio(-1.0) == 1.0);
  CHECK(ratio(0.2501) > 100.0);  // next to the pole
}

TEST_CASE_TEMPLATE("Conyers: published values at L = 690 mm, R = 114.3 mm", Scalar, float, double) {
  const double printed_digits = 1e-4;
  CHECK(static_cast<double>(conyers<Scalar>(0.5)) == doctest::Approx(1.1404).epsilon(printed_digits));
  double lowest = 2.0, lowest_at = 0.0, highest = 0.0, highest_at = 0.0;
  for (int i = 100; i <= 600; ++i) {
    const double x = i / 100.0, value = static_cast<double>(conyers<Scalar>(x));
    if (x < 2.5 && value < lowest) lowest = value, lowest_at = x;
    if (x > 2.5 && value > highest) highest = value, highest_at = x;
  }
  CHECK(lowest == doctest::Approx(0.9922).epsilon(printed_digits));
  CHECK(lowest_at == doctest::Approx(1.49).epsilon(0.01));
  CHECK(highest == doctest::Approx(1.0542).epsilon(printed_digits));
  CHECK(highest_at == doctest::Approx(3.56).epsilon(0.01));
}

TEST_CASE_TEMPLATE("Conyers against the second formula, for other airframes too", Scalar, float, double) {
  for (const double scale : {1.0, 0.8, 1.1}) {
    pinnquad::Airframe<Scalar> airframe = airframe_690<Scalar>();
    for (auto& rotor : airframe.rotors) {
      rotor.x_m *= Scalar(scale);
      rotor.y_m *= Scalar(scale);
    }
    airframe.propeller_diameter_m *= Scalar(scale);
    for (int i = 26; i < 1000; i += 7) {
      const double x = i / 100.0;
      const double expected = plain::conyers(x, 690.0 * scale, 114.3 * scale);
      CAPTURE(x);
      CHECK(static_cast<double>(Conyers{}.thrust_ratio(Scalar(x), airframe)) ==
            doctest::Approx(expected).epsilon(conyers_tolerance<Scalar>));
    }
  }
}

TEST_CASE_TEMPLATE("Conyers holds from 0.25 to 10, ends included, and is 1 elsewhere", Scalar, float, double) {
  CHECK(conyers<Scalar>(0.25) != Scalar(1));
  CHECK(conyers<Scalar>(10.0) != Scalar(1));
  CHECK(conyers<Scalar>(0.2499) == Scalar(1));
  CHECK(conyers<Scalar>(10.01) == Scalar(1));
  CHECK(conyers<Scalar>(-0.5) == Scalar(1));
}

TEST_CASE_TEMPLATE("a height that is NaN is not turned into a ratio", Scalar, float, double) {
  const Scalar nan = std::numeric_limits<Scalar>::quiet_NaN();
  CHECK(std::isnan(CheesemanBennett{}.thrust_ratio(nan, airframe_690<Scalar>())));
  CHECK(std::isnan(Conyers{}.thrust_ratio(nan, airframe_690<Scalar>())));
}

TEST_CASE_TEMPLATE("the force: (r - 1) of the vertical part of rotors and drag, along body -z, no torque", Scalar,
                   float, double) {
  const pinnquad::Airframe<Scalar> airframe = airframe_690<Scalar>();
  pinnquad::test::RandomStates random(80);
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    AeroCondition<Scalar> condition;
    condition.attitude = random.attitude<Scalar>();
    condition.height_above_ground_m = random.scalar<Scalar>(0.05, 1.0);
    condition.rotors.force_N = {Scalar(0), Scalar(0), random.scalar<Scalar>(-20.0, 0.0)};
    condition.aerodynamic.force_N = random.vector<Scalar>(3.0);
    const Vector3<Scalar> before = condition.rotors.force_N + condition.aerodynamic.force_N;
    const double vertical = static_cast<double>(pinnquad::body_to_world(condition.attitude, before)[2]);
    const double x = static_cast<double>(condition.height_above_ground_m) / 0.1143;
    const Wrench<Scalar> wrench = pinnquad::CheesemanBennettGroundEffect{}.wrench(condition, airframe);
    const double expected = -(plain::cheeseman_bennett(x) - 1.0) * std::fabs(vertical);
    CHECK(wrench.force_N[0] == Scalar(0));
    CHECK(wrench.force_N[1] == Scalar(0));
    // the pole amplifies the rounding of x
    const double near_pole = x > 0.25 ? 1.0 + 1.0 / std::fabs(x - 0.25) : 1.0;
    CHECK(std::fabs(static_cast<double>(wrench.force_N[2]) - expected) <=
          pinnquad::test::rounding<Scalar>(50) * 20.0 * near_pole * (1.0 + std::fabs(expected)));
    CHECK(wrench.torque_N_m == Vector3<Scalar>(0, 0, 0));
  }
}

TEST_CASE_TEMPLATE("upside down the force still acts along body -z: the absolute value of the authors", Scalar, float,
                   double) {
  AeroCondition<Scalar> condition;
  condition.attitude = {Scalar(0), Scalar(1), Scalar(0), Scalar(0)};
  condition.height_above_ground_m = Scalar(0.5 * 0.1143);
  condition.rotors.force_N = {Scalar(0), Scalar(0), Scalar(-15)};
  const Wrench<Scalar> wrench = pinnquad::CheesemanBennettGroundEffect{}.wrench(condition, airframe_690<Scalar>());
  CHECK(static_cast<double>(wrench.force_N[2]) == doctest::Approx(-5.0).epsilon(1e-5));
}

TEST_CASE_TEMPLATE("bound to an airframe the effect gives the same force, bit by bit", Scalar, float, double) {
  const pinnquad::Airframe<Scalar> airframe = airframe_690<Scalar>();
  const auto bound = pinnquad::bound_effect(pinnquad::ConyersGroundEffect{}, airframe);
  pinnquad::test::RandomStates random(81);
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    AeroCondition<Scalar> condition;
    condition.attitude = random.attitude<Scalar>();
    condition.height_above_ground_m = random.scalar<Scalar>(-0.1, 1.3);
    condition.rotors.force_N = random.vector<Scalar>(20.0);
    CHECK(bound.wrench(condition, airframe).force_N ==
          pinnquad::ConyersGroundEffect{}.wrench(condition, airframe).force_N);
  }
  static_assert(pinnquad::uses_rotor_wrench<std::decay_t<decltype(bound)>>);
}

TEST_CASE("ground effect tells the inverse that it uses the rotors") {
  static_assert(pinnquad::uses_rotor_wrench<pinnquad::CheesemanBennettGroundEffect>);
  static_assert(pinnquad::uses_rotor_wrench<pinnquad::ConyersGroundEffect>);
  static_assert(pinnquad::makes_wrench<pinnquad::ConyersGroundEffect>);
  static_assert(!pinnquad::changes_surroundings<pinnquad::ConyersGroundEffect>);
  CHECK(true);
}
