// SPDX-License-Identifier: MIT
#include "pinnquad/dynamics/rotor.hpp"

#include "pinnquad/dynamics/actuator.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

template <class Scalar>
double distance_to_identity(const AllocationMatrix<Scalar>& a, const AllocationMatrix<Scalar>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 4; ++k) sum += static_cast<double>(a[i][k]) * static_cast<double>(b[k][j]);
      worst = std::max(worst, std::fabs(sum - (i == j ? 1.0 : 0.0)));
    }
  }
  return worst;
}

/// A valid airframe with rotors anywhere: no symmetry to hide behind.
template <class Scalar>
Airframe<Scalar> lopsided(RandomStates& random) {
  Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  const double quadrant[4][2] = {{1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
  for (std::size_t i = 0; i < 4; ++i) {
    airframe.rotors[i].x_m = Scalar(quadrant[i][0]) * random.scalar<Scalar>(0.1, 0.3);
    airframe.rotors[i].y_m = Scalar(quadrant[i][1]) * random.scalar<Scalar>(0.1, 0.3);
  }
  return airframe;
}

}  // namespace

TEST_CASE("Eq. (2): the sign pattern of the paper, in the paper's rotor order") {
  constexpr Airframe<double> airframe = pinnquad::PaperQuadrotor::value<double>();
  constexpr AllocationMatrix<double> matrix = pinnquad::allocation(airframe);
  const int expected[4][4] = {{1, 1, 1, 1}, {-1, 1, 1, -1}, {1, -1, 1, -1}, {1, 1, -1, -1}};
  const double thrust = airframe.max_rotor_thrust_N(), torque = airframe.max_rotor_torque_N_m();
  const double magnitude[4] = {thrust, 0.243952 * thrust, 0.243952 * thrust, torque};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(matrix[row][i] == doctest::Approx(expected[row][i] * magnitude[row]).epsilon(1e-14));
    }
  }
  CHECK(pinnquad::allocation_signs(airframe, pinnquad::Roll::axis) == std::array<double, 4>{-1, 1, 1, -1});
  CHECK(pinnquad::allocation_signs(airframe, pinnquad::Pitch::axis) == std::array<double, 4>{1, -1, 1, -1});
  CHECK(pinnquad::allocation_signs(airframe, pinnquad::Yaw::axis) == std::array<double, 4>{1, 1, -1, -1});
  CHECK(pinnquad::signed_sum<double>({-1, 1, 1, -1}, {0.1, 0.2, 0.4, 0.8}) == doctest::Approx(-0.3).epsilon(1e-15));
}

TEST_CASE("a rotor in the middle has no roll and pitch sign") {
  Airframe<double> airframe = pinnquad::PaperQuadrotor::value<double>();
  airframe.rotors[2] = {0.0, 0.0, Spin::clockwise};
  CHECK(pinnquad::allocation_signs(airframe, 0)[2] == 0.0);
  CHECK(pinnquad::allocation_signs(airframe, 1)[2] == 0.0);
  CHECK(pinnquad::allocation_signs(airframe, 2)[2] == -1.0);
}

TEST_CASE_TEMPLATE("wrench against position x force, rotor by rotor", Scalar, float, double) {
  RandomStates random(30);
  for (int draw = 0; draw < draws; ++draw) {
    const Airframe<Scalar> airframe = lopsided<Scalar>(random);
    const Commands<Scalar> u = random.commands<Scalar>();
    const Scalar density_ratio = random.scalar<Scalar>(0.5, 1.1);
    pinnquad::Vector3<Scalar> force = pinnquad::Vector3<Scalar>::Zero(), torque = pinnquad::Vector3<Scalar>::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      const pinnquad::RotorMount<Scalar>& rotor = airframe.rotors[i];
      const pinnquad::Vector3<Scalar> lift(0, 0, -u[i] * airframe.max_rotor_thrust_N() * density_ratio);
      force += lift;
      torque += pinnquad::cross<Scalar>(pinnquad::Vector3<Scalar>(rotor.x_m, rotor.y_m, 0), lift);
      const Scalar drag = u[i] * airframe.max_rotor_torque_N_m() * density_ratio;
      torque[2] += rotor.spin == Spin::counter_clockwise ? drag : -drag;
    }
    const Wrench<Scalar> wrench = Rotors<Scalar>(airframe).wrench(u, density_ratio);
    CHECK(pinnquad::test::relative_distance(wrench.force_N, force) <= pinnquad::test::evaluation_tolerance<Scalar>);
    CHECK(pinnquad::test::relative_distance(wrench.torque_N_m, torque, 1.0) <=
          pinnquad::test::evaluation_tolerance<Scalar>);
  }
}

