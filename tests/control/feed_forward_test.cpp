// SPDX-License-Identifier: MIT
// Feed-forward by a network: where it answers, its commands; where it declines, a Status and nothing else.
#include "pinnquad/control/feed_forward.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "pinnquad/inference/guard.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"
#include "support/small_model_variants.hpp"

using namespace pinnquad;

namespace {

using Answering = InverseDynamics<test::SmallModel, Guard<FiniteInputs, FiniteOutputs>>;
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
  REQUIRE(policy(hovering(), desired, 0.5, commands) == Status::ok);

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
  CHECK(policy(hovering(), {}, 0.5, commands) == Status::outside_envelope);
  CHECK(commands == earlier);
  CHECK(policy.count().fallbacks() == 1);

  State<double> lost = hovering();
  lost.velocity_m_s[1] = std::numeric_limits<double>::quiet_NaN();
  CHECK(policy(lost, {}, 0.6, commands) == Status::not_finite);
  CHECK(commands == earlier);
  CHECK(policy.count().of(Status::not_finite) == 1);
}
