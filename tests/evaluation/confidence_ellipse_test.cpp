// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <pinnquad/core/random.hpp>
#include <pinnquad/evaluation/physical_consistency.hpp>
#include <random>
#include <stdexcept>
#include <vector>

using namespace pinnquad;
using pinnquad::detail::JointMoments;
using Series = std::vector<double>;

namespace {

constexpr double degree = 3.14159265358979323846 / 180;
constexpr double rounding = 1e-9;  // a few operations, angles up to 180

/// Covariance with standard deviations (major, minor) along axes turned by the angle: R diag(major^2, minor^2) R^T.
pinnquad::detail::JointMoments turned_moments(double major, double minor, double angle_deg) {
  const double c = std::cos(angle_deg * degree);
  const double s = std::sin(angle_deg * degree);
  pinnquad::detail::JointMoments moments;
  moments.mean_x = 10;
  moments.mean_y = -4;
  moments.variance_x = c * c * major * major + s * s * minor * minor;
  moments.variance_y = s * s * major * major + c * c * minor * minor;
  moments.covariance = c * s * (major * major - minor * minor);
  return moments;
}

/// Squared distance from the centre in units of the semi-axes: below 1 inside.
double ellipse_level(const ConfidenceEllipse& ellipse, double x, double y) {
  const double c = std::cos(ellipse.angle_deg * degree);
  const double s = std::sin(ellipse.angle_deg * degree);
  const double along = (c * (x - ellipse.center_x) + s * (y - ellipse.center_y)) / ellipse.semi_major;
  const double across = (-s * (x - ellipse.center_x) + c * (y - ellipse.center_y)) / ellipse.semi_minor;
  return along * along + across * across;
}

/// A turned normal cloud.
struct Cloud {
  Series x;
  Series y;
};

Cloud normal_cloud(std::size_t count, double major, double minor, double angle_deg, unsigned seed) {
  std::mt19937_64 engine(seed);
  const double c = std::cos(angle_deg * degree);
  const double s = std::sin(angle_deg * degree);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double along = major * pinnquad::standard_normal(engine);
    const double across = minor * pinnquad::standard_normal(engine);
    cloud.x.push_back(10 + c * along - s * across);
    cloud.y.push_back(-4 + s * along + c * across);
  }
  return cloud;
}

}  // namespace

TEST_CASE("a known covariance, turned, gives its axes and its angle back") {
  for (int angle = -89; angle <= 90; ++angle) {
    CAPTURE(angle);
    for (const double minor : {0.02, 0.5, 1.9}) {
      const ConfidenceEllipse ellipse = covariance_ellipse(turned_moments(2, minor, angle), 3);
      CHECK(ellipse.center_x == 10);
      CHECK(ellipse.center_y == -4);
      CHECK(ellipse.semi_major == doctest::Approx(6).epsilon(rounding));
      CHECK(ellipse.semi_minor == doctest::Approx(3 * minor).epsilon(rounding));
      CHECK(angle_difference_deg(ellipse.angle_deg, angle) < rounding);
      CHECK(ellipse.angle_deg > -90);
      CHECK(ellipse.angle_deg <= 90);
    }
  }
}

TEST_CASE("four points by hand: the ellipse of series is that of their moments") {
  // (+-2, 0), (0, +-1): variances 8/3 and 2/3, no covariance
  const ConfidenceEllipse flat = confidence_ellipse({2, -2, 0, 0}, {0, 0, 1, -1});
  CHECK(flat.angle_deg == 0);
  CHECK(flat.semi_major == doctest::Approx(3 * std::sqrt(8.0 / 3)).epsilon(rounding));
  CHECK(flat.semi_minor == doctest::Approx(3 * std::sqrt(2.0 / 3)).epsilon(rounding));
  CHECK(confidence_ellipse({0, 0, 1, -1}, {2, -2, 0, 0}).angle_deg == 90);
  CHECK(confidence_ellipse({2, -2, 0, 0}, {0, 0, 1, -1}, 1.5).semi_major == flat.semi_major / 2);
}

TEST_CASE("degenerate clouds: a line, a circle, a point, a constant series, none") {
  const ConfidenceEllipse line = confidence_ellipse({1, 2, 3}, {-1, -2, -3});
  CHECK(line.angle_deg == doctest::Approx(-45).epsilon(rounding));
  CHECK(line.semi_minor == 0);
  const ConfidenceEllipse circle = confidence_ellipse({1, -1, 0, 0}, {0, 0, 1, -1});
  CHECK(circle.angle_deg == 0);
  CHECK(circle.semi_major == circle.semi_minor);
  const ConfidenceEllipse point = confidence_ellipse({5, 5}, {6, 6});
  CHECK(point.semi_major == 0);
  CHECK(point.semi_minor == 0);
  CHECK(confidence_ellipse({1, 2, 3}, {0.1, 0.1, 0.1}).angle_deg == 0);
  CHECK(confidence_ellipse({0.1, 0.1, 0.1}, {1, 2, 3}).angle_deg == 90);
  CHECK(std::isnan(confidence_ellipse({1}, {1}).angle_deg));
  CHECK(std::isnan(confidence_ellipse({1, std::nan("")}, {1, 2}).semi_minor));
  CHECK_THROWS_AS(confidence_ellipse({1, 2}, {1}), std::invalid_argument);

  pinnquad::detail::JointMoments minus_zero = turned_moments(2, 1, 90);
  minus_zero.covariance = -0.0;
  CHECK(covariance_ellipse(minus_zero).angle_deg == 90);
}

