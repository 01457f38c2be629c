// SPDX-License-Identifier: MIT
// The controller with a far place, a weak battery, the ground and an estimator that moves: flown in the simulator
// without noise, sample by sample, without a flight stack's messages.
#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "model_blocks.hpp"
#include "models/crazyflie_2_1.hpp"
#include "models/demo_quadrotor.hpp"
#include "pinnquad/control/autopilot/recorded_controller.hpp"

namespace {

using namespace pinnquad::autopilot::test;
using pinnquad::TrajectoryPoint;
using pinnquad::Vector3;
using pinnquad::autopilot::CoreSettings;
using pinnquad::autopilot::Reaction;

/// A battery that is weaker than the airframe says.
struct WeakBattery {
  double thrust_scale{1};
  template <class Scalar>
  void surroundings(pinnquad::Surroundings<Scalar>& air) const noexcept {
    air.thrust_scale *= Scalar(thrust_scale);
  }
};

struct Track {
  double fastest_m_s = 0, overshoot_m = 0, error_m = 0;
};

/// From hover at 30 m to another place, 2 ms a step.
template <class Model>
class Flight {
 public:
  using Vehicle = pinnquad::Quadrotor<double, pinnquad::QuadraticDrag, WeakBattery>;

  explicit Flight(double thrust_scale, const CoreSettings& settings = {})
      : vehicle_(pinnquad::airframe_value<typename Model::Vehicle, double>(), {}, {}, WeakBattery{thrust_scale}),
        controller_(settings) {
    REQUIRE(controller_.offer_model(block_.data(), block_.size()) == pinnquad::Status::ok);
    body_.body.position_m = start_m;
    const double hover = 1 / vehicle_.airframe().thrust_to_weight();
    body_.rotors = {hover, hover, hover, hover};
    controller_.situation({true, false});
  }

  const pinnquad::autopilot::NeuralController<Model>& controller() const { return controller_; }
  /// The estimate is further off by this from now on; `said`: it says so.
  void estimator_moves(const pinnquad::autopilot::LocalState& by, bool said) {
    moved_.position_m += by.position_m;
    moved_.velocity_m_s += by.velocity_m_s;
    if (said) controller_.jump(by, 0);
  }

  Track fly(const Vector3<double>& place_m, double duration_s) {
    Track track;
    const Vector3<double> way = place_m - start_m;
    const double far = way.norm();
    for (int tick = 0; 0.002 * tick < duration_s; ++tick) {
      const std::uint64_t now_us = now_us_ += 2000;
      tell(now_us, place_m);
      pinnquad::Commands<float> commands{};
      pinnquad::autopilot::StepReport report;
      REQUIRE(controller_.step(now_us, commands, report) == Reaction::flies);
      pinnquad::Commands<double> u{};
      for (std::size_t i = 0; i < u.size(); ++i) u[i] = static_cast<double>(commands[i]);
      for (int i = 0; i < 2; ++i) REQUIRE(vehicle_.step(body_, u, 1e-3) == pinnquad::Status::ok);
      const Vector3<double>& p = body_.body.position_m;
      track.fastest_m_s = std::max(track.fastest_m_s, body_.body.velocity_m_s.norm());
      if (far > 0) track.overshoot_m = std::max(track.overshoot_m, (p - start_m).dot(way) / far - far);
      track.error_m = (p - place_m).norm();
    }
    return track;
  }

  static inline const Vector3<double> start_m{0, 0, -30};

 private:
  void tell(std::uint64_t now_us, const Vector3<double>& place_m) {
    const auto& b = body_.body;
    const auto vector = [](const Vector3<double>& v) { return Vector3<float>(v.cast<float>()); };
    REQUIRE(controller_.body_rates(now_us, vector(b.body_rates_rad_s)) == pinnquad::Status::ok);
    REQUIRE(controller_.attitude(now_us, {static_cast<float>(b.attitude.w), static_cast<float>(b.attitude.x),
                                          static_cast<float>(b.attitude.y), static_cast<float>(b.attitude.z)}) ==
            pinnquad::Status::ok);
    REQUIRE(controller_.local(now_us, {vector(b.position_m) + moved_.position_m,
                                       vector(b.velocity_m_s) + moved_.velocity_m_s}) == pinnquad::Status::ok);
    TrajectoryPoint<float> wanted;
    wanted.position_m = vector(place_m);
    REQUIRE(controller_.set_point(now_us, wanted) == pinnquad::Status::ok);
  }

