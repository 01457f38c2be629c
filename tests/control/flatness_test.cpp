// SPDX-License-Identifier: MIT
// Differential flatness: the attitude carries the acceleration; rates and angular accelerations are its derivatives.
#include "pinnquad/control/flatness.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "pinnquad/control/leaning.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "support/hover.hpp"

namespace {

using namespace pinnquad;

constexpr double gravity = standard_gravity_m_s2<double>;

FigureEight<double> agile_figure_eight() {
  FigureEight<double> eight;
  eight.yaw_amplitude_rad = 1.1;
  eight.half_height_m = 1.5;
  eight.period_s = 5;
  return eight;
}

FlatMotion<double> flat_at(const FigureEight<double>& eight, double time_s) {
  FlatMotion<double> motion;
  REQUIRE(flat_motion(eight.sample(time_s), gravity, motion) == Status::ok);
  return motion;
}

/// Body rates between two attitudes: 2 vec(q_a* q_b) / dt for a small turn.
Vector3<double> rates_between(const Quaternion<double>& a, const Quaternion<double>& b, double dt_s) {
  const Quaternion<double> turn = conjugate(a) * b;
  const double sign = turn.w < 0 ? -1 : 1;
  return Vector3<double>(turn.x, turn.y, turn.z) * (2 * sign / dt_s);
}

}  // namespace

TEST_CASE("thrust along the attitude plus gravity gives the acceleration; yaw is the trajectory's") {
  const FigureEight<double> eight = agile_figure_eight();
  constexpr double rounding = 1e-12;
  for (double t = 0; t < 11; t += 0.37) {
    const TrajectoryPoint<double> point = eight.sample(t);
    const FlatMotion<double> motion = flat_at(eight, t);
    const Vector3<double> thrust = body_down_axis(motion.attitude) * -motion.specific_thrust_m_s2;
    CHECK((thrust + Vector3<double>(0, 0, gravity) - point.acceleration_m_s2).norm() <= 10 * rounding);
    CHECK(to_euler(motion.attitude).yaw_rad == doctest::Approx(point.yaw_rad).epsilon(rounding));
    CHECK(squared_norm(motion.attitude) == doctest::Approx(1).epsilon(rounding));
  }
}

TEST_CASE("body rates are the derivative of the attitude, angular accelerations that of the rates") {
  const FigureEight<double> eight = agile_figure_eight();
  constexpr double step_s = 1e-4;
  constexpr double tolerance = 1e-6;  // central differences: step^2 times derivatives of order 10 to 100
  for (double t = 0.05; t < 11; t += 0.19) {
    const FlatMotion<double> before = flat_at(eight, t - step_s), now = flat_at(eight, t),
                             after = flat_at(eight, t + step_s);
    const Vector3<double> rates = rates_between(before.attitude, after.attitude, 2 * step_s);
    const Vector3<double> accelerations = (after.body_rates_rad_s - before.body_rates_rad_s) / (2 * step_s);
    CHECK((rates - now.body_rates_rad_s).norm() <= tolerance);
    CHECK((accelerations - now.angular_acceleration_rad_s2).norm() <= 10 * tolerance);
  }
}

TEST_CASE("hover: level, still, thrust balances gravity") {
  FlatMotion<float> motion;
  REQUIRE(flat_motion(test::Hover<float>{}.sample(0.0f), 9.80665f, motion) == Status::ok);
  CHECK(motion.attitude.w == 1);
  CHECK(motion.body_rates_rad_s.norm() == 0);
  CHECK(motion.angular_acceleration_rad_s2.norm() == 0);
  CHECK(motion.specific_thrust_m_s2 == 9.80665f);
}

TEST_CASE("what has no attitude has a Status, and the output is left alone") {
  FlatMotion<double> motion;
  motion.specific_thrust_m_s2 = 42;
  TrajectoryPoint<double> point;
  SUBCASE("free fall") {
    point.acceleration_m_s2[2] = gravity;
    CHECK(flat_motion(point, gravity, motion) == Status::no_solution);
  }
  SUBCASE("thrust too small to have a direction worth flying") {
    point.acceleration_m_s2[2] = gravity - 0.1 * detail::flatness_limit<double>;
    CHECK(flat_motion(point, gravity, motion) == Status::no_solution);
  }
  SUBCASE("thrust along the horizon, across the heading") {
    point.acceleration_m_s2 = Vector3<double>(0, 20, gravity);
    CHECK(flat_motion(point, gravity, motion) == Status::no_solution);
  }
  SUBCASE("NaN in snap") {
    point.snap_m_s4[1] = std::numeric_limits<double>::quiet_NaN();
    CHECK(flat_motion(point, gravity, motion) == Status::not_finite);
  }
  SUBCASE("infinite yaw rate") {
    point.yaw_rate_rad_s = std::numeric_limits<double>::infinity();
    CHECK(flat_motion(point, gravity, motion) == Status::not_finite);
  }
  CHECK(motion.specific_thrust_m_s2 == 42);
}

TEST_CASE("body axes of what is not finite: a Status, and the axes are left alone") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const Matrix<double, 3, 3> before = Matrix<double, 3, 3>::Constant(42);
  Matrix<double, 3, 3> axes = before;
  const Vector3<double> lift(0, 0, -gravity);
  for (const double bad : {nan, infinity, -infinity}) {
    CAPTURE(bad);
    for (int i = 0; i < 3; ++i) {
      Vector3<double> force = lift;
      force[i] = bad;
      CHECK(body_axes(force, Heading<double>{0, 1}, axes) == Status::not_finite);
    }
    CHECK(body_axes(lift, Heading<double>{bad, 1}, axes) == Status::not_finite);
    CHECK(body_axes(lift, Heading<double>{0, bad}, axes) == Status::not_finite);
  }
  CHECK(axes == before);
}

namespace {
/// Knows of an acceleration across the thrust, by `slope` more with the speed towards north.
struct Across {
  double slope;
  bool varies;

  Vector3<double> across_m_s2(const State<double>& state) const noexcept {
    return {0.3 + slope * state.velocity_m_s[0], -0.2, 0};
  }
  bool across_varies() const noexcept { return varies; }
};
}  // namespace

TEST_CASE("a policy that says at run time that nothing varies leans to the same bits, without looking ahead") {
  const TrajectoryPoint<double> point = agile_figure_eight().sample(1.3);
  State<double> state;
  state.velocity_m_s = point.velocity_m_s;
  const auto of = [&](const Across& policy) { return leaning(policy, state, point, gravity); };
  const TrajectoryPoint<double> plain = of({0, false}), looks = of({0, true});
  CHECK(plain.acceleration_m_s2 == Vector3<double>(point.acceleration_m_s2 - Vector3<double>(0.3, -0.2, 0)));
  CHECK((plain.acceleration_m_s2 == looks.acceleration_m_s2 && plain.jerk_m_s3 == looks.jerk_m_s3));
  CHECK((plain.snap_m_s4 == looks.snap_m_s4 && plain.jerk_m_s3 == point.jerk_m_s3));
  CHECK(of({0.1, true}).jerk_m_s3 != point.jerk_m_s3);
}
