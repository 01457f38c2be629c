// SPDX-License-Identifier: MIT
// A core in mid-air answers every tick of fresh, finite inputs: whatever was asked for, the demand is limited and never
// refused.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "flight.hpp"
#include "flight_paths.hpp"
#include "pinnquad/dynamics/airframes/px4_sih.hpp"

namespace {

using namespace pinnquad::autopilot::test;
using pinnquad::Commands;
using pinnquad::autopilot::CoreRecord;
using pinnquad::autopilot::LocalState;
using pinnquad::autopilot::NeuralController;
using pinnquad::autopilot::Reaction;
using pinnquad::autopilot::StepReport;

/// Draws of one demand and motion. `far`: numbers up to the greatest that a core accepts.
class Draws {
 public:
  Draws(unsigned seed, bool far) : engine_(seed), far_(far) {}

  float within(double half) { return static_cast<float>(pinnquad::uniform(engine_, -half, half)); }
  Vector3<float> vector(double half) {
    if (far_) half = std::pow(10.0, pinnquad::uniform(engine_, -1, 5.9));
    const float x = within(half), y = within(half), z = within(half);
    return {x, y, z};
  }
  /// Any attitude where far, else one of upright flight.
  pinnquad::Quaternion<float> attitude() {
    const double most = far_ ? 3.1 : 0.8;
    const float roll = within(most), pitch = within(far_ ? 1.5 : 0.8), yaw = within(3.1);
    return pinnquad::from_euler<float>({roll, pitch, yaw});
  }

 private:
  std::mt19937_64 engine_;
  bool far_;
};

/// Ticks without an answer, of `count` with fresh inputs each.
template <class Model, class FlownAirframe>
int unanswered(const Block& block, bool far, int count) {
  using Controller = NeuralController<Model>;
  const typename Controller::Vehicle vehicle(pinnquad::airframe_value<FlownAirframe, float>());
  Controller controller(vehicle);
  REQUIRE(controller.offer_model(block.data(), block.size()) == Status::ok);
  Draws draw(1, far);
  std::uint64_t now_us = 1'000'000;
  int missing = 0;
  for (int tick = 0; tick < count; ++tick, now_us += 1000) {
    const LocalState local{draw.vector(5), draw.vector(8)};
    TrajectoryPoint<float> wanted;
    wanted.position_m = draw.vector(5);
    wanted.velocity_m_s = draw.vector(8);
    wanted.acceleration_m_s2 = draw.vector(8);
    wanted.jerk_m_s3 = draw.vector(30);
    wanted.yaw_rad = draw.within(3);
    wanted.yaw_rate_rad_s = draw.within(far ? 9e5 : 1);
    controller.situation({true, false});
    REQUIRE(controller.body_rates(now_us, draw.vector(3)) == Status::ok);
    REQUIRE(controller.attitude(now_us, draw.attitude()) == Status::ok);
    REQUIRE(controller.local(now_us, local) == Status::ok);
    REQUIRE(controller.set_point(now_us, wanted) == Status::ok);
    Commands<float> commands{-9, -9, -9, -9};
    StepReport report;
    bool sound = controller.step(now_us, commands, report) == Reaction::flies && has_output(report.status);
    const auto& settings = controller.settings();
    for (const float u : commands) sound = sound && u >= settings.lowest_command && u <= settings.highest_command;
    missing += sound ? 0 : 1;
  }
  return missing;
}

template <class Model, class FlownAirframe = typename Model::Vehicle>
void always_answers(const char* name) {
  CAPTURE(name);
  for (const bool far : {false, true}) {
    CAPTURE(far);
    CHECK(unanswered<Model, FlownAirframe>(sound_block<Model>(), far, 5'000) == 0);
    CHECK(unanswered<Model, FlownAirframe>(narrow_block<Model>(), far, 5'000) == 0);  // the analytic inverse alone
  }
}

}  // namespace

TEST_CASE("fresh, finite inputs always get an answer within the output limits") {
  always_answers<DemoQuadModel>("the paper's quadrotor");
  always_answers<CrazyflieModel>("Crazyflie");
  always_answers<DemoQuadModel, pinnquad::Px4Sih>("PX4's simulated quadrotor");
}

TEST_CASE("a set point whose yaw no sender means is refused as other absurd numbers are") {
  NeuralController<DemoQuadModel> controller;
  TrajectoryPoint<float> wanted;
  wanted.yaw_rad = 2e6f;
  CHECK(controller.set_point(1, wanted) == Status::out_of_range);
  wanted.yaw_rad = 0;
  wanted.yaw_rate_rad_s = -1e30f;
  CHECK(controller.set_point(1, wanted) == Status::out_of_range);
  wanted.yaw_rate_rad_s = 1;
  CHECK(controller.set_point(1, wanted) == Status::ok);
}