  const Block block_ = sound_block<Model>();
  Vehicle vehicle_;
  pinnquad::VehicleState<double> body_{};
  pinnquad::autopilot::NeuralController<Model> controller_;
  pinnquad::autopilot::LocalState moved_;
  std::uint64_t now_us_ = 998'000;
};

template <class Model>
void far_places(const CoreSettings& settings) {
  constexpr double most_overshoot_m = 0.5, rounding = 1.05;
  const auto fly = [&](const Vector3<double>& way, double most_m_s) {
    const Track track = Flight<Model>(1.0, settings).fly(Flight<Model>::start_m + way, way.norm() / most_m_s + 10);
    MESSAGE("step of ", way.norm(), " m: up to ", track.fastest_m_s, " m/s, ", track.overshoot_m, " m too far");
    CHECK(track.fastest_m_s <= most_m_s * rounding);
    CHECK(track.fastest_m_s >= 0.8 * most_m_s);
    CHECK(track.overshoot_m <= most_overshoot_m);
    CHECK(track.error_m <= 0.1);
  };
  fly({50, 0, 0}, static_cast<double>(settings.horizontal_speed_m_s));
  fly({30, -40, 0}, static_cast<double>(settings.horizontal_speed_m_s));
  fly({0, 0, -25}, static_cast<double>(settings.climb_m_s));
  fly({0, 0, 25}, static_cast<double>(settings.descent_m_s));
}

/// Hovering, told everything at 1 s.
struct Standing {
  const Block block = sound_block<DemoQuadModel>();
  pinnquad::autopilot::Recorded<pinnquad::autopilot::NeuralController<DemoQuadModel>> controller;
  TrajectoryPoint<float> wanted;
  pinnquad::autopilot::LocalState local;
  std::uint64_t now_us = 1'000'000;
  pinnquad::Commands<float> commands{};

  explicit Standing(const CoreSettings& settings = {}) : controller(settings) {
    REQUIRE(controller.offer_model(block.data(), block.size()) == pinnquad::Status::ok);
  }
  void step() {
    REQUIRE(controller.body_rates(now_us, {0, 0, 0}) == pinnquad::Status::ok);
    REQUIRE(controller.attitude(now_us, {}) == pinnquad::Status::ok);
    REQUIRE(controller.local(now_us, local) == pinnquad::Status::ok);
    tick();
  }
  void tick() {
    pinnquad::autopilot::StepReport report;
    REQUIRE(controller.step(now_us, commands, report) != Reaction::gives_up);
    now_us += 2000;
  }
};

}  // namespace

TEST_CASE("a place 50 m away: within the speed limit, and no more than half a metre too far") {
  far_places<DemoQuadModel>({});
  const auto speeds = [](float horizontal_m_s, float climb_m_s, float descent_m_s) {
    CoreSettings settings;
    settings.horizontal_speed_m_s = horizontal_m_s;
    settings.climb_m_s = climb_m_s;
    settings.descent_m_s = descent_m_s;
    return settings;
  };
  far_places<DemoQuadModel>(speeds(6, 3, 1.5f));
  far_places<CrazyflieModel>(speeds(5, 2, 1));
}

namespace {

/// A tick's record of biases that were learnt.
pinnquad::autopilot::CoreRecord learnt() {
  pinnquad::autopilot::CoreRecord record;
  record.bias_sums[0] = record.analytic_bias_sums[0] = 0.2f;
  record.bias_sums[1] = record.analytic_bias_sums[1] = -0.1f;
  record.bias_across_m_s2[0] = 1;
  record.bias_status = record.analytic_bias_status = static_cast<std::uint8_t>(pinnquad::Status::ok);
  return record;
}

}  // namespace

