// SPDX-License-Identifier: MIT
// Desaturation: thrust gives way first, then yaw, then roll and pitch.
#include "pinnquad/control/desaturate.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/uneven_airframe.hpp"

using pinnquad::Commands;
using pinnquad::desaturate;
using pinnquad::saturated;

namespace {

bool same(const Commands<double>& a, const Commands<double>& b) {
  constexpr double rounding = 1e-15;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!(a[i] - b[i] <= rounding && b[i] - a[i] <= rounding)) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("commands that fit stay, others shift together") {
  const pinnquad::Rotors<double> rotors(pinnquad::PaperQuadrotor::value<double>());
  CHECK(desaturate(rotors, {0.1, 0.9, 0.5, 1.0}) == Commands<double>{0.1, 0.9, 0.5, 1.0});
  CHECK(same(desaturate(rotors, {0.9, 1.2, 0.8, 1.0}), {0.7, 1.0, 0.6, 0.8}));
  CHECK(same(desaturate(rotors, {-0.2, 0.1, 0.3, 0.0}), {0.0, 0.3, 0.5, 0.2}));
}

TEST_CASE("a spread that no thrust carries makes no more yaw than asked") {
  const pinnquad::Rotors<double> rotors(pinnquad::PaperQuadrotor::value<double>());
  // 1.8 between rotors that turn alike: pitch alone is more than they have; yaw asked for is u1 + u2 - u3 - u4 = 0.2
  const Commands<double> wanted{1.5, -0.3, 0.9, 0.1};
  const Commands<double> given = desaturate(rotors, wanted);
  const double asked = rotors.wrench(wanted, 1.0).torque_N_m[2],
               made = rotors.wrench(pinnquad::clipped(given), 1.0).torque_N_m[2];
  CHECK(made / asked >= 0);
  CHECK(made / asked <= 1 + 1e-12);
}

TEST_CASE("saturated: a rotor at its end, or NaN") {
  CHECK(!saturated(Commands<float>{0.1f, 0.2f, 0.3f, 0.99f}));
  CHECK(saturated(Commands<float>{0.0f, 0.2f, 0.3f, 0.4f}));
  CHECK(saturated(Commands<float>{0.1f, 0.2f, 0.3f, 1.0f}));
  CHECK(saturated(Commands<float>{0.1f, 0.2f, std::numeric_limits<float>::quiet_NaN(), 0.5f}));
}

TEST_CASE("uneven rotors keep their torque when a command leaves 0..1, and thrust gives way") {
  const pinnquad::Airframe<double> a = pinnquad::test::uneven_airframe<double>();
  const pinnquad::Rotors<double> rotors(a);
  for (const pinnquad::Commands<double>& wanted :
       {pinnquad::Commands<double>{1.1, 0.8, 0.9, 1.05}, pinnquad::Commands<double>{0.2, -0.1, 0.1, 0.3}}) {
    const pinnquad::Commands<double> given = desaturate(rotors, wanted);
    const pinnquad::Vector3<double> before = rotors.wrench(wanted, 1.0).torque_N_m,
                                    after = rotors.wrench(given, 1.0).torque_N_m;
    for (int axis = 0; axis < 3; ++axis) CHECK(after[axis] == doctest::Approx(before[axis]).epsilon(1e-12));
    double largest = given[0], smallest = given[0];
    for (const double u : given) {
      largest = u > largest ? u : largest;
      smallest = u < smallest ? u : smallest;
    }
    CHECK(largest <= 1 + 1e-12);
    CHECK(smallest >= -1e-12);
    CHECK((largest >= 1 - 1e-12 || smallest <= 1e-7));  // a quadratic curve at nothing: the root of the rounding
  }
}

TEST_CASE("a rotor that has no part in pure thrust does not drive the others to their ends") {
  pinnquad::Airframe<double> a = pinnquad::PaperQuadrotor::value<double>();
  // centre of gravity half way to rotor 1: pure thrust is (1/2, 0, 1/4, 1/4)
  const double half = a.rotors[0].x_m * (0.5 - 1e-6);
  for (auto& r : a.rotors) r.x_m -= half, r.y_m -= half;
  const pinnquad::Rotors<double> rotors(a);
  REQUIRE(std::abs(rotors.fractions_of_pure_thrust_1_N()[1]) < 1e-6);
  const Commands<double> u{0.5, -0.01, 0.3, 0.3};
  CHECK(same(desaturate(rotors, u), {0.5, 0.0, 0.3, 0.3}));
}

namespace {

/// The paper's quadrotor with its centre of gravity 2 cm ahead of the rotors' middle.
pinnquad::Airframe<double> nose_heavy() {
  pinnquad::Airframe<double> a = pinnquad::PaperQuadrotor::value<double>();
  for (auto& r : a.rotors) r.x_m -= 0.02;
  return a;
}

constexpr double turning_on = 0.02;
constexpr double rounding = 1e-9;

}  // namespace

TEST_CASE("within a range: what torque can be had is had, in its direction, whatever gives way") {
  for (const pinnquad::Airframe<double>& a :
       {nose_heavy(), pinnquad::test::uneven_airframe<double>(), pinnquad::PaperQuadrotor::value<double>()}) {
    const pinnquad::Rotors<double> rotors(a);
    std::mt19937_64 engine(8);
    int thrust_gave = 0, yaw_gave = 0, tilt_gave = 0;
    for (int i = 0; i < 20'000; ++i) {
      Commands<double> wanted{};
      for (double& u : wanted) u = pinnquad::uniform(engine, 0.0, 1.15);
      const Commands<double> given = desaturate(rotors, wanted, turning_on);
      for (const double u : given) REQUIRE((u >= turning_on && u <= 1));
      const pinnquad::Wrench<double> before = rotors.wrench(wanted, 1.0), after = rotors.wrench(given, 1.0);
      const auto &w = before.torque_N_m, &g = after.torque_N_m;
      const bool same_tilt = std::abs(w[0] - g[0]) <= rounding && std::abs(w[1] - g[1]) <= rounding;
      const bool same_yaw = std::abs(w[2] - g[2]) <= rounding;
      REQUIRE((same_yaw || w[2] * g[2] >= -rounding));
      REQUIRE(std::abs(g[2]) <= std::abs(w[2]) + rounding);
      REQUIRE(std::abs(w[0] * g[1] - w[1] * g[0]) <= rounding);  // the axis about which it tilts
      REQUIRE(w[0] * g[0] + w[1] * g[1] >= -rounding);
      thrust_gave += same_tilt && same_yaw && std::abs(before.force_N[2] - after.force_N[2]) > rounding;
      yaw_gave += same_tilt && !same_yaw;
      tilt_gave += !same_tilt;
    }
    CHECK(thrust_gave > 100);
    CHECK(yaw_gave > 100);
    MESSAGE("thrust gave way ", thrust_gave, ", yaw ", yaw_gave, ", roll and pitch ", tilt_gave, " times");
  }
}

TEST_CASE("commands within the range stay, to the bit; a floor does not turn the vehicle") {
  const pinnquad::Airframe<double> a = nose_heavy();
  const pinnquad::Rotors<double> rotors(a);
  const Commands<double> fits{0.02, 1.0, 0.3, 0.7};
  CHECK(desaturate(rotors, fits, turning_on) == fits);
  // nearly no thrust asked for: the floor under each rotor alone would pitch the nose by several rad/s^2
  pinnquad::Wrench<double> falling;
  falling.force_N[2] = -0.3;
  const Commands<double> wanted = rotors.commands(falling, 1.0);
  Commands<double> clipped_alone = wanted;
  for (double& u : clipped_alone) u = std::max(u, 0.02);
  const auto pitch_rad_s2 = [&](const Commands<double>& u) {
    return rotors.wrench(u, 1.0).torque_N_m[1] / a.inertia_kg_m2[1];
  };
  CHECK(std::abs(pitch_rad_s2(clipped_alone)) > 0.3);
  CHECK(std::abs(pitch_rad_s2(desaturate(rotors, wanted, turning_on))) <= 1e-9);
}

namespace {

/// The law once more, from the rotors' ends alone: of all (tilt share, yaw share, thrust step) at which three of the
/// constraints hold with equality and none is broken, the one with the greatest tilt share, then the greatest yaw
/// share.
struct Best {
  double tilt{-1};
  double yaw{-1};
};

Best best_by_vertices(const pinnquad::Rotors<double>& rotors, const Commands<double>& wanted, double lower_command) {
  const pinnquad::Wrench<double> asked = rotors.wrench(wanted, 1.0);
  const auto made_by = [&](double thrust_N, double roll, double pitch, double yaw) {
    pinnquad::Wrench<double> w;
    w.force_N[2] = -thrust_N;
    w.torque_N_m = {roll, pitch, yaw};
    return rotors.fractions_for(w, 1.0);
  };
  const auto tilt = made_by(0, asked.torque_N_m[0], asked.torque_N_m[1], 0),
             yaw = made_by(0, 0, 0, asked.torque_N_m[2]), along = made_by(1, 0, 0, 0);
  const auto lower = rotors.fractions({lower_command, lower_command, lower_command, lower_command}),
             upper = rotors.fractions({1.0, 1.0, 1.0, 1.0});
  constexpr int rows = 12;
  Eigen::Matrix<double, rows, 3> left = Eigen::Matrix<double, rows, 3>::Zero();
  Eigen::Matrix<double, rows, 1> right;
  for (int i = 0; i < 4; ++i) {
    const auto k = static_cast<std::size_t>(i);
    left.row(i) << tilt[k], yaw[k], along[k];
    left.row(4 + i) = -left.row(i);
    right[i] = upper[k];
    right[4 + i] = -lower[k];
  }
  left(8, 0) = left(9, 1) = 1;
  left(10, 0) = left(11, 1) = -1;
  right.tail(4) << 1, 1, 0, 0;
  constexpr double slack = 1e-9;
  Best best;
  for (int i = 0; i < rows; ++i) {
    for (int j = i + 1; j < rows; ++j) {
      for (int k = j + 1; k < rows; ++k) {
        Eigen::Matrix3d m;
        m << left.row(i), left.row(j), left.row(k);
        const Eigen::FullPivLU<Eigen::Matrix3d> solver(m);
        if (!solver.isInvertible()) continue;
        const Eigen::Vector3d at = solver.solve(Eigen::Vector3d(right[i], right[j], right[k]));
        if (((left * at - right).array() > slack).any()) continue;
        if (at[0] > best.tilt + slack || (at[0] > best.tilt - slack && at[1] > best.yaw)) best = {at[0], at[1]};
      }
    }
  }
  return best;
}

}  // namespace

TEST_CASE("no law of this order gives more torque: the vertices of the same linear program agree") {
  constexpr double tolerance = 1e-6;  // of a share: what is asked for is divided by
  for (const pinnquad::Airframe<double>& a :
       {pinnquad::PaperQuadrotor::value<double>(), nose_heavy(), pinnquad::test::uneven_airframe<double>()}) {
    const pinnquad::Rotors<double> rotors(a);
    std::mt19937_64 engine(11);
    int tilt_gave = 0, yaw_left = 0;
    for (int i = 0; i < 2'000; ++i) {
      Commands<double> wanted{};
      for (double& u : wanted) u = pinnquad::uniform(engine, -0.3, 1.6);
      const Best best = best_by_vertices(rotors, wanted, turning_on);
      const Commands<double> given = desaturate(rotors, wanted, turning_on);
      const auto asked = rotors.wrench(wanted, 1.0).torque_N_m, made = rotors.wrench(given, 1.0).torque_N_m;
      const double tilt = asked[0] * asked[0] + asked[1] * asked[1];
      CAPTURE(i);
      REQUIRE((asked[0] * made[0] + asked[1] * made[1]) / tilt == doctest::Approx(best.tilt).epsilon(tolerance));
      REQUIRE(std::abs(made[2] - best.yaw * asked[2]) <= tolerance * a.max_rotor_torque_N_m());
      tilt_gave += best.tilt < 1 - tolerance;
      yaw_left += best.tilt < 1 - tolerance && best.yaw > tolerance;
    }
    CHECK(tilt_gave > 20);
    CHECK(yaw_left > 5);
  }
}

TEST_CASE_TEMPLATE("what flies next to a command at its end is next to it too", Scalar, float, double) {
  const pinnquad::Rotors<Scalar> rotors(pinnquad::PaperQuadrotor::value<Scalar>());
  std::mt19937_64 engine(12);
  constexpr Scalar step = Scalar(1e-4), most_times = 16;
  for (int i = 0; i < 20'000; ++i) {
    Commands<Scalar> wanted{};
    for (Scalar& u : wanted) u = Scalar(pinnquad::uniform(engine, -0.3, 1.6));
    Commands<Scalar> next = wanted;
    next[static_cast<std::size_t>(i % 4)] += step;
    const Commands<Scalar> a = desaturate(rotors, wanted), b = desaturate(rotors, next);
    for (std::size_t k = 0; k < a.size(); ++k) REQUIRE(std::abs(a[k] - b[k]) <= most_times * step);
  }
}

TEST_CASE("NaN passes through, beside commands out of the range too") {
  const pinnquad::Rotors<double> rotors(pinnquad::PaperQuadrotor::value<double>());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(desaturate(rotors, {nan, 0.2, 0.3, 0.4})[0]));
  CHECK(std::isnan(desaturate(rotors, {nan, 1.2, 0.3, 0.4})[0]));
}

TEST_CASE("of rotors that are alike: more torque asked about an axis is never less made, whatever else is asked") {
  const pinnquad::Rotors<double> rotors(pinnquad::PaperQuadrotor::value<double>());
  std::mt19937_64 engine(13);
  for (int i = 0; i < 30'000; ++i) {
    Commands<double> wanted{};
    for (double& u : wanted) u = pinnquad::uniform(engine, -0.5, 1.8);
    const int axis = i % 3;
    pinnquad::Wrench<double> step;
    step.torque_N_m[axis] = std::pow(10, pinnquad::uniform(engine, -6, 0)) * (axis == 2 ? 0.1 : 1);
    const Commands<double> by = rotors.commands(step, 1.0);
    Commands<double> more = wanted;
    for (std::size_t k = 0; k < more.size(); ++k) more[k] += by[k];
    const double before = rotors.wrench(desaturate(rotors, wanted), 1.0).torque_N_m[axis];
    REQUIRE(rotors.wrench(desaturate(rotors, more), 1.0).torque_N_m[axis] >= before - rounding);
  }
}
