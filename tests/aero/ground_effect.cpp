// SPDX-License-Identifier: MIT
#include "pinnquad/aero/ground_effect.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/racer_5_inch.hpp"
#include "support/plain_dynamics.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"

using pinnquad::CheesemanBennett;
using pinnquad::Conyers;
using pinnquad::RotorCondition;
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

TEST_CASE_TEMPLATE("Cheeseman-Bennett: closed form, and the ratio of Z/R 0.5 held below", Scalar, float, double) {
  const auto ratio = [](Scalar x) { return CheesemanBennett{}.thrust_ratio(x, airframe_690<Scalar>()); };
  const double tolerance = pinnquad::test::rounding<Scalar>(8);
  const auto near = [&](double x, double expected) {
    CHECK(static_cast<double>(ratio(Scalar(x))) == doctest::Approx(expected).epsilon(tolerance));
  };
  near(0.5, 4.0 / 3.0);
  near(1.0, 16.0 / 15.0);
  near(2.0, 64.0 / 63.0);
  near(1e9, 1.0);
  for (const double x : {0.4999, 0.3, 0.2512, 0.2501, 0.25, 0.2499, 0.1, 0.0, -1.0}) near(x, 4.0 / 3.0);
  CHECK(ratio(-std::numeric_limits<Scalar>::infinity()) == Scalar(4.0 / 3.0));
  CHECK(ratio(std::numeric_limits<Scalar>::infinity()) == Scalar(1));
  // no step anywhere, and never more lift higher up
  Scalar before = ratio(Scalar(-0.1));
  for (int i = -99; i <= 3000; ++i) {
    const Scalar now = ratio(Scalar(i * 1e-3));
    CHECK(now <= before);
    CHECK(before - now <= Scalar(2e-3));
    before = now;
  }
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

namespace {
/// An X frame with a diagonal and a propeller radius in mm.
template <class Scalar>
pinnquad::Airframe<Scalar> x_frame(double diagonal_mm, double radius_mm) {
  pinnquad::Airframe<Scalar> airframe = airframe_690<Scalar>();
  for (auto& rotor : airframe.rotors) {
    rotor.x_m *= Scalar(diagonal_mm / 690.0);
    rotor.y_m *= Scalar(diagonal_mm / 690.0);
  }
  airframe.propeller_diameter_m = Scalar(radius_mm * 0.002);
  return airframe;
}
}  // namespace

TEST_CASE_TEMPLATE("Conyers: L is the diagonal, in whatever order and place the motors are", Scalar, float, double) {
  using std::sqrt;
  const auto root = [](Scalar square) { return sqrt(square); };
  std::array<std::size_t, 4> order{0, 1, 2, 3};
  pinnquad::Airframe<Scalar> wide = airframe_690<Scalar>();  // front pair wider apart than the diagonals are long
  wide.rotors[0].x_m = wide.rotors[2].x_m = Scalar(0.05);
  wide.rotors[1].x_m = wide.rotors[3].x_m = Scalar(-0.1);
  wide.rotors[0].y_m = Scalar(0.2), wide.rotors[2].y_m = Scalar(-0.2);
  wide.rotors[3].y_m = Scalar(0.08), wide.rotors[1].y_m = Scalar(-0.08);
  do {
    pinnquad::Airframe<Scalar> square = airframe_690<Scalar>(), other = wide;
    for (std::size_t i = 0; i < 4; ++i) {
      square.rotors[i] = airframe_690<Scalar>().rotors[order[i]];
      other.rotors[i] = wide.rotors[order[i]];
    }
    CHECK(static_cast<double>(pinnquad::detail::motor_diagonal_m(square, root)) ==
          doctest::Approx(0.69).epsilon(pinnquad::test::rounding<Scalar>(8)));
    CHECK(static_cast<double>(pinnquad::detail::motor_diagonal_m(other, root)) ==
          doctest::Approx(sqrt(0.15 * 0.15 + 0.28 * 0.28)).epsilon(pinnquad::test::rounding<Scalar>(8)));
    CHECK(Conyers{}.thrust_ratio(Scalar(0.5), square) == conyers<Scalar>(0.5));
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("the root while compiling is the root") {
  for (const double value : {1e-12, 0.0025, 0.25, 0.4761, 1.0, 2.0, 1e6, 1e300}) {
    CHECK(pinnquad::detail::compiled_root(value) == doctest::Approx(std::sqrt(value)).epsilon(1e-15));
  }
  static_assert(pinnquad::detail::compiled_root(0.0) == 0.0);
}

TEST_CASE_TEMPLATE("Conyers: who is refused has a pole or an implausible ratio, who is taken has none", Scalar, float,
                   double) {
  // every frame of a grid, by the second formula at 1,000 heights
  int taken = 0, refused = 0;
  for (double diagonal = 100.0; diagonal <= 1000.0; diagonal += 30.0) {
    for (double radius = 30.0; radius <= 160.0; radius += 5.0) {
      CAPTURE(diagonal);
      CAPTURE(radius);
      double least = 1.0, most = 1.0;
      for (int i = 0; i <= 1000; ++i) {
        const double ratio = plain::conyers(0.25 + 9.75 * i / 1000.0, diagonal, radius);
        least = ratio < least ? ratio : least;
        most = ratio > most ? ratio : most;
      }
      const auto airframe = x_frame<Scalar>(diagonal, radius);
      const bool ok = Conyers{}.status(airframe) == pinnquad::Status::ok;
      CHECK((ok || Conyers{}.status(airframe) == pinnquad::Status::out_of_range));
      const double margin = 0.01;  // float's coefficients and the grids
      if (ok) CHECK((least >= Conyers::least_ratio - margin && most <= Conyers::most_ratio + margin));
      if (!ok) CHECK((least < Conyers::least_ratio + margin || most > Conyers::most_ratio - margin));
      ++(ok ? taken : refused);
    }
  }
  CHECK(taken > 100);
  CHECK(refused > 100);
}

TEST_CASE_TEMPLATE("Conyers: ordinary frames, taken and refused", Scalar, float, double) {
  const auto status = [](double diagonal, double radius) {
    return pinnquad::RotorGroundEffect<pinnquad::Conyers>{}.status(x_frame<Scalar>(diagonal, radius));
  };
  CHECK(status(690.0, 114.3) == pinnquad::Status::ok);
  CHECK(status(250.0, 63.5) == pinnquad::Status::ok);
  CHECK(status(92.0, 23.1) == pinnquad::Status::ok);
  CHECK(status(450.0, 127.0) == pinnquad::Status::out_of_range);
  CHECK(status(450.0, 114.3) == pinnquad::Status::out_of_range);
  CHECK(status(std::numeric_limits<double>::quiet_NaN(), 114.3) == pinnquad::Status::out_of_range);
  static_assert(pinnquad::GroundEffect<pinnquad::Conyers>{}.status(pinnquad::PaperQuadrotor::value<Scalar>()) ==
                pinnquad::Status::ok);
  static_assert(pinnquad::GroundEffect<pinnquad::Conyers>{}.status(pinnquad::Racer5Inch::value<Scalar>()) ==
                pinnquad::Status::ok);
  static_assert(pinnquad::GroundEffect<pinnquad::Conyers>{}.status(pinnquad::Crazyflie::value<Scalar>()) ==
                pinnquad::Status::ok);
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
    RotorCondition<Scalar> condition;
    condition.attitude = random.attitude<Scalar>();
    condition.height_above_ground_m = random.scalar<Scalar>(0.05, 1.0);
    condition.rotors.force_N = {Scalar(0), Scalar(0), random.scalar<Scalar>(-20.0, 0.0)};
    condition.aerodynamic.force_N = random.vector<Scalar>(3.0);
    const Vector3<Scalar> before = condition.rotors.force_N + condition.aerodynamic.force_N;
    const double vertical = static_cast<double>(pinnquad::body_to_world(condition.attitude, before)[2]);
    const double x = static_cast<double>(condition.height_above_ground_m) / 0.1143;
    const Wrench<Scalar> wrench = pinnquad::GroundEffect<pinnquad::CheesemanBennett>{}.wrench(condition, airframe);
    const double expected = -(plain::cheeseman_bennett(std::max(x, 0.5)) - 1.0) * std::fabs(vertical);
    CHECK(wrench.force_N[0] == Scalar(0));
    CHECK(wrench.force_N[1] == Scalar(0));
    CHECK(std::fabs(static_cast<double>(wrench.force_N[2]) - expected) <=
          pinnquad::test::rounding<Scalar>(50) * 20.0 * (1.0 + std::fabs(expected)));
    CHECK(wrench.torque_N_m == Vector3<Scalar>(0, 0, 0));
  }
}

TEST_CASE_TEMPLATE("upside down the force still acts along body -z: the absolute value of the authors", Scalar, float,
                   double) {
  RotorCondition<Scalar> condition;
  condition.attitude = {Scalar(0), Scalar(1), Scalar(0), Scalar(0)};
  condition.height_above_ground_m = Scalar(0.5 * 0.1143);
  condition.rotors.force_N = {Scalar(0), Scalar(0), Scalar(-15)};
  const Wrench<Scalar> wrench =
      pinnquad::GroundEffect<pinnquad::CheesemanBennett>{}.wrench(condition, airframe_690<Scalar>());
  CHECK(static_cast<double>(wrench.force_N[2]) == doctest::Approx(-5.0).epsilon(1e-5));
}

TEST_CASE_TEMPLATE("bound to an airframe the effect gives the same force, bit by bit", Scalar, float, double) {
  const pinnquad::Airframe<Scalar> airframe = airframe_690<Scalar>();
  const auto bound = pinnquad::detail::bound_effect(pinnquad::GroundEffect<pinnquad::Conyers>{}, airframe);
  pinnquad::test::RandomStates random(81);
  for (int draw = 0; draw < pinnquad::test::draws; ++draw) {
    RotorCondition<Scalar> condition;
    condition.attitude = random.attitude<Scalar>();
    condition.height_above_ground_m = random.scalar<Scalar>(-0.1, 1.3);
    condition.rotors.force_N = random.vector<Scalar>(20.0);
    CHECK(bound.wrench(condition, airframe).force_N ==
          pinnquad::GroundEffect<pinnquad::Conyers>{}.wrench(condition, airframe).force_N);
  }
  static_assert(pinnquad::uses_rotor_wrench<std::decay_t<decltype(bound)>>);
}

// ground effect tells the inverse that it uses the rotors
static_assert(pinnquad::uses_rotor_wrench<pinnquad::GroundEffect<pinnquad::CheesemanBennett>>);
static_assert(pinnquad::uses_rotor_wrench<pinnquad::GroundEffect<pinnquad::Conyers>>);
static_assert(pinnquad::makes_wrench<pinnquad::GroundEffect<pinnquad::Conyers>>);
static_assert(!pinnquad::changes_surroundings<pinnquad::GroundEffect<pinnquad::Conyers>>);
