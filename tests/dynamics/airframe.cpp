// SPDX-License-Identifier: MIT
#include "pinnquad/dynamics/airframe.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/px4_sih.hpp"
#include "pinnquad/dynamics/airframes/racer_5_inch.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"

using namespace pinnquad;

namespace {

template <class Scalar>
using Field = std::pair<std::string, std::function<Scalar&(Airframe<Scalar>&)>>;

/// Fields that must be positive.
template <class Scalar>
std::vector<Field<Scalar>> positive_fields() {
  using A = Airframe<Scalar>;
  return {{"mass", [](A& a) -> Scalar& { return a.mass_kg; }},
          {"Jx", [](A& a) -> Scalar& { return a.inertia_kg_m2[0]; }},
          {"Jy", [](A& a) -> Scalar& { return a.inertia_kg_m2[1]; }},
          {"Jz", [](A& a) -> Scalar& { return a.inertia_kg_m2[2]; }},
          {"thrust coefficient", [](A& a) -> Scalar& { return a.thrust_coefficient; }},
          {"power coefficient", [](A& a) -> Scalar& { return a.power_coefficient; }},
          {"propeller diameter", [](A& a) -> Scalar& { return a.propeller_diameter_m; }},
          {"rotor speed", [](A& a) -> Scalar& { return a.max_rotor_speed_rev_s; }}};
}

/// Fields that may be zero but not negative.
template <class Scalar>
std::vector<Field<Scalar>> non_negative_fields() {
  using A = Airframe<Scalar>;
  return {{"time constant", [](A& a) -> Scalar& { return a.rotor_time_constant_s; }},
          {"drag x", [](A& a) -> Scalar& { return a.drag_area_m2[0]; }},
          {"drag y", [](A& a) -> Scalar& { return a.drag_area_m2[1]; }},
          {"drag z", [](A& a) -> Scalar& { return a.drag_area_m2[2]; }},
          {"deadband", [](A& a) -> Scalar& { return a.drag_deadband_m_s; }}};
}

}  // namespace

TEST_CASE_TEMPLATE("the airframes of the library are valid", Scalar, float, double) {
  CHECK(check_airframe(pinnquad::airframe_value<pinnquad::PaperQuadrotor, Scalar>()) == Status::ok);
  CHECK(check_airframe(pinnquad::airframe_value<pinnquad::ReferenceQuadrotor15, Scalar>()) == Status::ok);
  CHECK(check_airframe(pinnquad::airframe_value<pinnquad::ReferenceQuadrotor10, Scalar>()) == Status::ok);
  CHECK(check_airframe(pinnquad::airframe_value<pinnquad::Racer5Inch, Scalar>()) == Status::ok);
  CHECK(check_airframe(pinnquad::airframe_value<pinnquad::Crazyflie, Scalar>()) == Status::ok);
  CHECK(check_airframe(pinnquad::airframe_value<pinnquad::Px4Sih, Scalar>()) == Status::ok);
}

TEST_CASE_TEMPLATE("check_airframe refuses each bad field", Scalar, float, double) {
  const Airframe<Scalar> good = pinnquad::PaperQuadrotor::value<Scalar>();
  const Scalar nan = std::numeric_limits<Scalar>::quiet_NaN(), inf = std::numeric_limits<Scalar>::infinity();
  for (const auto& [label, field] : positive_fields<Scalar>()) {
    const std::string name = label;  // a structured binding can't be captured in C++17
    for (const Scalar bad : {Scalar(0), Scalar(-1), nan, inf}) {
      CAPTURE(name);
      CAPTURE(bad);
      Airframe<Scalar> airframe = good;
      field(airframe) = bad;
      CHECK(check_airframe(airframe) == Status::invalid_airframe);
    }
  }
  for (const auto& [label, field] : non_negative_fields<Scalar>()) {
    const std::string name = label;
    CAPTURE(name);
    Airframe<Scalar> airframe = good;
    field(airframe) = Scalar(0);
    CHECK(check_airframe(airframe) == Status::ok);
    for (const Scalar bad : {Scalar(-1), nan, inf}) {
      CAPTURE(bad);
      field(airframe) = bad;
      CHECK(check_airframe(airframe) == Status::invalid_airframe);
    }
  }
}

TEST_CASE_TEMPLATE("an inertia that no body has: the triangle inequality, each side", Scalar, float, double) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
    airframe.inertia_kg_m2 = {Scalar(0.01), Scalar(0.01), Scalar(0.01)};
    airframe.inertia_kg_m2[axis] = Scalar(0.0199);
    CHECK(check_airframe(airframe) == Status::ok);
    airframe.inertia_kg_m2[axis] = Scalar(0.0201);
    CHECK(check_airframe(airframe) == Status::invalid_airframe);
  }
}