TEST_CASE("the difference of two axes is folded to 0..90 degrees") {
  CHECK(angle_difference_deg(10, 25) == 15);
  CHECK(angle_difference_deg(25, 10) == 15);
  CHECK(angle_difference_deg(89, -89) == 2);
  CHECK(angle_difference_deg(90, -90) == 0);
  CHECK(angle_difference_deg(45, -45) == 90);
  CHECK(angle_difference_deg(-60, 60) == 60);
  CHECK(std::isnan(angle_difference_deg(std::nan(""), 1)));
  for (double a = -90; a <= 90; a += 7.5) {
    for (double b = -90; b <= 90; b += 7.5) {
      CHECK(angle_difference_deg(a, b) >= 0);
      CHECK(angle_difference_deg(a, b) <= 90);
      CHECK(angle_difference_deg(a + 180, b) == angle_difference_deg(a, b));  // axes have no direction
    }
  }
}

TEST_CASE("k sigma enclose 1 - exp(-k^2 / 2) in the plane: 98.9 % for three") {
  constexpr std::size_t count = 40000;
  const Cloud cloud = normal_cloud(count, 3, 0.4, 28, 11);
  for (const double sigmas : {1.0, 2.0, 3.0}) {
    const ConfidenceEllipse ellipse = confidence_ellipse(cloud.x, cloud.y, sigmas);
    std::size_t inside = 0;
    for (std::size_t i = 0; i < count; ++i) inside += ellipse_level(ellipse, cloud.x[i], cloud.y[i]) < 1 ? 1 : 0;
    const double share = -std::expm1(-sigmas * sigmas / 2);
    const double four_sampling_errors = 4 * std::sqrt(share * (1 - share) / count);
    CHECK(std::abs(static_cast<double>(inside) / count - share) < four_sampling_errors);
  }
}

TEST_CASE("the outline lies on the ellipse, begins at the tip and is closed") {
  const ConfidenceEllipse ellipse = covariance_ellipse(turned_moments(2, 0.5, 33));
  const auto outline = ellipse_outline(ellipse, 37);
  REQUIRE(outline.size() == 37);
  CHECK(outline.front() == outline.back());
  CHECK(outline[0][0] == doctest::Approx(10 + 6 * std::cos(33 * degree)).epsilon(rounding));
  CHECK(outline[0][1] == doctest::Approx(-4 + 6 * std::sin(33 * degree)).epsilon(rounding));
  for (const auto& point : outline) CHECK(ellipse_level(ellipse, point[0], point[1]) == doctest::Approx(1));
  CHECK(outline[18][0] == doctest::Approx(10 - 6 * std::cos(33 * degree)).epsilon(rounding));  // the other tip
  CHECK_THROWS_AS(ellipse_outline(ellipse, 1), std::invalid_argument);
}

TEST_CASE("standardised axes: units do not matter, and the target lies at 45 degrees") {
  for (const double angle : {20.0, -20.0}) {
    const Cloud cloud = normal_cloud(500, 3, 1, angle, 9);
    const auto spread = pinnquad::axis_deviation(cloud.x, cloud.y);
    const ConfidenceEllipse target = confidence_ellipse(cloud.x, cloud.y, 3, spread);
    CHECK(target.angle_deg == doctest::Approx(angle > 0 ? 45 : -45).epsilon(rounding));
    // a unit square's worth of variance on both axes: the squared semi-axes sum to 2 x 9
    CHECK(std::pow(target.semi_major, 2) + std::pow(target.semi_minor, 2) == doctest::Approx(18).epsilon(rounding));

    Series prediction = cloud.y;  // half the slope: below 45 degrees
    for (double& value : prediction) value *= 0.5;
    const double standardised = std::abs(confidence_ellipse(cloud.x, prediction, 3, spread).angle_deg);
    CHECK(standardised < 40);

    Series x_in_mm = cloud.x;
    for (double& value : x_in_mm) value *= 1000;
    const auto spread_in_mm = pinnquad::axis_deviation(x_in_mm, cloud.y);
    CHECK(std::abs(confidence_ellipse(x_in_mm, prediction, 3, spread_in_mm).angle_deg) ==
          doctest::Approx(standardised).epsilon(rounding));
    CHECK(std::abs(confidence_ellipse(x_in_mm, prediction).angle_deg) < 1);  // raw angles depend on units
  }
  CHECK(std::isnan(confidence_ellipse({1, 2}, {1, 2}, 3, {1, 0}).angle_deg));
}

TEST_CASE("the standardised angle of a scaled prediction, in closed form") {
  // unit spreads, correlation r; prediction g y: angle = atan2(2 g r, 1 - g^2) / 2
  const Cloud cloud = normal_cloud(300, 2, 1, 30, 2);
  const auto moments = pinnquad::joint_moments(cloud.x, cloud.y);
  const double r = moments.covariance / std::sqrt(moments.variance_x * moments.variance_y);
  for (const double gain : {-2.0, -0.5, 0.1, 0.8, 1.0, 1.7}) {
    Series prediction = cloud.y;
    for (double& value : prediction) value *= gain;
    const double angle =
        confidence_ellipse(cloud.x, prediction, 3, pinnquad::axis_deviation(cloud.x, cloud.y)).angle_deg;
    CHECK(angle == doctest::Approx(std::atan2(2 * gain * r, 1 - gain * gain) / 2 / degree).epsilon(rounding));
  }
}
