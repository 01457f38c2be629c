// SPDX-License-Identifier: MIT
// A vehicle learnt on board: slopes and intervals against a truth that is known, a proof before each swap, and input
// that must never make one.
#include "pinnquad/control/onboard/onboard_inverse.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include "pinnquad/control/adaptive_inverse.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"

using namespace pinnquad;

static_assert(is_feed_forward<OnboardInverse<float>, float> && learns_in_flight<OnboardInverse<float>, float> &&
              knows_across<OnboardInverse<float>, float>);

namespace {

const auto start = airframe_value<PaperQuadrotor, double>();
constexpr double tick_s = 0.002;
constexpr std::uint32_t tick_us = 2'000;

/// Four axes that turn and climb as their signed sums behind a lag say; a controller of its rates asks the policy. Its
/// attitude stays level. What happens to its samples on the way is the test's.
struct Axes {
  std::array<double, 4> slopes{};  ///< the truth
  double lag_s = 0.03, gyro_rad_s = 0.01, velocity_m_s = 0.003;
  bool held = false;
  double wind_m_s2 = 0, lift_m_s2 = 0;  ///< standard deviation of what lifts it for 1.5 s, and that
  SignedSums<double> off{};             ///< a centre of gravity that is off: so much more of each sum acts

  State<double> state{};
  SignedSums<double> followed{};
  Commands<double> commands{0.4, 0.4, 0.4, 0.4};
  std::uint64_t now_us = 1'000'000;
  std::mt19937_64 random{7}, wind{11};

  explicit Axes(const std::array<double, 4>& over_start) {
    const auto model = forward_model(start);
    for (std::size_t k = 0; k < 4; ++k) slopes[k] = over_start[k] * model[k].slope();
    followed = detail::LagBank<double>::sums_of(commands, detail::signed_mix(start));
  }

  State<double> measured() {
    State<double> result = state;
    for (int i = 0; i < 3; ++i) {
      result.body_rates_rad_s[i] += gyro_rad_s * standard_normal(random);
      result.velocity_m_s[i] += velocity_m_s * standard_normal(random);
    }
    return result;
  }
  void step() {
    const SignedSums<double> sums = detail::LagBank<double>::sums_of(commands, detail::signed_mix(start));
    for (std::size_t k = 0; k < 4; ++k) followed[k] += tick_s / (lag_s + tick_s) * (sums[k] - followed[k]);
    now_us += tick_us;
    if (held) return;
    for (int i = 0; i < 3; ++i) {
      state.body_rates_rad_s[i] += tick_s * slopes[static_cast<std::size_t>(i) + 1] *
                                   (followed[static_cast<std::size_t>(i) + 1] + off[static_cast<std::size_t>(i) + 1]);
    }
    constexpr double share = tick_s / 1.5;
    lift_m_s2 += -share * lift_m_s2 + wind_m_s2 * std::sqrt(2 * share) * standard_normal(wind);
    state.velocity_m_s[2] += tick_s * (slopes[0] * followed[0] + lift_m_s2 + standard_gravity_m_s2<double>);
  }
};

/// `shown(axes, seconds, state, known, commands)` changes what the policy is shown.
template <class Shown>
void fly(Axes& axes, OnboardInverse<double>& policy, double seconds, const Shown& shown) {
  const int ticks = static_cast<int>(std::lround(seconds / tick_s));
  for (int i = 0; i < ticks; ++i) {
    const State<double> measured = axes.measured();
    State<double> state = measured;
    Commands<double> commands = axes.commands;
    bool known = true;
    shown(i * tick_s, state, known, commands);
    policy.learn(axes.now_us, known, state, commands);
    Accelerations<double> wanted;
    wanted.linear_m_s2[2] = -2 * measured.velocity_m_s[2];
    for (int axis = 0; axis < 3; ++axis) {
      wanted.angular_rad_s2[axis] = -(axis == 2 ? 4 : 10) * measured.body_rates_rad_s[axis];
    }
    REQUIRE(policy(measured, wanted, axes.now_us, axes.commands) == Status::ok);
    axes.commands = clipped(axes.commands);
    axes.step();
  }
}
const auto as_measured = [](double, State<double>&, bool&, Commands<double>&) {};

bool proven(const OnboardInverse<double>& policy) {
  bool any = false;
  for (const auto& sum : policy.certificate()) any = any || sum.proven;
  return any;
}
std::string refusals(const OnboardInverse<double>& policy) {
  std::string said;
  for (const auto& sum : policy.certificate()) said += std::string(to_string(sum.refused_last)) + " ";
  return said;
}

}  // namespace