TEST_CASE_TEMPLATE("too heavy to hover is refused, just light enough is not", Scalar, float, double) {
  Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  const Scalar heaviest = airframe.mass_kg * airframe.thrust_to_weight();
  airframe.mass_kg = heaviest * Scalar(1.001);
  CHECK(check_airframe(airframe) == Status::invalid_airframe);
  airframe.mass_kg = heaviest * Scalar(0.999);
  CHECK(check_airframe(airframe) == Status::ok);
}

TEST_CASE("thrust-to-weight is of what the rotors are, each by its own thrust") {
  Airframe<double> airframe = pinnquad::PaperQuadrotor::value<double>();
  const double plain = airframe.thrust_to_weight();
  airframe.rotors[2].thrust_scale = 0.6;
  CHECK(airframe.thrust_to_weight() == doctest::Approx(plain * 3.6 / 4));
}

TEST_CASE("Table 1 and the simulator: coefficients, limits, thrust-to-weight") {
  const Airframe<double> reference = pinnquad::ReferenceQuadrotor15::value<double>();
  // printed by the running simulator in float32: seven digits
  const double printed_digits = 1e-6;
  CHECK(reference.max_rotor_thrust_N() == doctest::Approx(4.179446).epsilon(printed_digits));
  CHECK(reference.max_rotor_torque_N_m() == doctest::Approx(0.0555622).epsilon(printed_digits));
  CHECK(reference.thrust_to_weight() == doctest::Approx(1.1365).epsilon(1e-4));  // docs/paper.md, deviation 7: 1.137
  CHECK(pinnquad::ReferenceQuadrotor10::value<double>().mass_kg == 1.0);

  const Airframe<double> paper = pinnquad::PaperQuadrotor::value<double>();
  CHECK(paper.mass_kg == 1.5);
  CHECK(paper.inertia_kg_m2[0] == 1.469e-2);
  CHECK(paper.inertia_kg_m2[1] == 1.686e-2);
  CHECK(paper.inertia_kg_m2[2] == 3.093e-2);
  CHECK(paper.thrust_coefficient == 0.1099);
  CHECK(paper.power_coefficient == 0.04016);
  CHECK(paper.propeller_diameter_m == 0.2286);
  CHECK(1.0 / paper.thrust_to_weight() == doctest::Approx(0.498).epsilon(5e-3));  // hovers at command 0.50
  // c_T and c_Q of Eq. (2): thrust and torque at 100 rev/s
  CHECK(paper.dimensional_thrust_coefficient() * 1e4 ==
        doctest::Approx(0.1099 * 1.225 * 1e4 * 0.2286 * 0.2286 * 0.2286 * 0.2286).epsilon(1e-12));
  CHECK(paper.dimensional_torque_coefficient() / paper.dimensional_thrust_coefficient() ==
        doctest::Approx(0.04016 * 0.2286 / (2.0 * 3.14159265358979 * 0.1099)).epsilon(1e-12));
}

TEST_CASE("the arm is half the diagonal motor spacing over sqrt(2)") {
  const Airframe<double> paper = pinnquad::PaperQuadrotor::value<double>();
  for (const pinnquad::RotorMount<double>& rotor : paper.rotors) {
    CHECK(std::hypot(rotor.x_m, rotor.y_m) == doctest::Approx(0.345).epsilon(1e-5));
    CHECK(std::fabs(rotor.x_m) == std::fabs(rotor.y_m));
  }
}