TEST_CASE("a matrix whose diagonal is zero needs its rows exchanged") {
  AllocationMatrix<double> matrix{};
  matrix[0] = {0, 2, 0, 0};
  matrix[1] = {0, 0, 0, 3};
  matrix[2] = {4, 0, 0, 0};
  matrix[3] = {0, 0, 5, 0};
  AllocationMatrix<double> inverse{};
  REQUIRE(pinnquad::invert_allocation(matrix, inverse) == Status::ok);
  CHECK(distance_to_identity(matrix, inverse) <= pinnquad::test::rounding<double>(4));
}

TEST_CASE_TEMPLATE("commands invert wrench, at any density", Scalar, float, double) {
  RandomStates random(32);
  for (int draw = 0; draw < draws; ++draw) {
    const Rotors<Scalar> rotors(lopsided<Scalar>(random));
    REQUIRE(rotors.status() == Status::ok);
    const Scalar density_ratio = random.scalar<Scalar>(0.5, 1.1);
    const Commands<Scalar> u = random.commands<Scalar>(-0.5, 1.5);  // neither direction clips
    CHECK(pinnquad::test::distance(rotors.commands(rotors.wrench(u, density_ratio), density_ratio), u) <=
          pinnquad::test::inverse_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("commands ignore the lateral force of a wrench", Scalar, float, double) {
  const Rotors<Scalar> rotors(pinnquad::PaperQuadrotor::value<Scalar>());
  Wrench<Scalar> wrench = rotors.wrench({Scalar(0.4), Scalar(0.5), Scalar(0.6), Scalar(0.7)}, Scalar(1));
  const Commands<Scalar> before = rotors.commands(wrench, Scalar(1));
  wrench.force_N[0] = Scalar(7);
  wrench.force_N[1] = Scalar(-7);
  CHECK(rotors.commands(wrench, Scalar(1)) == before);
}

namespace {

template <class Scalar>
Airframe<Scalar> all_one_way() {
  Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  for (auto& rotor : airframe.rotors) rotor.spin = Spin::clockwise;
  return airframe;
}

template <class Scalar>
Airframe<Scalar> on_a_line(Scalar angle) {
  Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  const Scalar along[4] = {Scalar(0.31), Scalar(-0.17), Scalar(0.12), Scalar(-0.29)};
  for (std::size_t i = 0; i < 4; ++i) {
    airframe.rotors[i].x_m = along[i] * std::cos(angle);
    airframe.rotors[i].y_m = along[i] * std::sin(angle);
  }
  return airframe;
}

}  // namespace

TEST_CASE_TEMPLATE("an allocation that can't be inverted is refused and the output stays", Scalar, float, double) {
  AllocationMatrix<Scalar> untouched{};
  untouched[1][2] = Scalar(42);
  const auto refused = [&](const Airframe<Scalar>& airframe) {
    AllocationMatrix<Scalar> inverse = untouched;
    const Status status = pinnquad::invert_allocation(pinnquad::allocation(airframe), inverse);
    return status == Status::no_solution && inverse == untouched && Rotors<Scalar>(airframe).status() != Status::ok;
  };
  CHECK(refused(on_a_line<Scalar>(Scalar(0))));
  CHECK(refused(Airframe<Scalar>{}));
  const Scalar nan = std::numeric_limits<Scalar>::quiet_NaN(), infinite = std::numeric_limits<Scalar>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    for (const Scalar bad : {nan, infinite}) {
      CAPTURE(i);
      CAPTURE(bad);
      Airframe<Scalar> broken = pinnquad::PaperQuadrotor::value<Scalar>();
      broken.rotors[i].x_m = bad;
      CHECK(refused(broken));
      broken = pinnquad::PaperQuadrotor::value<Scalar>();
      broken.rotors[i].y_m = bad;
      CHECK(refused(broken));
    }
  }
}

TEST_CASE_TEMPLATE("an allocation that is singular up to rounding is refused", Scalar, float, double) {
  CHECK(Rotors<Scalar>(all_one_way<Scalar>()).status() == Status::no_solution);
  Airframe<Scalar> same_place = pinnquad::PaperQuadrotor::value<Scalar>();
  same_place.rotors[1] = same_place.rotors[0];
  CHECK(Rotors<Scalar>(same_place).status() == Status::no_solution);
  for (int degrees = 0; degrees < 180; degrees += 7) {
    CAPTURE(degrees);
    CHECK(Rotors<Scalar>(on_a_line<Scalar>(Scalar(degrees) * Scalar(0.0174532925))).status() == Status::no_solution);
  }
}

TEST_CASE_TEMPLATE("command and rotor speed: square, inverse, limits", Scalar, float, double) {
  const Airframe<Scalar> airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  CHECK(pinnquad::command_from_speed(airframe, airframe.max_rotor_speed_rev_s) == Scalar(1));
  CHECK(pinnquad::command_from_speed(airframe, airframe.max_rotor_speed_rev_s / Scalar(2)) == Scalar(0.25));
  CHECK(pinnquad::speed_from_command(airframe, Scalar(0)) == Scalar(0));
  RandomStates random(33);
  for (int draw = 0; draw < draws; ++draw) {
    const Scalar u = random.scalar<Scalar>(0.0, 1.0);
    const Scalar again = pinnquad::command_from_speed(airframe, pinnquad::speed_from_command(airframe, u));
    CHECK(std::fabs(static_cast<double>(again - u)) <= pinnquad::test::rounding<Scalar>(4));
  }
  // Eq. (2): thrust = c_T n^2
  const Scalar n = Scalar(100);
  const Commands<Scalar> u{pinnquad::command_from_speed(airframe, n), Scalar(0), Scalar(0), Scalar(0)};
  const double thrust = -static_cast<double>(Rotors<Scalar>(airframe).wrench(u, Scalar(1)).force_N[2]);
  CHECK(thrust == doctest::Approx(static_cast<double>(airframe.dimensional_thrust_coefficient()) * 1e4)
                      .epsilon(pinnquad::test::rounding<Scalar>(8)));
}

TEST_CASE_TEMPLATE("clip_command: limits, and NaN stays NaN", Scalar, float, double) {
  using Limits = std::numeric_limits<Scalar>;
  CHECK(pinnquad::clip_command(Scalar(-0.1)) == Scalar(0));
  CHECK(pinnquad::clip_command(Scalar(0)) == Scalar(0));
  CHECK(pinnquad::clip_command(Scalar(0.3)) == Scalar(0.3));
  CHECK(pinnquad::clip_command(Scalar(1)) == Scalar(1));
  CHECK(pinnquad::clip_command(Scalar(1.1)) == Scalar(1));
  CHECK(pinnquad::clip_command(Limits::infinity()) == Scalar(1));
  CHECK(pinnquad::clip_command(-Limits::infinity()) == Scalar(0));
  CHECK(std::isnan(pinnquad::clip_command(Limits::quiet_NaN())));
}

TEST_CASE_TEMPLATE("rotor lag: the closed form, in one step or in many", Scalar, float, double) {
  const Scalar tau = Scalar(0.005);
  CHECK(pinnquad::lag_factor(Scalar(0), Scalar(0.001)) == Scalar(0));  // no lag
  CHECK(pinnquad::lag_factor(tau, Scalar(0)) == Scalar(1));            // no time
  CHECK(static_cast<double>(pinnquad::lag_factor(tau, tau)) ==
        doctest::Approx(std::exp(-1.0)).epsilon(pinnquad::test::rounding<Scalar>(4)));
  RandomStates random(34);
  for (int draw = 0; draw < draws; ++draw) {
    const Commands<Scalar> start = random.commands<Scalar>(), target = random.commands<Scalar>();
    const int parts = 1 + draw % 16;
    const Scalar step = Scalar(0.004);
    Commands<Scalar> many = start;
    for (int i = 0; i < parts; ++i)
      many = pinnquad::lagged(many, target, pinnquad::lag_factor(tau, step / Scalar(parts)));
    const Commands<Scalar> one = pinnquad::lagged(start, target, pinnquad::lag_factor(tau, step));
    CHECK(pinnquad::test::distance(many, one) <= pinnquad::test::rounding<Scalar>(4.0 * parts));
    for (std::size_t i = 0; i < 4; ++i) {
      const double exact = static_cast<double>(target[i]) +
                           (static_cast<double>(start[i]) - static_cast<double>(target[i])) * std::exp(-0.004 / 0.005);
      CHECK(std::fabs(static_cast<double>(one[i]) - exact) <= pinnquad::test::rounding<Scalar>(8));
    }
  }
}

TEST_CASE_TEMPLATE("rotor lag clips the command and keeps NaN", Scalar, float, double) {
  const Commands<Scalar> filtered{Scalar(0.5), Scalar(0.5), Scalar(0.5), Scalar(0.5)};
  const Scalar nan = std::numeric_limits<Scalar>::quiet_NaN();
  const Commands<Scalar> result =
      pinnquad::lagged<Scalar>(filtered, {Scalar(7), Scalar(-7), Scalar(0.5), nan}, Scalar(0));
  CHECK(result[0] == Scalar(1));
  CHECK(result[1] == Scalar(0));
  CHECK(result[2] == Scalar(0.5));
  CHECK(std::isnan(result[3]));
}
