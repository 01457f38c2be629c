// SPDX-License-Identifier: MIT
// The learner of a vehicle in both cores: the commands of the loop's policy, to the bit; and what must never make a
// swap.
#include <doctest/doctest.h>

#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "onboard_stacks.hpp"
#include "pinnquad/control/tracking_controller.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/deploy/learnt_model.hpp"
#include "pinnquad/deploy/weight_file.hpp"

namespace {

using namespace pinnquad::autopilot::test;
using namespace pinnquad;
using autopilot::CoreRecord;
using autopilot::CoreSettings;
using autopilot::Learning;
using autopilot::Reaction;
using autopilot::Situation;

/// A question that a policy was asked in flight, its answer before it was desaturated, and its bias.
struct Asked {
  MotionInputs<float> motion;
  Commands<float> answer;
  SignedSums<float> bias;
};

/// The policy of a loop, held elsewhere. `asked`: what it is asked while it is frozen, where somebody wants to know.
struct Held {
  OnboardInverse<float>* policy;
  std::vector<Asked>* asked = nullptr;

  Status operator()(const State<float>& state, const Accelerations<float>& wanted, std::uint64_t now_us,
                    Commands<float>& commands) noexcept {
    const Status status = (*policy)(state, wanted, now_us, commands);
    if (asked != nullptr) asked->push_back({motion_inputs(state, wanted), commands, policy->bias().sums()});
    return status;
  }
  void learn(std::uint64_t now_us, bool known, const State<float>& state, const Commands<float>& commands) noexcept {
    policy->learn(now_us, known, state, commands);
  }
  Vector3<float> across_m_s2(const State<float>& state) const noexcept { return policy->across_m_s2(state); }
};

CoreSettings settings() {
  CoreSettings result;
  result.lowest_command = 0;  // a loop's rotors may stand still
  return result;
}

/// A flight of a core; `on_tick(record)`.
template <class Stack>
struct StrangeFlight {
  Stack stack{settings()};
  StrangeVehicle<Stack> vehicle;
  Block block = sound_block<typename Stack::Model>();
  Learning learning = Learning::excites;
  bool drives_motors = true;
  long tick = 0;
  double worst_m = 0;
  int takeovers = 0;
  Commands<double> commands{};

  StrangeFlight() { REQUIRE(stack.offer(block.data(), block.size()) == Status::ok); }

  template <class OnTick>
  void fly(double until_s, const OnTick& on_tick) {
    for (; static_cast<double>(tick) * vehicle.tick_s < until_s; ++tick) {
      const double time_s = static_cast<double>(tick) * vehicle.tick_s;
      const std::uint64_t now_us = vehicle.time_us(tick);
      const TrajectoryPoint<double> point = strange_course(time_s);
      worst_m = std::max(worst_m, (point.position_m - vehicle.body().position_m).norm());
      vehicle.feed(stack, tick, now_us, point);
      stack.situation({drives_motors, false, learning});
      const Answer answer = stack.run(now_us);
      on_tick(stack.record());
      if (answer.has_commands) {
        commands = answer.commands;
      } else {
        ++takeovers;
      }
      REQUIRE(vehicle.fly(commands));
    }
  }
  void fly(double until_s) {
    fly(until_s, [](const CoreRecord&) {});
  }
  unsigned proven() const { return stack.record().learnt & CoreRecord::learnt_sums; }
};

State<float> state_of(const CoreRecord& r) {
  State<float> state;
  state.position_m = Vector3<float>(r.position_m);
  state.velocity_m_s = Vector3<float>(r.velocity_m_s);
  state.attitude = normalized(Quaternion<float>{r.attitude[0], r.attitude[1], r.attitude[2], r.attitude[3]});
  state.body_rates_rad_s = Vector3<float>(r.body_rates_rad_s);
  return state;
}
TrajectoryPoint<float> point_of(const CoreRecord& r) {
  TrajectoryPoint<float> point;
  point.position_m = Vector3<float>(r.wanted_position_m);
  point.velocity_m_s = Vector3<float>(r.wanted_velocity_m_s);
  point.acceleration_m_s2 = Vector3<float>(r.wanted_acceleration_m_s2);
  point.jerk_m_s3 = Vector3<float>(r.wanted_jerk_m_s3);
  point.yaw_rad = r.wanted_yaw_rad;
  point.yaw_rate_rad_s = r.wanted_yaw_rate_rad_s;
  return point;
}

/// Slopes of what flies over the truth.
template <class Stack>
std::array<double, 4> over_truth(const OnboardInverse<float>::Certificate& certificate) {
  const auto truth = forward_model(StrangeVehicle<Stack>::airframe());
  std::array<double, 4> result{};
  for (std::size_t k = 0; k < 4; ++k) {
    result[k] = static_cast<double>(certificate[k].forward.slope()) / truth[k].slope();
  }
  return result;
}

}  // namespace