namespace {

/// Values of an airframe's sources, in the sources' units.
struct Published {
  double mass_kg, jx, jy, jz, forward_m, right_m;
  double newton_per_rad_s_squared, newton_metre_per_rad_s_squared, max_rad_s, time_constant_s;
  double drag_newton[3],
      drag_speed_m_s;  ///< forward, right and down at that speed, with the precision that two digits leave
  double propeller_diameter_m, thrust_to_weight;
};

void check_published(const Airframe<double>& a, const Published& source, double drag_digits) {
  constexpr double rounding = 1e-12, two_pi = 6.283185307179586;
  CHECK(a.mass_kg == source.mass_kg);
  CHECK(a.inertia_kg_m2[0] == source.jx);
  CHECK(a.inertia_kg_m2[1] == source.jy);
  CHECK(a.inertia_kg_m2[2] == source.jz);
  CHECK(pinnquad::has_diagonal_inertia(a));
  // front right and rear left turn counter-clockwise, front left and rear right clockwise
  const double sides[4][2] = {{1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
  for (std::size_t i = 0; i < 4; ++i) {
    CAPTURE(i);
    CHECK(a.rotors[i].x_m == doctest::Approx(sides[i][0] * source.forward_m).epsilon(rounding));
    CHECK(a.rotors[i].y_m == doctest::Approx(sides[i][1] * source.right_m).epsilon(rounding));
    CHECK(a.rotors[i].z_m == 0);
    CHECK(a.rotors[i].spin == (i < 2 ? pinnquad::Spin::counter_clockwise : pinnquad::Spin::clockwise));
    CHECK(a.rise_time_constant_s(i) == source.time_constant_s);
    CHECK(a.fall_time_constant_s(i) == source.time_constant_s);
  }
  CHECK(a.propeller_diameter_m == doctest::Approx(source.propeller_diameter_m).epsilon(rounding));
  CHECK(a.max_rotor_speed_rev_s == doctest::Approx(source.max_rad_s / two_pi).epsilon(rounding));
  const double square = source.max_rad_s * source.max_rad_s;
  CHECK(a.max_rotor_thrust_N() == doctest::Approx(source.newton_per_rad_s_squared * square).epsilon(rounding));
  CHECK(a.max_rotor_torque_N_m() == doctest::Approx(source.newton_metre_per_rad_s_squared * square).epsilon(rounding));
  CHECK(a.thrust_to_weight() == doctest::Approx(source.thrust_to_weight).epsilon(0.01));
  const double speed = source.drag_speed_m_s;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CHECK(a.drag_area_m2[axis] * 1.225 * speed * speed ==
          doctest::Approx(source.drag_newton[axis]).epsilon(drag_digits));
  }
  CHECK(a.drag_deadband_m_s == 0);
}

}  // namespace

TEST_CASE("racer_5_inch: each number as its source has it") {
  constexpr double thrust = 1.562522e-6, torque_over_thrust_m = 0.022, speed = 8;
  check_published(pinnquad::Racer5Inch::value<double>(),
                  {0.752,
                   2.5e-3,
                   2.1e-3,
                   4.3e-3,
                   0.075,
                   0.10,
                   thrust,
                   torque_over_thrust_m * thrust,
                   2333,
                   0.033,
                   {0.26 * speed, 0.28 * speed, 0.42 * speed},
                   speed,
                   5 * 0.0254,
                   4.6},
                  0.002);
}

TEST_CASE("px4_sih: each number as PX4's parameters have it") {
  constexpr double full_rad_s = 100 * 6.283185307179586, square = full_rad_s * full_rad_s;
  check_published(
      pinnquad::Px4Sih::value<double>(),
      {1.0, 0.025, 0.025, 0.030, 0.2, 0.2, 5.0 / square, 0.1 / square, full_rad_s, 0.05, {0, 0, 0}, 1, 0.25, 2.0394},
      0.002);
}

TEST_CASE("crazyflie_2_1: each number as its sources have it") {
  constexpr double rpm = 6.283185307179586 / 60, hover_N = 0.027 * 9.80665, speed = 3;
  constexpr double thrust = 3.16e-10 / (rpm * rpm), torque = 7.94e-12 / (rpm * rpm);
  const double rotors_rad_s = 4 * std::sqrt(hover_N / 4 / thrust), arm = 0.092 / 2 / std::sqrt(2.0);
  check_published(
      pinnquad::Crazyflie::value<double>(),
      {0.027,
       1.4e-5,
       1.4e-5,
       2.17e-5,
       arm,
       arm,
       thrust,
       torque,
       21709 * rpm,
       0.06,
       {9.1785e-7 * rotors_rad_s * speed, 9.1785e-7 * rotors_rad_s * speed, 10.311e-7 * rotors_rad_s * speed},
       speed,
       2 * 23.1348e-3,
       2.25},
      0.005);
}

namespace {
struct NotAnAirframe {};
struct WithoutName {
  template <class Scalar>
  static constexpr Airframe<Scalar> value() {
    return {};
  }
};
struct ReturnsSomethingElse {
  static constexpr const char* name = "something else";
  template <class Scalar>
  static constexpr Scalar value() {
    return {};
  }
};

// the contract of an airframe
static_assert(pinnquad::is_airframe<pinnquad::PaperQuadrotor>);
static_assert(!pinnquad::is_airframe<NotAnAirframe>);
static_assert(!pinnquad::is_airframe<WithoutName>);
static_assert(!pinnquad::is_airframe<ReturnsSomethingElse>);
static_assert(check_airframe(pinnquad::PaperQuadrotor::value<float>()) == Status::ok, "an airframe is a literal type");
}  // namespace
