// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <pinnquad/core/random.hpp>
#include <pinnquad/evaluation/physical_consistency.hpp>
#include <random>
#include <stdexcept>
#include <vector>

using pinnquad::sign_violation_share;
using pinnquad::slope_error;
using Series = std::vector<double>;

namespace {

constexpr double rounding = 1e-12;

/// A command sum and the angular acceleration that follows it with some noise.
struct Motion {
  Series sum;
  Series angular_acceleration;
};

Motion noisy_motion(std::size_t count, unsigned seed) {
  std::mt19937_64 engine(seed);
  Motion motion;
  for (std::size_t i = 0; i < count; ++i) {
    motion.sum.push_back(0.05 * pinnquad::standard_normal(engine));
    motion.angular_acceleration.push_back(40 * motion.sum.back() + 0.5 * pinnquad::standard_normal(engine));
  }
  return motion;
}

Series mapped(Series series, double scale, double offset) {
  for (double& value : series) value = scale * value + offset;
  return series;
}

}  // namespace

TEST_CASE("the slope error of a sum scaled by g is |g - 1|, whatever the offset") {
  const Motion motion = noisy_motion(200, 1);
  for (const double gain : {-1.0, 0.0, 0.4, 1.0, 1.3, 5.0}) {
    CHECK(slope_error(motion.sum, mapped(motion.sum, gain, 0.7), motion.angular_acceleration) ==
          doctest::Approx(std::abs(gain - 1)).epsilon(rounding));
  }
}

TEST_CASE("what is uncorrelated with the angular acceleration adds no slope error") {
  const Series acceleration = {-1, -1, 1, 1};
  const Series sum = {-2, -2, 2, 2};
  const Series uncorrelated = {1, -1, 1, -1};
  Series prediction = sum;
  for (std::size_t i = 0; i < sum.size(); ++i) prediction[i] += 3 * uncorrelated[i];
  CHECK(slope_error(sum, prediction, acceleration) == 0);
}

TEST_CASE("undefined slopes are NaN, unequal series refused") {
  CHECK(std::isnan(slope_error({1, 1, 1}, {1, 2, 3}, {1, 2, 3})));
  CHECK(std::isnan(slope_error({1, 2, 3}, {1, 2, 3}, {5, 5, 5})));
  CHECK(std::isnan(slope_error({1}, {1}, {1})));
  CHECK_THROWS_AS(slope_error({1, 2}, {1, 2, 3}, {1, 2, 3}), std::invalid_argument);
  CHECK_THROWS_AS(slope_error({1, 2, 3}, {1, 2}, {1, 2, 3}), std::invalid_argument);
}

TEST_CASE("footnote 2 of the paper: twice the share of violations is 1.0 and 0.5") {
  const Series x = {1, 2, 3, 4, 5};
  CHECK(2 * sign_violation_share({1, -2, -3, 4, 5}, x) == 1.0);
  CHECK(2 * sign_violation_share({1, 2, 3, 1.9455, 2.5}, x) == 0.5);
}