TEST_CASE_TEMPLATE("a core that learns makes the commands of the loop's policy, to the bit", Stack, OnboardPx4Stack,
                   OnboardCrazyflieStack) {
  StrangeFlight<Stack> flight;
  const auto airframe = airframe_value<typename Stack::Model::Vehicle, float>();
  OnboardInverse<float> policy(airframe);
  const auto outer_loop = [](const Airframe<float>& of) {
    return autopilot::detail::outer_loop(settings(), of, standard_gravity_m_s2<float>);
  };
  std::vector<Asked> asked;
  TrackingController<float, Held> loop(airframe, outer_loop(airframe), Held{&policy, &asked});
  LearntRows model_rows;
  std::uint32_t rows = 0;
  std::size_t ticks = 0;
  std::uint64_t excited_us = 0, before_us = 0;
  const auto loop_too = [&](const CoreRecord& record) {
    if (before_us != 0) excited_us += record.timestamp - before_us;
    before_us = record.timestamp;
    policy.excite(flight.learning == Learning::excites && excited_us < 10'000'000);
    policy.freeze(flight.learning == Learning::frozen);
    if (rows != policy.rows()) loop.change_to(airframe, outer_loop(policy.airframe()));
    rows = policy.rows();
    if (flight.learning != Learning::frozen) asked.clear();
    Commands<float> commands{};
    REQUIRE(record.reaction == static_cast<std::uint8_t>(Reaction::flies));
    REQUIRE(has_output(loop(state_of(record), point_of(record), record.timestamp, commands)));
    REQUIRE(std::memcmp(commands.data(), record.commands, sizeof record.commands) == 0);
    model_rows.note(policy);
    ++ticks;
  };
  flight.fly(16, loop_too);
  flight.learning = Learning::learns;
  flight.fly(22, loop_too);
  CHECK(flight.proven() == CoreRecord::learnt_sums);
  const std::array<double, 4> slopes = over_truth<Stack>(policy.certificate());
  for (std::size_t k = 0; k < 4; ++k) {
    CAPTURE(k);
    CHECK(slopes[k] == doctest::Approx(1).epsilon(0.1));
  }
  flight.vehicle.weigh(1.3);
  flight.fly(30, loop_too);
  flight.vehicle.weigh(1);
  flight.vehicle.rotor_0 = 0.92;
  flight.learning = Learning::frozen;
  flight.fly(36, loop_too);
  CHECK(policy.rows() > 1500);
  CHECK(flight.takeovers == 0);
  CHECK(flight.worst_m < 1);
  CHECK(ticks == static_cast<std::size_t>(36'000 / Stack::period_ms));

  // written as a block on the ground, the model answers what flew: to the bit, but for the bias that flew beside it
  const auto model = learnt_model(policy, "strange", model_rows);
  const Provenance provenance = learnt_provenance(policy, "a test", model_rows);
  const BlockModel block("learnt.block", model_block(model, model_rows.some<float>(), provenance, "LearntModel"));
  CHECK(model_rows.rows().size() == policy.rows());
  CHECK(block.provenance("training_data") == "learnt in flight: a test");
  CHECK(block.provenance("loss").find("proven in flight: thrust, roll, pitch, yaw") != std::string::npos);
  const std::optional<Certificate> certificate = block.certificate();
  REQUIRE(certificate);
  CHECK(certificate->proven());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto slope = static_cast<double>(policy.certificate()[axis + 1].forward.slope());
    CHECK(certificate->slope[axis] * slope == doctest::Approx(1).epsilon(1e-6));
  }
  const pinnquad::detail::AffineInverse<float> inverse = pinnquad::detail::affine_inverse(policy.forward());
  const detail::SignedMix<float>& mix = policy.bias().mix();
  std::size_t answered = 0;
  REQUIRE(asked.size() > 1000);
  for (const Asked& one : asked) {
    std::vector<float> x(InverseFeatures::size);
    InverseFeatures::extract(one.motion, x.data());
    const Commands<double> said = block.commands({x.begin(), x.end()});
    const detail::SumMotion<float> motion = detail::sum_motion(one.motion);
    Commands<float> alone{}, with_bias{};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 4; ++k) {
        const float sum = inverse[k].of(k, motion);
        alone[i] += mix.by[i][k] * sum;
        with_bias[i] += mix.by[i][k] * (sum + (one.bias[k] + inverse[k].by_total * one.bias[0]));
      }
    }
    if (std::memcmp(with_bias.data(), one.answer.data(), sizeof one.answer) != 0) break;
    if (said != Commands<double>{alone[0], alone[1], alone[2], alone[3]}) break;
    ++answered;
  }
  CHECK(answered == asked.size());
}

