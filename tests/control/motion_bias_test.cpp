// SPDX-License-Identifier: MIT
// A bias of signed sums: its closed form, its bounds, how it fades; and the flown motion that it learns from.
#include "pinnquad/control/motion_bias.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "pinnquad/control/adaptive_inverse.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"

namespace {

using pinnquad::Commands;
using pinnquad::MotionBias;
using pinnquad::Status;
using Bias = MotionBias<double>;

constexpr double period_s = 0.025;
const auto airframe = pinnquad::airframe_value<pinnquad::PaperQuadrotor, double>();

/// Learns of a vehicle that needs 0.1 more of each rotor, and 0.05 more of the first, so many times.
Bias learnt(int times, const pinnquad::BiasSettings<double>& settings = {}) {
  Bias bias(airframe, settings);
  for (int i = 0; i < times; ++i) {
    CHECK(pinnquad::has_output(bias.learn({}, {0.65, 0.6, 0.6, 0.6}, {0.5, 0.5, 0.5, 0.5}, period_s)));
  }
  return bias;
}

}  // namespace

TEST_CASE("each sum follows its residual with its own time constant; A b is what was lacking") {
  for (const int times : {1, 8, 400}) {
    const Bias bias = learnt(times);
    const auto share = [&](double time_constant_s) {
      return 1 - std::pow(time_constant_s / (time_constant_s + period_s), times);
    };
    CHECK(bias.sums()[0] == doctest::Approx(0.45 * share(0.2)));
    for (std::size_t k = 1; k < 4; ++k) CHECK(std::abs(bias.sums()[k]) == doctest::Approx(0.05 * share(0.45)));
    CHECK(bias.status() == Status::ok);
  }
  Commands<double> commands{0.5, 0.5, 0.5, 0.5};
  learnt(400).add_to(commands);
  CHECK(commands[0] == doctest::Approx(0.65));
  for (std::size_t i = 1; i < 4; ++i) CHECK(commands[i] == doctest::Approx(0.6));
}

TEST_CASE("a bias stays within its bounds and says so; without bounds there is none") {
  pinnquad::BiasSettings<double> settings;
  settings.most = {0.2, 0, 0, 0};
  const Bias bias = learnt(100, settings);
  CHECK(bias.sums() == pinnquad::SignedSums<double>{0.2, 0, 0, 0});
  CHECK(bias.share_of_bound() == doctest::Approx(1));
  CHECK(bias.status() == Status::limited);
  settings.most = {0, 0, 0, 0};
  CHECK(learnt(100, settings).share_of_bound() == 0);
  Bias blown(airframe);
  pinnquad::MotionInputs<double> motion;
  motion.linear_acceleration_m_s2 = {100, 0, 0};
  CHECK(blown.learn(motion, {}, {}, period_s) == Status::limited);
  CHECK(blown.across_m_s2().norm() == doctest::Approx(3));
}

TEST_CASE("a residual that is no number changes nothing; without any it holds, then fades") {
  Bias bias = learnt(400);
  const pinnquad::SignedSums<double> before = bias.sums();
  CHECK(bias.learn({}, {std::nan(""), 0, 0, 0}, {}, period_s) == Status::not_finite);
  CHECK(bias.sums() == before);
  for (int i = 0; i < 499; ++i) bias.wait(1e-3);
  CHECK(bias.sums() == before);
  for (int i = 0; i < 2001; ++i) bias.wait(1e-3);
  CHECK(bias.sums()[0] == doctest::Approx(before[0] * std::exp(-1.0)).epsilon(0.01));
  bias.freeze();
  const double faded = bias.sums()[0];
  bias.wait(0.4);
  CHECK(bias.sums()[0] == faded);
  bias.reset();
  CHECK(bias.sums() == pinnquad::SignedSums<double>{});
  CHECK(bias.status() == Status::warming_up);
}

TEST_CASE("the noise of a sample cancels from motion to motion, at any rate of samples") {
  for (const int sample_every : {1, 7, 10}) {
    pinnquad::FlownMotion<double> motion;
    pinnquad::State<double> state;
    std::mt19937_64 engine(1);
    double sum = 0;
    int motions = 0;
    for (int ms = 1; ms < 40000; ++ms) {
      const auto now_us = static_cast<std::uint64_t>(1'000'000 + 1000 * ms);
      if (ms % sample_every == 0) {
        state.velocity_m_s[0] = 0.02 * pinnquad::standard_normal(engine);
        motion.velocity(now_us, state.velocity_m_s);
      }
      motion.body_rates(now_us, state.body_rates_rad_s);
      if (motion.tick(now_us, true, state, {0.5, 0.5, 0.5, 0.5})) {
        sum += motion.motion().linear_acceleration_m_s2[0] * period_s;
        ++motions;
      }
    }
    CHECK(motions > 1500);
    CHECK(std::abs(sum) < 0.08);  // the difference of two means of 0.02 m/s, not of 1500 of them
  }
}

TEST_CASE("a delay: the commands of a motion are as old as its state") {
  for (const double delay_s : {0.0, 0.01, 0.04}) {
    pinnquad::FlownMotion<double> motion({25'000, 0, delay_s});
    const pinnquad::State<double> state;
    int motions = 0;
    for (int ms = 1; ms < 1000; ++ms) {
      const auto now_us = static_cast<std::uint64_t>(1'000'000 + 1000 * ms);
      motion.velocity(now_us, state.velocity_m_s);
      motion.body_rates(now_us, state.body_rates_rad_s);
      const double ramp = 1e-3 * ms;
      if (!motion.tick(now_us, true, state, {ramp, ramp, ramp, ramp})) continue;
      ++motions;
      const double middle_s = 1e-3 * ms - period_s;  // of both periods
      CHECK(motion.flown()[0] == doctest::Approx(middle_s - delay_s).epsilon(0.01).scale(0.3));
    }
    CHECK(motions > 30);
  }
}
