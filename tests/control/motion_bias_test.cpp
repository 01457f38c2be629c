// SPDX-License-Identifier: MIT
// The bias of the signed sums: first order, its bounds, hold and fade, what it says of itself.
#include "pinnquad/control/motion_bias.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"

using namespace pinnquad;

namespace {

using Bias = detail::MotionBias<double>;
constexpr double period_s = 0.025, rounding = 1e-12;
const double no_number = std::numeric_limits<double>::quiet_NaN();
const double infinity = std::numeric_limits<double>::infinity();
const Vector3<double> none = Vector3<double>::Zero();
const auto airframe = airframe_value<PaperQuadrotor, double>();

BiasSettings<double> settings() {
  BiasSettings<double> result;
  result.time_constants_s = {0.2, 0.4, 0.8, 1.6};
  result.across_time_constant_s = 0.3;
  return result;
}

/// Learns of a vehicle that needs 0.1 more of each rotor, and 0.05 more of the first, so many times.
Bias learnt(int times, pinnquad::BiasSettings<double> settings = {}) {
  settings.time_constants_s = {0.2, 0.45, 0.45, 0.45};
  Bias bias(airframe, settings);
  for (int i = 0; i < times; ++i) {
    CHECK(pinnquad::has_output(bias.learn({}, {0.65, 0.6, 0.6, 0.6}, {0.5, 0.5, 0.5, 0.5}, period_s)));
  }
  return bias;
}

}  // namespace

TEST_CASE("a constant residual is found as first order finds it: r (1 - (c / (c + T))^n)") {
  const SignedSums<double> residual{0.3, -0.2, 0.1, 0.05};
  const Vector3<double> across(1, -0.5, 0.2);
  Bias bias(airframe, settings());
  CHECK(bias.status() == Status::warming_up);
  for (int n = 1; n <= 200; ++n) {
    REQUIRE(bias.learn(residual, across, period_s) == Status::ok);
    for (std::size_t k = 0; k < 4; ++k) {
      const double c = settings().time_constants_s[k];
      CHECK(std::abs(bias.sums()[k] - residual[k] * (1 - std::pow(c / (c + period_s), n))) <= rounding);
      // and what a time constant is: 1 - exp(-t / c), to a period
      CHECK(std::abs(bias.sums()[k] - residual[k] * (1 - std::exp(-period_s * n / c))) <= 0.1 * std::abs(residual[k]));
    }
    CHECK((bias.across_m_s2() - across * (1 - std::pow(0.3 / (0.3 + period_s), n))).norm() <= rounding);
  }
}

TEST_CASE("a time constant of 0 is the last residual, an infinite one none") {
  BiasSettings<double> extreme = settings();
  extreme.time_constants_s = {0, infinity, 0, infinity};
  Bias bias(airframe, extreme);
  REQUIRE(bias.learn({0.3, 0.2, -0.1, 0.4}, none, period_s) == Status::ok);
  CHECK(bias.sums() == SignedSums<double>{0.3, 0, -0.1, 0});
}

namespace {
struct Silent {
  using Scalar = float;
};
struct Telling {
  using Scalar = float;
  static constexpr std::array<float, 4> bias_time_constants_s = {{0.25f, 0.5f, 1.0f, 0.0f}};
};
}  // namespace

TEST_CASE("the settings of a model: its own time constants, else the usual ones; 0 is none of a sum") {
  constexpr BiasSettings<double> usual;
  CHECK(bias_settings<Silent, double>().time_constants_s == usual.time_constants_s);
  constexpr auto own = bias_settings<Telling, double>();
  CHECK(own.time_constants_s == SignedSums<double>{0.25, 0.5, 1, infinity});
  CHECK(own.most == usual.most);
  CHECK(bias_settings<Telling>().time_constants_s[0] == 0.25f);
  detail::ModelFacts facts;
  CHECK(bias_settings<double>(facts).time_constants_s == usual.time_constants_s);
  facts.has_bias = true;
  for (double& time_s : facts.bias_time_constants_s) time_s = 2;
  CHECK(bias_settings<double>(facts).time_constants_s == SignedSums<double>{2, 2, 2, 2});
}

TEST_CASE("where lag and delay are told a bias is quick; a sum without a bias has none") {
  BiasSettings<double> settings;
  settings.time_constants_s = {0.2, infinity, 0.01, 0.45};
  BiasSettings<double> quick = quick_where_told(settings);
  CHECK(quick.time_constants_s == SignedSums<double>{0.0025, infinity, 0.0025, 0.05});
  CHECK(quick.across_time_constant_s == 0.01);
  CHECK(quick.most == settings.most);
  quick.time_constants_s[0] = 0;
  CHECK(quick_where_told(quick).time_constants_s == quick.time_constants_s);
}

