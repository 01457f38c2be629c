// SPDX-License-Identifier: MIT
// Policies around an inverse: the integral of the feedback, one with a reserve; and the commands that rotors follow.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/control/adaptive_inverse.hpp"
#include "pinnquad/control/integral_inverse.hpp"
#include "pinnquad/control/rotor_follower.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/tracking.hpp"

using namespace pinnquad;

namespace {

Airframe<double> airframe() { return airframe_value<PaperQuadrotor, double>(); }

/// Answers a number for each rotor, and says that it learns a bias.
struct Scripted {
  double answer = 0.5;
  Status status = Status::ok;

  Status operator()(const State<double>&, const Accelerations<double>&, std::uint64_t,
                    Commands<double>& commands) noexcept {
    if (has_output(status)) commands = {answer, answer, answer, answer};
    return status;
  }
};
using Both = AdaptiveInverse<double, Scripted, FlownMotion<double>, Scripted>;

Both of(const Scripted& first, const Scripted& second, const BiasSettings<double>& settings = {}) {
  return {first, airframe(), settings, FlownMotion<double>{}, second};
}
BiasSettings<double> narrow(double most) {
  BiasSettings<double> settings;
  settings.most = {most, most, most, most};
  return settings;
}

/// Ticks of 2 ms in hover under one command.
template <class Policy>
void hover(Policy& policy, double command, double duration_s, std::uint64_t& now_us, bool known = true) {
  State<double> state;
  for (int i = 0; i < static_cast<int>(std::lround(duration_s / 0.002)); ++i) {
    now_us += 2000;
    policy.learn(now_us, known, state, {command, command, command, command});
  }
}

double answer_of(Both& both, std::uint64_t now_us, Status& status) {
  Commands<double> commands{};
  status = both(State<double>{}, Accelerations<double>{}, now_us, commands);
  return commands[0];
}

}  // namespace

