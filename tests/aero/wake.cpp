// SPDX-License-Identifier: MIT
#include "pinnquad/aero/wake.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/momentum_theory.hpp"
#include "support/random_states.hpp"
#include "support/tolerances.hpp"

using pinnquad::RotorCondition;
using pinnquad::Status;
using pinnquad::Vector3;
using pinnquad::Wake;
using pinnquad::test::RandomStates;

namespace {

constexpr double pi = 3.141592653589793;

template <class Scalar>
RotorCondition<Scalar> flying(double forward_m_s, double right_m_s) {
  RotorCondition<Scalar> c;
  c.air_relative_velocity_m_s = Vector3<Scalar>(Scalar(forward_m_s), Scalar(right_m_s), Scalar(0));
  c.rotor_thrust_N = {Scalar(3.7), Scalar(3.7), Scalar(3.7), Scalar(3.7)};
  return c;
}

}  // namespace

TEST_CASE_TEMPLATE("the rotors behind lose thrust, those before keep it: the side that leads rises", Scalar, float,
                   double) {
  const auto airframe = pinnquad::PaperQuadrotor::value<Scalar>();
  const auto hover = Wake{}.bound(airframe);
  const double peak = static_cast<double>(hover.peak_speed_m_s);
  for (int turn = 0; turn < 4; ++turn) {
    const double x = std::cos(turn * pi / 2), y = std::sin(turn * pi / 2);
    const auto lost = hover.lost_shares(Scalar(peak * x), Scalar(peak * y), airframe);
    for (std::size_t i = 0; i < 4; ++i) {
      const double ahead =
          static_cast<double>(airframe.rotors[i].x_m) * x + static_cast<double>(airframe.rotors[i].y_m) * y;
      const double share = static_cast<double>(lost[i]);
      CHECK((ahead > 0 ? std::fabs(share) < 1e-3 : share > 0.9 * Wake{}.depth));
      CHECK(share <= Wake{}.depth);
    }
    const auto w = Wake{}.bound(airframe).wrench(flying<Scalar>(peak * x, peak * y), airframe);
    CHECK(static_cast<double>(w.force_N[2]) == doctest::Approx(2 * 3.7 * 0.95 * 0.15).epsilon(0.02));
    // nose up (+y) in forward flight, right side up (-x) in flight to the right
    CHECK(static_cast<double>(w.torque_N_m[1]) * x - static_cast<double>(w.torque_N_m[0]) * y > 0.2);
    CHECK(std::fabs(static_cast<double>(w.torque_N_m[1]) * y + static_cast<double>(w.torque_N_m[0]) * x) < 1e-5);
  }
}

TEST_CASE("along a diagonal the one rotor behind loses as much, those at the sides hardly any") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  const auto hover = Wake{}.bound(airframe);
  const double each = hover.peak_speed_m_s * std::sqrt(0.5);
  auto lost = hover.lost_shares(each, each, airframe);
  std::sort(lost.begin(), lost.end());
  CHECK(lost[0] < 1e-9);
  CHECK(lost[2] < 0.02 * Wake{}.depth);
  CHECK(std::fabs(lost[3] / Wake{}.depth - 1) <= 0.05);
}

TEST_CASE("over speed: none at rest, a bell with its top at the peak speed, continuous slopes everywhere") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  const auto hover = Wake{}.bound(airframe);
  const auto most = [&](double x, double y) {
    const auto lost = hover.lost_shares(x, y, airframe);
    return *std::max_element(lost.begin(), lost.end());
  };
  CHECK(most(0, 0) == 0);
  const double peak = hover.peak_speed_m_s, h = 1e-4 * peak;
  CHECK(most(peak, 0) > most(peak * 1.02, 0));
  CHECK(most(peak, 0) > most(peak * 0.98, 0));
  CHECK(most(peak / 3, 0) == doctest::Approx(most(3 * peak, 0)).epsilon(2e-3));  // B(s) = B(1 / s)
  CHECK(most(peak / 3, 0) / most(peak, 0) == doctest::Approx(0.36).epsilon(2e-3));
  RandomStates random(160);
  for (int draw = 0; draw < 2000; ++draw) {
    const double scale = draw % 2 == 0 ? peak : 0.01 * peak;
    const double x = random.scalar<double>(-2, 2) * scale, y = random.scalar<double>(-2, 2) * scale;
    const auto before = hover.lost_shares(x - h, y, airframe), here = hover.lost_shares(x, y, airframe),
               after = hover.lost_shares(x + h, y, airframe);
    for (std::size_t i = 0; i < 4; ++i) {
      const double bend = std::fabs(after[i] - 2 * here[i] + before[i]) / h * peak;
      if (bend > 0.02) FAIL_CHECK("the slope steps by " << bend << " at " << x << ", " << y);
    }
  }
}

TEST_CASE("the depth is about half of the most that momentum theory's wake takes, near the speed where it takes it") {
  const double lambda = std::sqrt(2 * 0.1099 / (pi * pi * pi)), slope = 0.107 * 5.1;
  constexpr double gap = 0.487904 / 0.1143;  // from front to rear hub, radii
  double most = 0, at = 0;
  for (int i = 1; i < 200; ++i) {
    const double speed = 0.05 * i;
    const auto front = pinnquad::test::disc_flow(slope, lambda, speed, 0);
    const double sink = gap * front.induced / speed, pushed = 2 * front.induced / (1 + sink * sink);
    const double lost = 1 - pinnquad::test::disc_flow(slope, lambda, speed, pushed).thrust_ratio / front.thrust_ratio;
    if (lost > most) most = lost, at = speed;
  }
  CHECK(Wake{}.depth / most > 0.4);
  CHECK(Wake{}.depth / most < 0.7);
  CHECK(Wake{}.peak_speed / at > 0.6);
  CHECK(Wake{}.peak_speed / at < 1.1);
}

TEST_CASE("values that could take all thrust are refused") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  CHECK(Wake{}.status(airframe) == Status::ok);
  CHECK(Wake{0.31, 2.5}.status(airframe) == Status::out_of_range);
  CHECK(Wake{-0.1, 2.5}.status(airframe) == Status::out_of_range);
  CHECK(Wake{0.1, 0.0}.status(airframe) == Status::out_of_range);
  CHECK(Wake{std::numeric_limits<double>::quiet_NaN(), 2.5}.status(airframe) == Status::out_of_range);
}