TEST_CASE(
    "a bias learns at the motors' ends, stays while it may stand, fades in other hands, is forgotten on the ground") {
  CoreSettings little;
  little.highest_command = 0.8f;
  little.most_bias[0] = 0.8f;
  Standing standing(little);
  const auto& bias = standing.controller.bias();
  const auto steps = [&](int count) {
    for (int i = 0; i < count; ++i) {
      REQUIRE(standing.controller.set_point(standing.now_us, standing.wanted) == pinnquad::Status::ok);
      standing.step();
    }
  };
  standing.controller.situation({true, false});
  steps(2);
  standing.controller.resume(learnt());
  SUBCASE("at the motors' ends") {
    standing.wanted.position_m = {0, 0, -1000};  // as much thrust as there is
    standing.wanted.acceleration_m_s2 = {9, 0, -30};
    steps(1000);
    CHECK(*std::max_element(standing.commands.begin(), standing.commands.end()) >= little.highest_command);
    CHECK(bias.sums()[0] == little.most_bias[0]);  // what flew is known: it makes less than the model says
    CHECK(bias.status() == pinnquad::Status::limited);
  }
  SUBCASE("where it may stand on the ground") {
    standing.wanted.position_m = {0, 0, 5};  // it is asked to sink, and does not
    steps(2);
    const float before = bias.sums()[0];
    steps(240);
    CHECK(bias.sums()[0] == before);
    CHECK(standing.controller.lift() == 1);
    steps(400);
    CHECK(standing.controller.lift() < 0.5f);
    CHECK(bias.sums()[0] == before);
    steps(400);
    CHECK(standing.controller.lift() == 0);
    CHECK(bias.sums()[0] == 0);
    CHECK(standing.controller.analytic_bias().across_m_s2().norm() == 0);
    CHECK(bias.status() == pinnquad::Status::warming_up);
  }
  SUBCASE("in other hands, in the air") {
    standing.controller.situation({false, false});
    steps(240);
    CHECK(bias.sums()[0] == 0.2f);
    steps(500);
    CHECK(bias.sums()[0] < 0.15f);
    CHECK(bias.sums()[0] > 0.1f);
    CHECK(bias.status() == pinnquad::Status::warming_up);
  }
  SUBCASE("flown by hand") {
    for (int i = 0; i < 500; ++i) {
      standing.controller.skip(standing.now_us);
      standing.now_us += 2000;
    }
    CHECK(bias.sums()[0] == doctest::Approx(0.2 * std::exp(-0.25)).epsilon(0.02));
  }
  SUBCASE("on the ground, not asked") {
    standing.controller.situation({false, true});
    standing.controller.skip(standing.now_us);
    CHECK(bias.sums()[0] == 0);
  }
  SUBCASE("another model has none of it, the analytic inverse its own") {
    const Block other = other_block<DemoQuadModel>();
    REQUIRE(standing.controller.offer_model(other.data(), other.size()) == pinnquad::Status::ok);
    steps(1);
    CHECK(bias.sums()[0] == 0);
    CHECK(standing.controller.analytic_bias().sums()[0] == 0.2f);
  }
}

TEST_CASE("a bias at its bound says so, and is no alarm where the analytic inverse's is too") {
  CoreSettings little;
  little.most_bias[0] = 0.05f;
  Flight<DemoQuadModel> flight(0.8, little);
  static_cast<void>(flight.fly(Flight<DemoQuadModel>::start_m, 5));
  CHECK(flight.controller().bias().status() == pinnquad::Status::limited);
  CHECK(flight.controller().bias().sums()[0] == 0.05f);
  CHECK_FALSE(flight.controller().learner().handed_over());
}

TEST_CASE("an estimator that moves its velocity by half a metre per second makes no bias of it") {
  constexpr double limit_m_s2 = 0.2;
  const auto moves_by = [](bool said) {
    Flight<DemoQuadModel> flight(1.0);
    static_cast<void>(flight.fly(Flight<DemoQuadModel>::start_m, 3));
    const float sum = flight.controller().bias().sums()[0];
    const Vector3<float> across = flight.controller().analytic_bias().across_m_s2();
    flight.estimator_moves({{0, 0, 0}, {0.5f, 0, -0.25f}}, said);
    static_cast<void>(flight.fly(Flight<DemoQuadModel>::start_m, 0.1));
    return static_cast<double>((flight.controller().analytic_bias().across_m_s2() - across).norm() +
                               std::abs(flight.controller().bias().sums()[0] - sum));
  };
  CHECK(moves_by(true) < limit_m_s2);
  CHECK(moves_by(false) > 5 * limit_m_s2);  // not said: it is motion
}

