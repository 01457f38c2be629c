// SPDX-License-Identifier: MIT
// Reference trajectories: each derivative is the derivative of the one before, and the start is at rest.
#include "pinnquad/control/trajectory.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace {

using pinnquad::TrajectoryPoint;
using pinnquad::Vector3;

// Central differences with a step of 1e-4 s: truncation ~ 1e-9 of values of order 10 to 100, rounding ~ 1e-11 of them.
constexpr double step_s = 1e-4;
constexpr double relative_tolerance = 1e-6;

void require_near(const Vector3<double>& difference, const Vector3<double>& value, double scale) {
  CHECK((difference - value).norm() <= relative_tolerance * scale);
}

template <class Trajectory>
void require_consistent_derivatives(const Trajectory& trajectory) {
  for (double t = 0.05; t < 12; t += 0.173) {
    const TrajectoryPoint<double> a = trajectory.sample(t - step_s);
    const TrajectoryPoint<double> b = trajectory.sample(t);
    const TrajectoryPoint<double> c = trajectory.sample(t + step_s);
    constexpr double scale = 1 / (2 * step_s);
    require_near((c.position_m - a.position_m) * scale, b.velocity_m_s, 10);
    require_near((c.velocity_m_s - a.velocity_m_s) * scale, b.acceleration_m_s2, 10);
    require_near((c.acceleration_m_s2 - a.acceleration_m_s2) * scale, b.jerk_m_s3, 30);
    require_near((c.jerk_m_s3 - a.jerk_m_s3) * scale, b.snap_m_s4, 100);
    CHECK((c.yaw_rad - a.yaw_rad) * scale == doctest::Approx(b.yaw_rate_rad_s).epsilon(1e-6));
    CHECK((c.yaw_rate_rad_s - a.yaw_rate_rad_s) * scale == doctest::Approx(b.yaw_acceleration_rad_s2).epsilon(1e-6));
  }
}

template <class Trajectory>
void require_rest_at_start(const Trajectory& trajectory) {
  for (const double t : {-1.0, 0.0}) {
    const TrajectoryPoint<double> start = trajectory.sample(t);
    CHECK(start.velocity_m_s.norm() == 0);
    CHECK(start.acceleration_m_s2.norm() == 0);
    CHECK(start.jerk_m_s3.norm() == 0);
    CHECK(start.snap_m_s4.norm() == 0);
    CHECK(start.yaw_rate_rad_s == 0);
  }
}

pinnquad::FigureEight<double> figure_eight() {
  pinnquad::FigureEight<double> eight;
  eight.center_m = Vector3<double>(3, -2, -20);
  eight.yaw_amplitude_rad = 0.7;
  return eight;
}

pinnquad::Circle<double> circle() {
  pinnquad::Circle<double> result;
  result.yaw_amplitude_rad = 0.4;
  return result;
}

}  // namespace

TEST_CASE("derivatives up to snap are those of the position") {
  SUBCASE("figure-eight") { require_consistent_derivatives(figure_eight()); }
  SUBCASE("circle") { require_consistent_derivatives(circle()); }
}

TEST_CASE("a trajectory starts at rest") {
  SUBCASE("figure-eight") { require_rest_at_start(figure_eight()); }
  SUBCASE("circle") { require_rest_at_start(circle()); }
}

TEST_CASE("nothing jumps where the ramp ends") {
  const pinnquad::FigureEight<double> eight = figure_eight();
  constexpr double instant_s = 1e-9;  // snap changes by less than 1e3 m/s^5 there
  const TrajectoryPoint<double> before = eight.sample(eight.ramp_s - instant_s);
  const TrajectoryPoint<double> after = eight.sample(eight.ramp_s + instant_s);
  CHECK((after.position_m - before.position_m).norm() <= 1e-6);
  CHECK((after.snap_m_s4 - before.snap_m_s4).norm() <= 1e-5);
}

TEST_CASE("the figure-eight repeats, and reaches the speed its doc states") {
  const pinnquad::FigureEight<double> eight = figure_eight();
  CHECK((eight.sample(10).position_m - eight.sample(10 + eight.period_s).position_m).norm() <= 1e-12);
  const double crossing_s = 2 * eight.period_s + eight.ramp_s / 2;
  const double rate = 6.283185307179586 / eight.period_s;
  CHECK((eight.sample(crossing_s).position_m - eight.center_m).norm() <= 1e-12);
  CHECK(eight.sample(crossing_s).velocity_m_s.norm() == doctest::Approx(rate * std::sqrt(16 + 16 + 0.25)));
  CHECK(eight.sample(crossing_s).velocity_m_s.norm() == doctest::Approx(4.76).epsilon(0.01));
}

TEST_CASE("a ramp of zero starts at full rate") {
  pinnquad::Circle<float> fast;
  fast.ramp_s = 0;
  CHECK(fast.sample(0.0f).velocity_m_s.norm() == doctest::Approx(6.283185 * 4 / 6).epsilon(1e-5));
}

TEST_CASE("the circle goes from north by east, south and west: clockwise seen from above, at one height") {
  pinnquad::Circle<double> round = circle();
  round.center_m = Vector3<double>(3, -2, -20);
  round.ramp_s = 0;
  const Vector3<double> quarters[] = {{4, 0, 0}, {0, 4, 0}, {-4, 0, 0}, {0, -4, 0}};
  for (int quarter = 0; quarter < 8; ++quarter) {
    CAPTURE(quarter);
    const TrajectoryPoint<double> point = round.sample(1.5 * quarter);  // of a period of 6 s
    CHECK((point.position_m - round.center_m - quarters[quarter % 4]).norm() <= 1e-12);
    CHECK(point.velocity_m_s.normalized().dot(quarters[(quarter + 1) % 4] / 4) == doctest::Approx(1));
    const double yaw_rad = quarter % 4 == 1 ? 0.4 : (quarter % 4 == 3 ? -0.4 : 0);
    CHECK(std::fabs(point.yaw_rad - yaw_rad) <= 1e-12);
  }
}

TEST_CASE("the figure-eight leaves its center to the north-east, lower there, and comes back from the north-west") {
  pinnquad::FigureEight<double> eight = figure_eight();
  eight.ramp_s = 0;
  const double half = std::sqrt(0.5);
  const Vector3<double> eighths[] = {
      {0, 0, 0}, {4 * half, 2, 0.5 * half},   {4, 0, 0.5},   {4 * half, -2, 0.5 * half},
      {0, 0, 0}, {-4 * half, 2, -0.5 * half}, {-4, 0, -0.5}, {-4 * half, -2, -0.5 * half}};
  for (std::size_t i = 0; i < 8; ++i) {
    CAPTURE(i);
    const TrajectoryPoint<double> point = eight.sample(7.5 / 8 * static_cast<double>(i));
    CHECK((point.position_m - eight.center_m - eighths[i]).norm() <= 1e-12);
    CHECK(point.yaw_rad == doctest::Approx(0.7 * std::sin(0.7853981633974483 * static_cast<double>(i))).scale(1));
  }
}