TEST_CASE("which pairs count, and which violate") {
  CHECK(sign_violation_share({0, 1, 2}, {0, 1, 2}) == 0);
  CHECK(sign_violation_share({0, -1, -2}, {0, 1, 2}) == 1);
  CHECK(sign_violation_share({0, 1, 2}, {0, -1, -2}) == 1);
  CHECK(sign_violation_share({0, 0, 1}, {0, 1, 2}) == 0);  // a sum that stands still: no violation
  CHECK(sign_violation_share({0, 1, 0}, {0, 0, 1}) == 1);  // the first pair does not count
  CHECK(sign_violation_share({0, -1, 0, 1}, {0, 1, 2, 3}) == 1.0 / 3);
  CHECK(sign_violation_share({0, -1, 0, 1}, {0, 1, 3, 6}, 0.5) == 1.0 / 3);
  CHECK(sign_violation_share({0, -1, 0, 1}, {0, 1, 3, 6}, 1) == 0);  // a step of 1 is none above 1
  CHECK(sign_violation_share({0, -1, 0, -1}, {0, 1, 3, 6}, 2) == 1);
  CHECK(std::isnan(sign_violation_share({0, 1}, {0, 1}, 1)));
  CHECK(sign_violation_share({0, -1e-200}, {0, 1e-200}) == 1);  // the product would be 0
  CHECK(std::isnan(sign_violation_share({1, 2, 3}, {4, 4, 4})));
  CHECK(std::isnan(sign_violation_share({1}, {1})));
  CHECK(std::isnan(sign_violation_share({}, {})));
  CHECK(sign_violation_share({0, 1, 0, 1}, {0, 1, 2, 3}, 0, {0, 2}) == 0);  // from 1 to 0: another flight
  constexpr double nan = pinnquad::not_a_number;
  CHECK(std::isnan(sign_violation_share({nan, 1, 2}, {0, 1, 2})));
  CHECK(sign_violation_share({nan, 1, 2}, {1, 1, 2}) == 0);  // of a pair that does not count
  CHECK_THROWS_AS(sign_violation_share({1, 2}, {1}), std::invalid_argument);
}

TEST_CASE("violations are blind to scale, offset and a common change of sign") {
  const Motion motion = noisy_motion(300, 4);
  const double share = sign_violation_share(motion.sum, motion.angular_acceleration);
  CHECK(share > 0);
  CHECK(share < 0.5);
  CHECK(sign_violation_share(mapped(motion.sum, 4, 1), mapped(motion.angular_acceleration, 0.5, -2)) == share);
  CHECK(sign_violation_share(mapped(motion.sum, -1, 0), mapped(motion.angular_acceleration, -1, 0)) == share);
  CHECK(sign_violation_share(mapped(motion.sum, -1, 0), motion.angular_acceleration) ==
        doctest::Approx(1 - share).epsilon(rounding));
}

TEST_CASE("a perfect prediction has no error, and its ellipses are the target's") {
  const Motion motion = noisy_motion(400, 6);
  const auto result = pinnquad::physical_consistency({motion.angular_acceleration, motion.sum, motion.sum});
  CHECK(result.angle_difference_deg == 0);
  CHECK(result.raw_angle_difference_deg == 0);
  CHECK(result.slope_error == 0);
  CHECK(result.predicted_correlation == result.target_correlation);
  CHECK(result.target_standardized.angle_deg == doctest::Approx(45).epsilon(rounding));
  CHECK(result.predicted.semi_minor == result.target.semi_minor);
}

TEST_CASE("each measure stands for itself, with the angular acceleration along x") {
  const Motion motion = noisy_motion(400, 8);
  const Series& acceleration = motion.angular_acceleration;
  const Series prediction = mapped(motion.sum, 0.5, 0.01);
  const auto result = pinnquad::physical_consistency({acceleration, motion.sum, prediction});
  const auto spread = pinnquad::axis_deviation(acceleration, motion.sum);
  const auto predicted = pinnquad::confidence_ellipse(acceleration, prediction, 3, spread);
  CHECK(result.predicted_standardized.angle_deg == predicted.angle_deg);
  CHECK(result.predicted_standardized.semi_major == predicted.semi_major);
  CHECK(result.angle_difference_deg == doctest::Approx(45 - predicted.angle_deg).epsilon(1e-9));
  CHECK(result.raw_angle_difference_deg < 1);
  CHECK(result.raw_angle_difference_deg ==
        pinnquad::angle_difference_deg(pinnquad::confidence_ellipse(acceleration, motion.sum).angle_deg,
                                       pinnquad::confidence_ellipse(acceleration, prediction).angle_deg));
  CHECK(result.slope_error == doctest::Approx(0.5).epsilon(rounding));
  CHECK(result.target_correlation == doctest::Approx(result.predicted_correlation).epsilon(rounding));
  CHECK(result.sign_violation_share == sign_violation_share(motion.sum, acceleration));
  CHECK(result.target.semi_major > 10 * result.target.semi_minor);
  CHECK(result.target.center_x == doctest::Approx(pinnquad::summarize(acceleration).mean));
}
