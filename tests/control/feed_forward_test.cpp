// SPDX-License-Identifier: MIT
// Feed-forward by a network: where it answers, its commands; where it declines, a Status and nothing else.
#include "pinnquad/control/feed_forward.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "pinnquad/inference/guard.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"
#include "support/small_model_variants.hpp"

using namespace pinnquad;

namespace {

using Answering = InverseDynamics<test::SmallModel, Guard<FiniteInputs>>;
using Declining = InverseDynamics<test::NowhereTrained>;

constexpr Commands<double> earlier = {0.11, 0.22, 0.33, 0.44};

State<double> hovering() {
  State<double> state;
  state.position_m = Vector3<double>(0, 0, -20);
  return state;
}

}  // namespace

TEST_CASE("the network's commands are handed on, each to its motor") {
  NetworkInverse<Answering> policy{Answering{}};
  Accelerations<double> desired;
  desired.angular_rad_s2 = Vector3<double>(5, -3, 1);
  Commands<double> commands = earlier;
  REQUIRE(policy(hovering(), desired, 500'000, commands) == Status::ok);

  Commands<float> alone{};
  MotionInputs<float> in;
  in.angular_acceleration_rad_s2 = Vector3<float>(5, -3, 1);
  REQUIRE(Answering{}.predict(in, alone) == Status::ok);
  for (std::size_t motor = 0; motor < commands.size(); ++motor) {
    CHECK(commands[motor] == static_cast<double>(alone[motor]));
  }
  CHECK(policy.count().asked == 1);
  CHECK(policy.count().of(Status::ok) == 1);
}

TEST_CASE("where the network declines, the commands stay as they were") {
  NetworkInverse<Declining> policy{Declining{}};
  Commands<double> commands = earlier;
  CHECK(policy(hovering(), {}, 500'000, commands) == Status::outside_envelope);
  CHECK(commands == earlier);
  CHECK(policy.count().fallbacks() == 1);

  State<double> lost = hovering();
  lost.velocity_m_s[1] = std::numeric_limits<double>::quiet_NaN();
  CHECK(policy(lost, {}, 600'000, commands) == Status::not_finite);
  CHECK(commands == earlier);
  CHECK(policy.count().of(Status::not_finite) == 1);
}

namespace {

constexpr std::uint64_t hour_us = 3'600'000'000, day_us = 24 * hour_us;

/// Features with a past of 60 ms, which keep the taps' body rates apart: the window, not the model, is what is asked
/// here.
struct Recorder {
  using Scalar = float;
  using Features = Windowed<PaperFeatures, 4, PeriodMicroseconds<20'000>>;
  using Inputs = Features::Inputs<float>;
  struct Report {
    Status cause{Status::ok};
  };
  Inputs* seen;
  Status* checked;

  template <class Real>
  Status predict(const Inputs& inputs, const PlaceAndTime<Real>&, Commands<float>& commands,
                 Report& report) const noexcept {
    *seen = inputs;
    report.cause = *checked = Features::check(inputs);
    commands.fill(0.5F);
    return report.cause;
  }
};

}  // namespace

TEST_CASE_TEMPLATE("a window of a loop that has run for long is that of one that has just begun", Scalar, float,
                   double) {
  // body rates that rise by 1 rad/s in a second, in ticks of 2.5 ms: a tap's rate says how long ago it was
  constexpr std::uint64_t tick_us = 2'500;
  constexpr float rounding = 2e-6F;
  for (const std::uint64_t start_us : {std::uint64_t(0), 10 * hour_us, 30 * day_us, 400 * day_us}) {
    Recorder::Inputs seen;
    Status checked = Status::ok;
    NetworkInverse<Recorder> policy{Recorder{&seen, &checked}};
    int complete = 0;
    for (std::uint64_t tick = 0; tick < 100; ++tick) {
      State<Scalar> state;
      state.body_rates_rad_s[0] = Scalar(1e-6) * Scalar(tick * tick_us);
      Commands<Scalar> commands{};
      const Status status = policy(state, {}, start_us + tick * tick_us, commands);
      CAPTURE(start_us);
      CAPTURE(tick);
      REQUIRE(status == (tick * tick_us < 60'000 ? Status::warming_up : Status::ok));
      if (status != Status::ok) continue;
      ++complete;
      for (std::size_t tap = 0; tap < 3; ++tap) {
        const float ago_s = seen.body_rates_rad_s[0] - seen.others[tap].body_rates_rad_s[0];
        REQUIRE(std::abs(ago_s - 0.02F * static_cast<float>(tap + 1)) <= rounding);
      }
    }
    CHECK(complete == 76);
  }
}