TEST_CASE("on the ground the rotors idle until a set point asks to go up; then thrust comes over a second") {
  Standing standing;
  const auto thrust = [&] {
    float sum = 0;
    for (const float u : standing.commands) sum += u / 4;
    return sum;
  };
  standing.controller.situation({false, true});
  standing.step();
  standing.controller.situation({true, true});
  for (int i = 0; i < 200; ++i) {
    REQUIRE(standing.controller.set_point(standing.now_us, standing.wanted) == pinnquad::Status::ok);
    standing.step();
    REQUIRE(thrust() == doctest::Approx(double(CoreSettings{}.lowest_command)));
  }
  standing.wanted.position_m[2] = -2;
  float before = thrust(), steepest = 0;
  for (int i = 0; i < 600; ++i) {
    REQUIRE(standing.controller.set_point(standing.now_us, standing.wanted) == pinnquad::Status::ok);
    standing.step();
    steepest = std::max(steepest, thrust() - before);
    before = thrust();
  }
  CHECK(steepest < 0.01f);  // a straight ramp to full thrust has 0.002 per step
  CHECK(thrust() > 0.5f);
  CHECK(standing.controller.lift() == 1);
  standing.controller.situation({false, false});  // taken over in the air: all of the thrust at once
  standing.step();
  standing.controller.situation({true, false});
  standing.step();
  CHECK(standing.controller.lift() == 1);
}

TEST_CASE("an estimator that moves its estimate by 3 m and 0.4 rad moves nothing else") {
  Standing standing;
  standing.controller.situation({true, false});
  const pinnquad::autopilot::LocalState by{{3, -1, 0.5f}, {0.2f, 0, -0.1f}};
  constexpr float turned_rad = 0.4f;
  const auto turned = [&](float yaw_rad) { return pinnquad::from_euler<float>({0, 0, yaw_rad}); };
  const auto step = [&](float yaw_rad) {
    REQUIRE(standing.controller.body_rates(standing.now_us, {0, 0, 0}) == pinnquad::Status::ok);
    REQUIRE(standing.controller.attitude(standing.now_us, turned(yaw_rad)) == pinnquad::Status::ok);
    REQUIRE(standing.controller.local(standing.now_us, standing.local) == pinnquad::Status::ok);
    standing.tick();
    return standing.commands;
  };
  const auto unmoved = [&] {
    const pinnquad::Commands<float> before = step(0);
    standing.controller.jump(by, turned_rad);
    standing.local.position_m += by.position_m;
    const pinnquad::Commands<float> after = step(turned_rad);
    CHECK(standing.controller.record().jump_position_m[0] == 3);
    for (std::size_t i = 0; i < after.size(); ++i) CHECK(after[i] == doctest::Approx(double(before[i])).epsilon(0.01));
    step(turned_rad);
    CHECK(standing.controller.record().jump_position_m[0] == 0);
  };
  SUBCASE("on its way to a set point") {
    REQUIRE(standing.controller.set_point(standing.now_us, standing.wanted) == pinnquad::Status::ok);
    unmoved();
  }
  SUBCASE("holding its place") { unmoved(); }
}

TEST_CASE("a tick that is late by seconds counts as a tenth of one: thrust does not come at once") {
  constexpr float duration_s = 1;
  pinnquad::autopilot::detail::TakeOff take_off(duration_s);
  take_off.skip({false, true});  // stands on the ground
  pinnquad::autopilot::detail::VerticalMotion climbs;
  climbs.asks_to_climb = true;
  take_off.update(1'000'000, {true, true}, climbs);
  take_off.update(4'000'000, {true, true}, climbs);
  CHECK(take_off.lift() == doctest::Approx(0.1));
}

