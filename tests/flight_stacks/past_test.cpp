// SPDX-License-Identifier: MIT
// The cores with a model of a window and of the battery voltage: what it is asked is the window of the motions wanted
// and the voltage, what is missing is the analytic inverse's, a model of the motion alone has nothing of it.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>

#include "model_blocks.hpp"
#include "past_model.hpp"
#include "stacks.hpp"

namespace {

using namespace pinnquad::autopilot::test;
using pinnquad::Status;
using pinnquad::autopilot::NeuralController;
using pinnquad::autopilot::Reaction;
using pinnquad::autopilot::Recorded;
using pinnquad::autopilot::voltage_bit;
using pinnquad::autopilot::voltage_limit_us;

using Px4Past = Px4StackOf<PastModel>;
using CrazyflieAtRest = CrazyflieStackOf<PastModel>;

/// A stack at rest on its set point, in ticks of its own.
template <class Stack>
struct Rest {
  Stack stack;
  std::uint64_t now_us = 1'000'000;
  double volts = 15, roll_rad_s = 0;
  bool battery = true;
  int moved = 0;  ///< resets of the estimator

  Rest() {
    const Block block = sound_block<PastModel>();
    block_ = block;
    REQUIRE(stack.offer(block_.data(), block_.size()) == Status::ok);
  }
  Answer tick() {
    now_us += 1000 * Stack::period_ms;
    stack.rates(now_us, {roll_rad_s, 0, 0});
    stack.attitude(now_us, {1, 0, 0, 0});
    stack.local(now_us, {0, 0, -10}, {0, 0, 0});
    pinnquad::TrajectoryPoint<double> point;
    point.position_m = {0, 0, -10};
    stack.set_point(now_us, point);
    if (battery) stack.battery(now_us, volts);
    return stack.run(now_us);
  }
  Answer ticks_for(int ms) {
    Answer answer;
    for (int i = 0; i < ms; i += Stack::period_ms) answer = tick();
    return answer;
  }

 private:
  Block block_;
};

double mean(const Answer& answer) {
  double sum = 0;
  for (const double u : answer.commands) sum += u;
  return sum / 4;
}
/// Of the left rotors over the right ones.
double roll(const Answer& answer) {
  const auto& u = answer.commands;
  return u[1] + u[2] - u[0] - u[3];
}

}  // namespace

TEST_CASE_TEMPLATE("the window is complete after its length, then the model answers", Stack, Px4Past, CrazyflieAtRest) {
  Rest<Stack> rest;
  for (int ms = Stack::period_ms; ms <= 40; ms += Stack::period_ms) {
    const Answer answer = rest.tick();
    CHECK(answer.reaction == Reaction::flies);
    CHECK(answer.cause == Status::warming_up);
    CHECK(answer.status == Status::fell_back);
  }
  const Answer answer = rest.tick();
  CHECK(answer.cause == Status::ok);
  CHECK(answer.status == Status::ok);
}

TEST_CASE_TEMPLATE("the voltage of now counts, the motions of before count by their weights", Stack, Px4Past,
                   CrazyflieAtRest) {
  Rest<Stack> rest;
  const double calm = mean(rest.ticks_for(100));
  rest.volts = 14;
  CHECK(mean(rest.tick()) - calm == doctest::Approx(-double(PastModel::per_volt)).epsilon(1e-3));
  for (const double volts : {PastModel::most_V, PastModel::most_V + 1, 60.0}) {  // beyond the training: as at its edge
    rest.volts = volts;
    const Answer answer = rest.tick();
    CHECK(answer.status == Status::ok);
    CHECK(mean(answer) - calm == doctest::Approx(double(PastModel::per_volt)).epsilon(1e-3));
  }
  rest.volts = 15;
  static_cast<void>(rest.ticks_for(100));
  // a step of the angular acceleration wanted: its share is that of the taps that it has reached, to the few
  // milliseconds that lie between two samples of the history
  rest.roll_rad_s = -0.05;
  const double first = roll(rest.tick()), second = roll(rest.ticks_for(26)), third = roll(rest.ticks_for(20));
  CHECK(first > 0);
  const auto share = [](int taps) {
    double of = 0;
    for (int tap = 0; tap < taps; ++tap) of += PastModel::tap_weight(tap);
    return of;
  };
  CHECK(first / third == doctest::Approx(share(1)).epsilon(0.01));
  CHECK(second / third == doctest::Approx(share(2)).epsilon(0.01));
  CHECK(share(3) == doctest::Approx(1));
}