TEST_CASE("after ten seconds of sines every sum flies within its interval, and that is narrower than 15 %") {
  for (const auto& truth : {std::array<double, 4>{1.3, 0.6, 1.5, 0.7}, std::array<double, 4>{0.75, 1.4, 0.65, 1.6}}) {
    Axes axes(truth);
    OnboardInverse<double> policy(start);
    policy.excite(true);
    fly(axes, policy, 12, as_measured);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& sum = policy.certificate()[k];
      CAPTURE(k);
      CAPTURE(sum.forward.slope() / axes.slopes[k]);
      CAPTURE(std::string(to_string(sum.refused_last)));
      CHECK(sum.proven);
      CHECK(sum.half_width < 0.15 * std::abs(axes.slopes[k]));
      CHECK(std::abs(sum.forward.slope() - axes.slopes[k]) <= sum.half_width);
      CHECK(std::abs(policy.certificate()[k].forward.slope() / axes.slopes[k] - 1) < 0.05);
    }
    // and the airframe for limits has these slopes
    const auto flown = forward_model(policy.airframe());
    for (std::size_t k = 0; k < 4; ++k) {
      CHECK(std::abs(flown[k].slope() / policy.certificate()[k].forward.slope() - 1) < 1e-12);
    }
  }
}

TEST_CASE("a young bias has seven tenths of what is off after 0.3 s, by its own time constants it has not") {
  for (const bool young : {true, false}) {
    Axes axes({1, 1, 1, 1});
    axes.off[1] = 0.05;
    OnboardSettings<double> settings;
    if (!young) settings.young_bias_s = settings.bias.time_constants_s[1];
    OnboardInverse<double> policy(start, settings);
    fly(axes, policy, 0.3, as_measured);
    CAPTURE(policy.bias().sums()[1]);
    CHECK((std::abs(policy.bias().sums()[1] + 0.05) < 0.015) == young);
  }
}

TEST_CASE("before anything is proven the start flies: sums of the airframe's own rigid body") {
  OnboardInverse<double> policy(start);
  policy.freeze(true);
  Accelerations<double> wanted;
  wanted.linear_m_s2[2] = -1;
  wanted.angular_rad_s2 = {3, -2, 0.5};
  Commands<double> commands{};
  REQUIRE(policy({}, wanted, 1'000'000, commands) == Status::ok);
  const SignedSums<double> sums = detail::LagBank<double>::sums_of(commands, detail::signed_mix(start));
  const auto model = forward_model(start);
  CHECK(std::abs(model[0].slope() * sums[0] - (-1 - standard_gravity_m_s2<double>)) < 1e-9);
  for (std::size_t k = 1; k < 4; ++k) {
    CHECK(std::abs(model[k].slope() * sums[k] - wanted.angular_rad_s2[static_cast<int>(k) - 1]) < 1e-9);
  }
}

TEST_CASE("a vehicle that stands or is held makes nothing of its sines, and is never swapped") {
  Axes axes({1.3, 0.6, 1.5, 0.7});
  axes.held = true;
  OnboardInverse<double> policy(start);
  policy.excite(true);
  fly(axes, policy, 60.3, as_measured);
  CHECK_FALSE(proven(policy));
  CHECK(refusals(policy) == "still still still still ");
  // and what it was taught on the ground is no part of what it learns in the air
  axes.held = false;
  fly(axes, policy, 16, as_measured);
  for (std::size_t k = 0; k < 4; ++k) {
    CAPTURE(k);
    CAPTURE(refusals(policy));
    CHECK(policy.certificate()[k].proven);
    CHECK(std::abs(policy.certificate()[k].forward.slope() / axes.slopes[k] - 1) < 0.05);
  }
}

TEST_CASE("a propeller on wrong turns the sum's sign: refused as impossible") {
  Axes axes({1, 1, 1, -0.5});
  OnboardSettings<double> settings;
  settings.bias.most[3] = 0;
  OnboardInverse<double> policy(start, settings);
  policy.excite(true);
  fly(axes, policy, 4, [&](double, State<double>& state, bool&, Commands<double>&) { static_cast<void>(state); });
  const auto& yaw = policy.certificate()[3];
  CHECK_FALSE(yaw.proven);
  CAPTURE(refusals(policy));
  CHECK((yaw.refused_last == OnboardRule::slope_impossible || yaw.refused_last == OnboardRule::few_rows));
}