TEST_CASE("noise makes the time constants of roll, pitch and across longer, to an end; a constant residual does not") {
  const BiasSettings<double> quick = quick_where_told(BiasSettings<double>{});
  const auto share = [](double time_s) { return period_s / (period_s + time_s); };
  Bias bias(airframe, quick);
  for (int i = 0; i < 2000; ++i) REQUIRE(bias.learn({0.1, 0.05, -0.05, 0}, {1, 0, 0}, period_s) == Status::ok);
  CHECK(bias.learnt().roll_pitch_noise <= 1e-9);
  CHECK(bias.learnt().across_noise_m_s2 <= 1e-9);
  // from a residual that stands, one step: what it takes of it is the share of its time constant
  const auto step_after = [&](double noise) {
    Bias noisy(airframe, quick);
    for (int i = 0; i < 4000; ++i) {
      const double now = i % 2 == 0 ? noise : -noise;
      static_cast<void>(noisy.learn({now, now, now, now}, {100 * now, 0, 0}, period_s));
    }
    Bias next(airframe, quick);
    next.resume({{}, none, none, noisy.learnt().roll_pitch_noise, noisy.learnt().across_noise_m_s2, 0, Status::ok});
    REQUIRE(next.learn({0.1, 0.1, 0.1, 0.1}, {1, 0, 0}, period_s) == Status::ok);
    CHECK(next.sums()[0] == doctest::Approx(0.1 * share(0.0025)));
    CHECK(next.sums()[3] == doctest::Approx(0.1 * share(0.05)));
    CHECK(next.sums()[1] == doctest::Approx(next.sums()[2]));
    return std::array<double, 2>{next.sums()[1] / 0.1, next.across_m_s2()[0]};
  };
  const auto calm = step_after(1e-3), noisy = step_after(0.03), loud = step_after(0.3);
  CHECK(calm[0] > noisy[0]);
  CHECK(noisy[0] > 1.5 * loud[0]);
  CHECK(calm[1] == doctest::Approx(share(0.01)));
  CHECK(noisy[1] < 0.7 * calm[1]);
  for (const double least : loud) CHECK(least == doctest::Approx(share(Bias(airframe).settings().longest_by_noise_s)));
}

TEST_CASE(
    "the acceleration across is flown with its lead: by its trend, less in a swing, none unless told, in its bound") {
  const BiasSettings<double> quick = quick_where_told(BiasSettings<double>{});
  Bias bias(airframe, quick), plain(airframe), swinging(airframe, quick);
  for (int i = 0; i < 100; ++i) {  // rises by 0.5 m/s^2 a second
    const Vector3<double> across(0.5 * period_s * i, 0, 0.1 * period_s * i);
    const double swing = i % 2 == 0 ? 0.12 : -0.12;
    static_cast<void>(bias.learn({}, across, period_s));
    static_cast<void>(plain.learn({}, across, period_s));
    static_cast<void>(swinging.learn({0, swing, 0, 0}, across, period_s));
  }
  const auto lead = [](const Bias& of) { return (of.across_ahead_m_s2() - of.across_m_s2())[0]; };
  CHECK(bias.learnt().across_rate_m_s3[0] == doctest::Approx(0.5).epsilon(0.02));
  CHECK(lead(bias) == doctest::Approx(0.5 * quick.across_lead_s).epsilon(0.02));
  CHECK(lead(swinging) < 0.5 * lead(bias));
  CHECK(lead(swinging) > 0);
  CHECK(bias.learnt().across_rate_m_s3[2] == doctest::Approx(0));  // the thrust's to answer
  CHECK(plain.across_ahead_m_s2() == plain.across_m_s2());
  bias.resume({{}, {2.9, 0, 0}, {50, 0, 0}});
  CHECK(bias.across_ahead_m_s2()[0] == doctest::Approx(quick.most_across_m_s2));
  bias.reset();
  CHECK(bias.across_ahead_m_s2() == none);
}

TEST_CASE("the most that it changes a command: of an X a quarter of the bounds' sum") {
  for (const double most : largest_bias(airframe)) CHECK(most == doctest::Approx(0.25 * (1.6 + 3 * 0.4)));
  BiasSettings<double> bounded;
  bounded.most = {0.1, 0, 0.2, 0};
  for (const double most : largest_bias(airframe, bounded)) CHECK(most == doctest::Approx(0.075));
}

TEST_CASE("bounds: of each sum, and of the length across; it says that it is limited, and comes off again") {
  Bias bias(airframe, settings());
  for (int i = 0; i < 400; ++i) static_cast<void>(bias.learn({5, -5, 0.1, 0}, {6, 8, 0}, period_s));
  CHECK(bias.status() == Status::limited);
  CHECK(bias.sums()[0] == settings().most[0]);
  CHECK(bias.sums()[1] == -settings().most[1]);
  CHECK(std::abs(bias.sums()[2] - 0.1) <= 1e-4);
  CHECK(bias.across_m_s2().norm() == doctest::Approx(settings().most_across_m_s2));
  CHECK(bias.across_m_s2()[0] / bias.across_m_s2()[1] == doctest::Approx(0.75));
  CHECK(bias.share_of_bound() == doctest::Approx(1));
  // no windup: one period after the residual is gone it moves
  REQUIRE(bias.learn({0, 0, 0, 0}, none, period_s) == Status::ok);
  CHECK(bias.sums()[0] == doctest::Approx(settings().most[0] * 0.2 / (0.2 + period_s)));
}