TEST_CASE("who flies level above its place, and is expected to fall, is borne by no ground while it is fast") {
  const auto lift_after_a_second = [](float along_m_s) {
    pinnquad::autopilot::detail::TakeOff take_off(1.0f);
    pinnquad::autopilot::detail::VerticalMotion motion;
    motion.asked_sink_m_s = 0.5f;
    motion.expected_fall_m_s2 = 2;
    motion.along_m_s = along_m_s;
    for (std::uint64_t ms = 0; ms <= 1000; ms += 4) {
      take_off.update(1'000'000 + 1000 * ms, {true, false}, motion);
      CHECK((take_off.may_stand() || along_m_s > 1));
    }
    return take_off.lift();
  };
  CHECK(static_cast<double>(lift_after_a_second(0.3f)) == doctest::Approx(0.5).epsilon(0.02));
  CHECK(lift_after_a_second(8) == 1);
}

TEST_CASE("the attitude of a flown window is the same, whichever of its two quaternions the estimator says") {
  pinnquad::FlownMotion<float> one_sign(100'000, 0.01f), both = one_sign;
  pinnquad::State<float> state;
  int windows = 0;
  for (int tick = 0; tick < 400; ++tick) {
    const auto now_us = static_cast<std::uint64_t>(1'000'000 + 2000 * tick);
    const auto flown = [&](pinnquad::FlownMotion<float>& motion, float sign) {
      const pinnquad::Quaternion<float> q =
          pinnquad::from_euler<float>({0.03f * static_cast<float>(tick % 25), -0.2f, 1.0f});
      state.attitude = {sign * q.w, sign * q.x, sign * q.y, sign * q.z};
      motion.velocity(now_us, state.velocity_m_s);
      motion.body_rates(now_us, state.body_rates_rad_s);
      return motion.tick(now_us, true, state, {0.5f, 0.5f, 0.5f, 0.5f});
    };
    const bool complete = flown(one_sign, 1);
    REQUIRE(flown(both, tick % 25 < 12 ? -1.0f : 1.0f) == complete);
    if (!complete) continue;
    ++windows;
    const pinnquad::Quaternion<float>&a = one_sign.motion().attitude, &b = both.motion().attitude;
    CHECK(std::abs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z) == doctest::Approx(1).epsilon(1e-5));
  }
  CHECK(windows >= 2);
}

TEST_CASE("the analytic inverse knows the effects that the vehicle is said to have") {
  using Dragging = pinnquad::Quadrotor<float, pinnquad::QuadraticDrag, pinnquad::RotorDrag>;
  using View = pinnquad::ModelView<DemoQuadModel>;
  const Dragging vehicle(pinnquad::airframe_value<pinnquad::PaperQuadrotor, float>(), {}, {},
                         pinnquad::RotorDrag{0.02});
  pinnquad::autopilot::NeuralController<DemoQuadModel> plain;
  pinnquad::autopilot::NeuralController<DemoQuadModel, View, Dragging> dragging(vehicle);
  const Block block = narrow_block<DemoQuadModel>();  // all answers are the analytic inverse's
  const auto commands = [&](auto& controller) {
    REQUIRE(controller.offer_model(block.data(), block.size()) == pinnquad::Status::ok);
    constexpr std::uint64_t now_us = 1'000'000;
    TrajectoryPoint<float> wanted;
    wanted.velocity_m_s = {5, 0, 0};
    REQUIRE(controller.body_rates(now_us, {0, 0, 2}) == pinnquad::Status::ok);
    REQUIRE(controller.attitude(now_us, {}) == pinnquad::Status::ok);
    REQUIRE(controller.local(now_us, {{0, 0, 0}, {5, 0, 0}}) == pinnquad::Status::ok);
    REQUIRE(controller.set_point(now_us, wanted) == pinnquad::Status::ok);
    pinnquad::Commands<float> u{};
    pinnquad::autopilot::StepReport report;
    REQUIRE(controller.step(now_us, u, report) == Reaction::flies);
    REQUIRE(report.status == pinnquad::Status::fell_back);
    return u;
  };
  const pinnquad::Commands<float> a = commands(plain), b = commands(dragging);
  float furthest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) furthest = std::max(furthest, std::abs(a[i] - b[i]));
  CHECK(furthest > 0.005f);
}