TEST_CASE("samples that are frozen, no numbers or not known, and rotors that are missing, make no row") {
  const double no_number = std::numeric_limits<double>::quiet_NaN();
  State<double> ice;
  ice.velocity_m_s = {0.1, 0.2, 0.3};
  const auto frozen = [&](double, State<double>& state, bool&, Commands<double>&) { state = ice; };
  const auto nan = [&](double, State<double>& state, bool&, Commands<double>&) {
    state.body_rates_rad_s[1] = no_number;
  };
  const auto late = [&](double, State<double>&, bool& known, Commands<double>&) { known = false; };
  const auto missing = [&](double, State<double>&, bool&, Commands<double>& commands) { commands[2] = no_number; };
  const auto at_end = [&](double, State<double>&, bool&, Commands<double>& commands) { commands[2] = 1; };
  const auto never = [&](const auto& shown, double learns_within_s = 12) {
    Axes axes({1.3, 0.6, 1.5, 0.7});
    OnboardInverse<double> policy(start);
    policy.excite(true);
    fly(axes, policy, 8, shown);
    CHECK(policy.rows() == 0);
    CHECK_FALSE(proven(policy));
    CHECK(refusals(policy) == "few_rows few_rows few_rows few_rows ");
    // and it learns as soon as they come
    fly(axes, policy, learns_within_s, as_measured);
    CHECK(policy.certificate()[1].proven);
    const auto& roll = policy.certificate()[1];
    CHECK(std::abs(roll.forward.slope() - axes.slopes[1]) <= roll.half_width);
  };
  SUBCASE("frozen") { never(frozen); }
  SUBCASE("no numbers") { never(nan); }
  SUBCASE("late: not known") { never(late); }
  SUBCASE("no rotors") { never(missing); }
  SUBCASE("at an end") { never(at_end, 20); }  // the bias has learnt of commands that did not fly
}

TEST_CASE("samples that come 50 ms late, and do not say so, never swap anything") {
  Axes axes({1.3, 0.6, 1.5, 0.7});
  OnboardInverse<double> policy(start);
  policy.excite(true);
  std::array<State<double>, 25> kept{};
  std::size_t ticks = 0;
  fly(axes, policy, 15, [&](double, State<double>& state, bool&, Commands<double>&) {
    State<double>& oldest = kept[ticks++ % kept.size()];
    std::swap(oldest, state);
  });
  CHECK_FALSE(proven(policy));
  CAPTURE(refusals(policy));
  CHECK(policy.certificate()[1].refused_last == OnboardRule::lag_unknown);
}

TEST_CASE("a wind that feedback answers hides no slope: thrust flies within its interval") {
  Axes axes({1.3, 0.6, 1.5, 0.7});
  axes.wind_m_s2 = 0.4;
  OnboardInverse<double> policy(start);
  policy.excite(true);
  fly(axes, policy, 16, as_measured);
  const auto& thrust = policy.certificate()[0];
  CAPTURE(thrust.forward.slope() / axes.slopes[0]);
  CAPTURE(refusals(policy));
  CHECK(thrust.proven);
  CHECK(std::abs(thrust.forward.slope() - axes.slopes[0]) <= thrust.half_width);
}

TEST_CASE("gyro noise as in PX4's simulation, 0.07 rad/s at 250 Hz, hides no slope: within 20 s it is proven") {
  Airframe<double> slow = start;  // nor the lag, which the start has too long
  slow.rotor_time_constant_s = 0.045;
  std::array<int, 4> proven_of_5{};
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
    Axes axes({1.3, 0.6, 1.5, 0.7});
    axes.gyro_rad_s = 0.07 * std::sqrt(2.0);  // the mean of a period's samples, twice as many here, is as far off
    axes.random.seed(seed);
    OnboardInverse<double> policy(slow);
    policy.excite(true);
    fly(axes, policy, 20, as_measured);
    CAPTURE(seed);
    CAPTURE(refusals(policy));
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& sum = policy.certificate()[k];
      CAPTURE(k);
      CAPTURE(sum.forward.slope() / axes.slopes[k]);
      CAPTURE(sum.half_width / axes.slopes[k]);
      CAPTURE(sum.forward.lag.seconds());
      proven_of_5[k] += sum.proven ? 1 : 0;
      CHECK((!sum.proven || std::abs(sum.forward.slope() - axes.slopes[k]) <= sum.half_width));
    }
  }
  CHECK(proven_of_5[0] == 5);
  CHECK(proven_of_5[1] >= 3);  // half of its interval is 14 to 16 %, and 15 the limit
  CHECK(proven_of_5[2] == 5);
}