TEST_CASE("the integral takes a steady error away, is bounded, and stands still while a command is at its end") {
  using Body = Quadrotor<double, StandardAtmosphere>;
  const Body told(airframe(), paper_site<double>());
  Airframe<double> loaded = airframe();
  loaded.mass_kg *= 1.1;
  const Body heavy(loaded, paper_site<double>());
  ExactWorld<Body> world{heavy};
  const auto at_rest = [](double) {
    TrajectoryPoint<double> point;
    point.position_m = {0, 0, -20};
    return point;
  };
  struct Place {
    decltype(at_rest) point;
    TrajectoryPoint<double> sample(double time_s) const noexcept { return point(time_s); }
  };
  const FlightController<double> feedback({}, flight_limits(airframe(), 1.0));
  const AnalyticInverse<Body> inverse(told);
  double last_m = 0;
  const auto observer = [&last_m](double, const auto& point, const auto& state, const auto&) noexcept {
    last_m = (point.position_m - state.body.position_m).norm();
  };
  const TrackingPlan<double> plan;
  static_cast<void>(track(told, world, Place{at_rest}, feedback, inverse, plan, observer));
  CHECK(last_m > 0.1);
  static_cast<void>(track(told, world, Place{at_rest}, feedback,
                          IntegralInverse<double, AnalyticInverse<Body>>(inverse), plan, observer));
  CHECK(last_m < 1e-4);

  using Policy = IntegralInverse<double, Scripted>;
  Policy policy({});
  const Accelerations<double> error{{2, 0, -1}, {0, 5, 0}};
  std::uint64_t now_us = 1'000'000;
  const auto ticks = [&](int count, bool known) {  // commands off their ends
    for (int i = 0; i < count; ++i) {
      now_us += 2000;
      const double command = known ? 0.5 : 1.0;
      policy.learn(now_us, true, State<double>{}, {command, 0.5, 0.5, 0.5});
      policy.integrate(error);
    }
  };
  ticks(1, true);  // of the first tick no time is known
  const Vector3<double> first = policy.across_m_s2({});
  ticks(500, true);
  CHECK((first - policy.across_m_s2({}) - Vector3<double>(2, 0, -1) * Policy::linear_1_s).norm() <= 1e-9);
  const Vector3<double> before = policy.across_m_s2({});
  ticks(500, false);
  CHECK(policy.across_m_s2({}) == before);
  ticks(10'000, true);
  CHECK(policy.across_m_s2({})[0] == doctest::Approx(-Policy::most_m_s2));
  policy.learn(now_us + 2000, true, State<double>{}, {0.5, 0.5, 0.5, 0.5});
  policy.integrate({{std::numeric_limits<double>::quiet_NaN(), 0, 0}, {0, 0, 0}});
  CHECK(policy.across_m_s2({})[0] == doctest::Approx(-Policy::most_m_s2));
}

TEST_CASE("policies around each other both learn") {
  std::uint64_t now_us = 1'000'000;
  using Integral = IntegralInverse<double, Scripted>;
  AdaptiveInverse<double, Integral> outer(Integral({0.5}), airframe());
  IntegralInverse<double, AdaptiveInverse<double, Scripted>> inner({{0.5}, airframe()});
  State<double> state;
  for (int i = 0; i < 1500; ++i) {  // 0.04 of the sum, and an error of 1 m/s^2
    now_us += 2000;
    outer.learn(now_us, true, state, {0.51, 0.51, 0.51, 0.51});
    inner.learn(now_us, true, state, {0.51, 0.51, 0.51, 0.51});
    outer.integrate({{0.5, 0, 0}, {0, 0, 0}});
    inner.integrate({{0.5, 0, 0}, {0, 0, 0}});
  }
  Commands<double> commands{};
  REQUIRE(inner(state, {}, now_us, commands) == Status::ok);
  CHECK(commands[0] == doctest::Approx(0.51));
  CHECK(outer.inverse().across_m_s2(state)[0] == doctest::Approx(-1.5).epsilon(0.01));
}

TEST_CASE("a bias beyond its bound hands over to the reserve with its own, and comes back below half of it") {
  Both both = of({0.5}, {0.6}, narrow(0.4));
  const auto handed_over = [&both] { return both.learner().handed_over(); };
  std::uint64_t now_us = 1'000'000;
  Status status = Status::ok;
  hover(both, 0.51, 3, now_us);  // 0.04 of the sum: within its bound
  CHECK(answer_of(both, now_us, status) == doctest::Approx(0.51));
  CHECK((status == Status::ok && !handed_over()));
  hover(both, 0.65, 0.5, now_us);
  CHECK(!handed_over());
  hover(both, 0.65, 3, now_us);
  CHECK(handed_over());
  CHECK(answer_of(both, now_us, status) == doctest::Approx(0.65));
  CHECK(status == Status::fell_back);
  hover(both, 0.57, 6, now_us);  // 0.7 of its bound
  CHECK(handed_over());
  hover(both, 0.51, 1.8, now_us);
  CHECK(handed_over());
  hover(both, 0.65, 0.5, now_us);  // taken off
  hover(both, 0.51, 0.4, now_us);
  CHECK(handed_over());
  hover(both, 0.51, 1, now_us);
  CHECK(!handed_over());
  CHECK(answer_of(both, now_us, status) == doctest::Approx(0.51).epsilon(1e-3));
  CHECK(status == Status::ok);
}

TEST_CASE("a bias that is beyond its bound now and then hands over too") {
  BiasSettings<double> at_once = narrow(0.4);
  at_once.time_constants_s = {0, 0, 0, 0};
  Both both = of({0.5}, {0.6}, at_once);
  std::uint64_t now_us = 1'000'000;
  const auto swing = [&](double within_s) {
    for (int i = 0; i < 40; ++i) {
      hover(both, 0.65, 0.1, now_us);
      hover(both, 0.51, within_s, now_us);
    }
  };
  swing(1.9);  // a twentieth of the time: it stays
  CHECK(!both.learner().handed_over());
  swing(0.1);
  CHECK(both.learner().handed_over());
  CHECK(!both.at_bound());
  hover(both, 0.51, 3, now_us);
  CHECK(!both.learner().handed_over());
}

TEST_CASE("where both stand at their bounds, as with a payload that none carries, the first stays; a gap is no time") {
  Both both = of({0.5}, {0.5}, narrow(0.1));
  std::uint64_t now_us = 1'000'000;
  hover(both, 0.65, 5, now_us);
  CHECK(both.at_bound());
  CHECK(!both.learner().handed_over());
  Both gaps = of({0.5}, {0.6}, narrow(0.4));
  hover(gaps, 0.65, 0.6, now_us);
  CHECK(gaps.at_bound());
  for (int i = 0; i < 20; ++i) {
    now_us += 150'000;
    hover(gaps, 0.65, 0.002, now_us);
  }
  CHECK(!gaps.learner().handed_over());
}

TEST_CASE(
    "where the first declines the reserve answers, and its bias goes along; where both do, its Status and nothing") {
  Both one = of({0.5, Status::outside_envelope}, {0.6});
  Status status = Status::ok;
  CHECK(answer_of(one, 0, status) == 0.6);
  CHECK(status == Status::fell_back);
  std::uint64_t now_us = 1'000'000;
  hover(one, 0.65, 5, now_us);
  CHECK(one.bias().sums()[0] == doctest::Approx(0.2));
  CHECK(one.bias().sums() == one.learner().last().sums());
  Both none = of({0.5, Status::outside_envelope}, {0.6, Status::no_solution});
  CHECK(answer_of(none, 0, status) == 0.0);
  CHECK(status == Status::outside_envelope);
  hover(none, 0.65, 5, now_us);
  CHECK(none.bias().learnt().waited_s > 4);
  CHECK(none.learner().last().learnt().waited_s > 4);
}

TEST_CASE(
    "on the ground the biases are forgotten, where a tick freezes they stay, out of flight the first answers again") {
  using Learner = detail::BiasLearner<double, 2>;
  Learner learner(airframe(), narrow(0.4), FlownMotion<double>{});
  Learner::Tick tick;
  tick.now_us = 1'000'000;
  const auto fly = [&](double command, double duration_s) {
    const auto said_by = [](double answer) {
      return [answer](const MotionInputs<double>&, Commands<double>& said, Vector3<double>&) noexcept {
        said = {answer, answer, answer, answer};
        return Status::ok;
      };
    };
    for (int i = 0; i < static_cast<int>(std::lround(duration_s / 0.002)); ++i) {
      tick.now_us += 2000;
      learner.motion().velocity(tick.now_us, Vector3<double>::Zero());
      learner.motion().body_rates(tick.now_us, Vector3<double>::Zero());
      learner.learn(tick, {}, {command, command, command, command}, said_by(0.5), said_by(0.6));
    }
  };
  tick.known = true;
  fly(0.65, 3);
  CHECK(learner.handed_over());
  const SignedSums<double> own = learner.own().sums(), last = learner.last().sums();
  tick.freezes = true;
  fly(0.3, 3);
  CHECK(learner.own().sums() == own);
  CHECK(learner.last().sums() == last);
  CHECK(learner.last().status() == Status::ok);
  tick.in_flight = tick.known = tick.freezes = false;
  fly(0.3, 0.002);
  CHECK(!learner.handed_over());
  CHECK(learner.own().sums() == own);
  tick.on_ground = true;
  fly(0.3, 0.002);
  CHECK(learner.own().sums() == SignedSums<double>{});
  CHECK(learner.last().sums() == SignedSums<double>{});
}

TEST_CASE("rotors follow: 1 - (lag / (lag + h))^n of a step, a delay later, at ticks that are not even") {
  for (const double delay_s : {0.0, 0.007, 0.04}) {
    detail::RotorFollower<double> rotors(0.05, delay_s);
    rotors.restart({0.2, 0.2, 0.2, 0.2});
    std::uint64_t now_us = 5'000'000;
    double expected = 0.2;
    struct Kept {
      std::uint64_t time_us;
      double command;
    };
    std::vector<Kept> past;
    bool known = false;
    for (int i = 0; i < 400; ++i) {
      const std::uint64_t step_us = i % 3 == 0 ? 1000 : 2500;
      now_us += step_us;
      const double h = 1e-6 * static_cast<double>(step_us);
      expected += h / (0.05 + h) * (0.8 - expected);
      past.push_back({now_us, expected});
      known = rotors.follow(now_us, h, {0.8, 0.8, 0.8, 0.8});
      if (!known) {
        CHECK(now_us < 5'000'000 + 1e6 * delay_s + 2500);
        continue;
      }
      // the oldest kept that is no younger than the delay, to the spacing of what is kept
      const double wanted_us = static_cast<double>(now_us) - 1e6 * delay_s;
      const double spacing_us = 1e6 * delay_s / 20 + 2500;
      double least = 1, most = 0;
      for (const Kept& kept : past) {
        const double behind_us = wanted_us - static_cast<double>(kept.time_us);
        if (behind_us < -0.5 || behind_us > spacing_us) continue;
        least = std::fmin(least, kept.command);
        most = std::fmax(most, kept.command);
      }
      CHECK((rotors.then()[0] >= least - 1e-12 && rotors.then()[0] <= most + 1e-12));
    }
    CHECK(known);
  }
}