TEST_CASE("without a residual it holds, then fades; a residual ends the waiting") {
  Bias bias(airframe, settings());
  for (int i = 0; i < 400; ++i) static_cast<void>(bias.learn({0.3, 0.1, 0, 0}, {1, 0, 0}, period_s));
  const double before = bias.sums()[0];
  constexpr double step_s = 0.002;
  double waited_s = 0;
  for (int i = 0; i < 249; ++i) {
    bias.wait(step_s);
    waited_s += step_s;
  }
  CHECK(bias.sums()[0] == before);
  CHECK(bias.status() == Status::ok);
  for (int i = 0; i < 1001; ++i) {
    bias.wait(step_s);
    waited_s += step_s;
  }
  CHECK(bias.status() == Status::warming_up);
  const double faded_s = waited_s - settings().hold_s;
  const double kept = std::exp(-faded_s / settings().fade_s);
  CHECK(bias.sums()[0] == doctest::Approx(before * kept).epsilon(0.01));
  CHECK(bias.sums()[1] == doctest::Approx(0.1 * kept).epsilon(0.01));
  CHECK(bias.across_m_s2()[0] == doctest::Approx(kept).epsilon(0.01));
  CHECK(bias.learnt().waited_s == doctest::Approx(waited_s));
  CHECK(bias.learn({0.3, 0.1, 0, 0}, none, period_s) == Status::ok);
  CHECK(bias.learnt().waited_s == 0);
  const double held = bias.sums()[0];
  bias.wait(0.4);
  CHECK(bias.sums()[0] == held);
  // steps that are none
  for (const double step : {0.0, -1.0, no_number}) bias.wait(step);
  CHECK(bias.learnt().waited_s == doctest::Approx(0.4));
  bias.freeze();
  const double frozen = bias.sums()[0];
  bias.wait(0.4);
  CHECK(bias.sums()[0] == frozen);
}

TEST_CASE("what is no number is not learnt, and said; nor from a period that is none") {
  Bias bias(airframe, settings());
  REQUIRE(bias.learn({0.3, 0.1, 0, 0}, {1, 0, 0}, period_s) == Status::ok);
  const SignedSums<double> before = bias.sums();
  CHECK(bias.learn({0.3, no_number, 0, 0}, none, period_s) == Status::not_finite);
  CHECK(bias.learn({0.3, 0.1, 0, infinity}, none, period_s) == Status::not_finite);
  CHECK(bias.learn({0.3, 0.1, 0, 0}, {0, no_number, 0}, period_s) == Status::not_finite);
  CHECK(bias.learn({0.3, 0.1, 0, 0}, none, no_number) == Status::not_finite);
  CHECK(bias.learn({0.3, 0.1, 0, 0}, none, 0.0) == Status::not_finite);
  CHECK(bias.learn({0.3, 0.1, 0, 0}, none, -1.0) == Status::not_finite);
  CHECK(bias.status() == Status::not_finite);
  CHECK(bias.sums() == before);
  CHECK(bias.learn({0.3, 0.1, 0, 0}, none, period_s) == Status::ok);
}

TEST_CASE("it goes on from what was logged, to the bit, refuses what is no number, and forgets when told so") {
  const BiasSettings<double> quick = quick_where_told(BiasSettings<double>{});
  Bias flown(airframe, quick), replayed(airframe, quick);
  const auto next = [](Bias& bias, int i) {
    const double now = 0.05 * ((i * 7) % 11 - 5);
    static_cast<void>(bias.learn({now, now, -now, now}, {10 * now, now, 0}, period_s));
    if (i % 25 == 24) bias.wait(0.8);
  };
  for (int i = 0; i < 50; ++i) next(flown, i);
  replayed.resume(flown.learnt());
  replayed.resume({{no_number, 0, 0, 0}});
  replayed.resume({{}, {no_number, 0, 0}});
  replayed.resume({{}, none, {0, no_number, 0}});
  replayed.resume({{}, none, none, no_number});
  replayed.resume({{}, none, none, 0, infinity});
  replayed.resume({{}, none, none, 0, 0, no_number});
  for (int i = 50; i < 100; ++i) {
    next(flown, i);
    next(replayed, i);
    REQUIRE(replayed.sums() == flown.sums());
    REQUIRE(replayed.across_ahead_m_s2() == flown.across_ahead_m_s2());
  }
  replayed.reset();
  CHECK(replayed.sums() == SignedSums<double>{});
  CHECK(replayed.across_m_s2() == none);
  CHECK(replayed.status() == Status::warming_up);
  CHECK(replayed.settings().time_constants_s == quick.time_constants_s);
}

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
