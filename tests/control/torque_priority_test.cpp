// SPDX-License-Identifier: MIT
// Torque before thrust.
#include "pinnquad/control/torque_priority.hpp"

#include <doctest/doctest.h>

#include "support/uneven_airframe.hpp"

#include <cmath>
#include <limits>

using pinnquad::Commands;
using pinnquad::keep_torque;
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
  CHECK(keep_torque(Commands<double>{0.1, 0.9, 0.5, 1.0}) == Commands<double>{0.1, 0.9, 0.5, 1.0});
  CHECK(same(keep_torque(Commands<double>{0.9, 1.2, 0.8, 1.0}), {0.7, 1.0, 0.6, 0.8}));
  CHECK(same(keep_torque(Commands<double>{-0.2, 0.1, 0.3, 0.0}), {0.0, 0.3, 0.5, 0.2}));
}

TEST_CASE("a spread above 1 keeps the largest at the limit; the rotors clip the rest") {
  CHECK(same(keep_torque(Commands<double>{-0.4, 1.2, 0.5, 0.5}), {-0.6, 1.0, 0.3, 0.3}));
  CHECK(same(keep_torque(Commands<double>{-0.8, 0.6, 0.0, 0.0}), {-0.4, 1.0, 0.4, 0.4}));
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
    const pinnquad::Commands<double> given = keep_torque(rotors, wanted);
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
  CHECK(same(keep_torque(rotors, u), u));
}

TEST_CASE("equal rotors: the shift of all commands together, to the last bit") {
  const pinnquad::Rotors<double> rotors(pinnquad::PaperQuadrotor::value<double>());
  for (const pinnquad::Commands<double>& u :
       {pinnquad::Commands<double>{0.9, 1.2, 0.8, 1.0}, pinnquad::Commands<double>{-0.4, 1.2, 0.5, 0.5},
        pinnquad::Commands<double>{0.1, 0.9, 0.5, 1.0}}) {
    CHECK(keep_torque(rotors, u) == keep_torque(u));
  }
}