TEST_CASE_TEMPLATE("off, a core with a learner answers as one without, and the network answers again after it", Stack,
                   OnboardPx4Stack) {
  StrangeFlight<Stack> flight;
  flight.learning = Learning::off;
  StrangeFlight<Px4Stack> plain;
  plain.learning = Learning::excites;  // it has no learner
  for (double until_s = 0.5; until_s < 5; until_s += 0.5) {
    flight.fly(until_s);
    plain.fly(until_s);
    REQUIRE(flight.commands == plain.commands);
  }
  CHECK(plain.stack.record().learning == 0);
  CHECK(plain.stack.record().learnt == 0);
  CHECK(flight.stack.record().learnt == 0);
  flight.learning = Learning::learns;
  flight.fly(6);
  CHECK(flight.stack.record().learnt == CoreRecord::seen_flight);
  CHECK(flight.stack.record().cause == static_cast<std::uint8_t>(Status::ok));
  flight.learning = Learning::off;
  bool begins = true;
  flight.fly(7, [&](const CoreRecord& record) {
    if (begins) {  // a bias of the network's own, from none
      CHECK(std::fabs(record.bias_sums[0]) < 0.3f * std::fabs(record.analytic_bias_sums[0]));
    }
    begins = false;
    CHECK(record.reaction == static_cast<std::uint8_t>(Reaction::flies));
  });
  CHECK(flight.stack.record().bias_status == static_cast<std::uint8_t>(Status::ok));
  CHECK(flight.worst_m < 1);
}

TEST_CASE_TEMPLATE("no number for 0.3 s is given up, and no sum is swapped for it", Stack, OnboardPx4Stack,
                   OnboardCrazyflieStack) {
  StrangeFlight<Stack> flight;
  flight.fly(14.5);
  const unsigned before = flight.proven();
  CHECK(before == CoreRecord::learnt_sums);
  flight.vehicle.no_motion = true;
  flight.fly(14.8);
  CHECK(flight.takeovers > 0);
  CHECK(flight.proven() == before);
  flight.vehicle.no_motion = false;
  const int takeovers = flight.takeovers;
  flight.fly(25);
  CHECK(flight.takeovers == takeovers);
  CHECK(flight.proven() == before);
}

TEST_CASE_TEMPLATE("without motors there is no row, and in the hand no swap", Stack, OnboardPx4Stack,
                   OnboardCrazyflieStack) {
  SUBCASE("its commands drive no motors: nobody knows what the rotors did") {
    StrangeFlight<Stack> flight;
    flight.drives_motors = false;
    flight.vehicle.held = true;
    flight.fly(12, [](const CoreRecord& record) { REQUIRE(record.learnt == 0); });
  }
  SUBCASE("held in the hand") {
    StrangeFlight<Stack> flight;
    flight.vehicle.held = true;
    flight.fly(20, [](const CoreRecord& record) { REQUIRE((record.learnt & CoreRecord::learnt_sums) == 0); });
    CHECK(flight.stack.record().learnt == CoreRecord::seen_flight);
    flight.vehicle.held = false;  // the next ten seconds of sines
    flight.learning = Learning::learns;
    flight.fly(20.1);
    flight.learning = Learning::excites;
    flight.fly(32);
    CHECK(flight.proven() != 0);
  }
}