TEST_CASE("a gap of no numbers in flight changes no proven sum") {
  Axes axes({1.3, 0.6, 1.5, 0.7});
  OnboardInverse<double> policy(start);
  policy.excite(true);
  fly(axes, policy, 12, as_measured);
  const auto before = policy.certificate();
  const std::uint32_t rows = policy.rows();
  fly(axes, policy, 0.3, [&](double, State<double>& state, bool&, Commands<double>&) {
    state.velocity_m_s[0] = std::numeric_limits<double>::infinity();
  });
  CHECK(policy.rows() - rows <= 1);
  for (std::size_t k = 0; k < 4; ++k) CHECK(policy.certificate()[k].forward.theta == before[k].forward.theta);
}

TEST_CASE("frozen, nothing is swapped; without sines and without noise of a flight nothing is proven") {
  SUBCASE("frozen") {
    Axes axes({1.3, 0.6, 1.5, 0.7});
    OnboardInverse<double> policy(start);
    policy.excite(true);
    policy.freeze(true);
    fly(axes, policy, 12, as_measured);
    CHECK_FALSE(proven(policy));
    for (const auto& sum : policy.certificate()) CHECK(sum.refused_last == OnboardRule::frozen);
    CHECK(policy.rows() > 500);
  }
  SUBCASE("no sines") {
    Axes axes({1.3, 0.6, 1.5, 0.7});
    OnboardSettings<double> settings;
    settings.excitation.share_unknown = 0;
    OnboardInverse<double> policy(start, settings);
    fly(axes, policy, 12, as_measured);
    CHECK_FALSE(proven(policy));
    CHECK(policy.certificate()[1].refused_last == OnboardRule::unexcited);
  }
}

TEST_CASE("a proven sum whose residual doubles is flown no longer: the one before it is") {
  Axes axes({1.0, 2.5, 1.0, 1.0});
  OnboardInverse<double> policy(start);
  policy.excite(true);
  fly(axes, policy, 12, as_measured);
  REQUIRE(policy.certificate()[1].proven);
  axes.slopes[1] /= 2.5;  // the start's
  bool went_back = false;
  for (int i = 0; i < 40 && !went_back; ++i) {
    fly(axes, policy, 0.1, as_measured);
    went_back = !policy.certificate()[1].proven;
  }
  CHECK(went_back);
  CHECK(std::abs(policy.certificate()[1].forward.slope() / axes.slopes[1] - 1) < 1e-12);
}

TEST_CASE("float learns what double does, to 1e-4 of the slope") {
  Axes axes({1.3, 0.6, 1.5, 0.7});
  OnboardInverse<double> policy(start);
  OnboardInverse<float> narrow(airframe_value<PaperQuadrotor, float>());
  policy.excite(true);
  narrow.excite(true);
  fly(axes, policy, 15, [&](double, State<double>& state, bool& known, Commands<double>& commands) {
    State<float> sample;
    for (int i = 0; i < 3; ++i) {
      sample.velocity_m_s[i] = static_cast<float>(state.velocity_m_s[i]);
      state.velocity_m_s[i] = static_cast<double>(sample.velocity_m_s[i]);
      sample.body_rates_rad_s[i] = static_cast<float>(state.body_rates_rad_s[i]);
      state.body_rates_rad_s[i] = static_cast<double>(sample.body_rates_rad_s[i]);
    }
    Commands<float> same{};
    for (std::size_t i = 0; i < 4; ++i) {
      same[i] = static_cast<float>(commands[i]);
      commands[i] = static_cast<double>(same[i]);
    }
    narrow.learn(axes.now_us, known, sample, same);
    Commands<float> unused{};
    CHECK(narrow(sample, {}, axes.now_us, unused) == Status::ok);
  });
  CHECK(narrow.rows() == policy.rows());
  for (std::size_t k = 0; k < 4; ++k) {
    const double other = static_cast<double>(narrow.candidate()[k].forward.slope());
    CHECK(std::abs(other / policy.candidate()[k].forward.slope() - 1) < 1e-4);
  }
  CHECK(sizeof(OnboardInverse<float>) <= 6'100);
}