TEST_CASE_TEMPLATE("without a battery voltage the analytic inverse flies, and the report says so", Stack, Px4Past,
                   CrazyflieAtRest) {
  Rest<Stack> rest;
  static_cast<void>(rest.ticks_for(100));
  SUBCASE("bad ones are none") {
    const unsigned refused = rest.tick().refused_samples;
    unsigned bad = 0;
    for (const double volts : {0.0, -1.0, double(NAN), double(INFINITY), 2e6}) {
      rest.volts = volts;
      const Answer answer = rest.tick();
      CHECK(answer.status == Status::ok);  // the last good one is in force
      CHECK(answer.refused_samples == refused + ++bad);
    }
  }
  SUBCASE("it ages") {
    rest.battery = false;
    if (Stack::period_ms == 2) rest.battery = true, rest.volts = 0;  // the Crazyflie's is given in each tick
    CHECK(rest.ticks_for(int(voltage_limit_us / 1000)).status == Status::ok);
    const Answer answer = rest.tick();
    CHECK(answer.status == Status::fell_back);
    CHECK(answer.cause == Status::not_finite);
    CHECK(answer.reaction == Reaction::flies);
    CHECK(answer.stale_inputs == voltage_bit);
    static_cast<void>(rest.ticks_for(100));
    rest.battery = true;
    rest.volts = 15;
    CHECK(rest.tick().cause == Status::warming_up);
    CHECK(rest.ticks_for(40).status == Status::ok);
  }
}

TEST_CASE("a reset of the estimator forgets the past") {
  NeuralController<PastModel> controller;
  const Block block = sound_block<PastModel>();
  REQUIRE(controller.offer_model(block.data(), block.size()) == Status::ok);
  std::uint64_t now_us = 0;
  const auto tick = [&] {
    now_us += 2000;
    static_cast<void>(controller.body_rates(now_us, {0, 0, 0}));
    static_cast<void>(controller.attitude(now_us, {1, 0, 0, 0}));
    static_cast<void>(controller.local(now_us, {{0, 0, -10}, {0, 0, 0}}));
    static_cast<void>(controller.battery_voltage(now_us, 15));
    pinnquad::TrajectoryPoint<float> point;
    point.position_m = {0, 0, -10};
    static_cast<void>(controller.set_point(now_us, point));
    pinnquad::Commands<float> commands{};
    pinnquad::autopilot::StepReport report;
    controller.step(now_us, commands, report);
    return report.cause;
  };
  for (int i = 0; i < 50; ++i) static_cast<void>(tick());
  CHECK(tick() == Status::ok);
  controller.jump({{0, 0, 1}, {0, 0, 0}}, 0);
  CHECK(tick() == Status::warming_up);
  // another hand on the motors for longer than a gap
  for (int i = 0; i < 50; ++i) static_cast<void>(tick());
  CHECK(tick() == Status::ok);
  now_us += 31'000;
  CHECK(tick() == Status::warming_up);
}

TEST_CASE("a model of the motion alone has nothing of it") {
  using Plain = NeuralController<DemoQuadModel>;
  static_assert(!Plain::asks_for_voltage && NeuralController<PastModel>::asks_for_voltage);
  static_assert(std::is_empty_v<pinnquad::autopilot::detail::ModelInputs<DemoQuadModel::Features>>);
  Recorded<Plain> controller;
  CHECK(controller.battery_voltage(1000, std::numeric_limits<float>::quiet_NaN()) == Status::ok);
  CHECK(controller.refused_samples() == 0);
  pinnquad::Commands<float> commands{};
  pinnquad::autopilot::StepReport report;
  controller.step(1000, commands, report);
  CHECK((controller.record().came & voltage_bit) == 0);
  CHECK((report.stale_inputs & voltage_bit) == 0);
}

TEST_CASE("a model of the voltage without a window: the motion that its bias learns from is kept while it is asked") {
  using Features = pinnquad::WithColumns<pinnquad::AccelerationFeatures, pinnquad::BatteryVoltage>;
  pinnquad::autopilot::detail::ModelInputs<Features> inputs;
  inputs.tick(1000);
  REQUIRE(inputs.voltage(1000, 15) == Status::ok);
  pinnquad::MotionInputs<float> motion;
  motion.velocity_m_s = {1, 2, 3};
  const auto* const asked = &inputs.lasting(motion);
  const auto at = reinterpret_cast<std::uintptr_t>(asked), first = reinterpret_cast<std::uintptr_t>(&inputs);
  REQUIRE(at >= first);
  REQUIRE(at < first + sizeof inputs);
  CHECK(asked->velocity_m_s == motion.velocity_m_s);
  CHECK(asked->columns[0] == 15);
}
