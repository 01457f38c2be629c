// SPDX-License-Identifier: MIT
// One law: what a loop flies (TrackingController) and what a flight stack flies (NeuralController) are the same bits,
// with what is learnt in flight.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "../../examples/models/structured_quadrotor.hpp"
#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/control/autopilot/neural_controller.hpp"
#include "pinnquad/control/tracking_controller.hpp"
#include "pinnquad/control/trajectory.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "support/block_bytes.hpp"

using namespace pinnquad;

namespace {

using Core = autopilot::NeuralController<StructuredQuadModel>;
using View = ModelView<StructuredQuadModel>;
using Network = NetworkInverse<InverseDynamics<View, Core::NetworkGuard>>;

/// The core's analytic inverse, whatever its commands.
struct Analytic {
  Core::Analytic inverse;

  Status operator()(const State<float>& state, const Accelerations<float>& motion, std::uint64_t /*time_us*/,
                    Commands<float>& commands) const noexcept {
    return inverse(motion_inputs(state, motion), commands);
  }
};
using Learning = AdaptiveInverse<float, Network, FlownMotion<float>, Analytic>;

/// A core and a loop of one model, told the same.
struct Both {
  test::BlockBytes block{model_block<StructuredQuadModel>()};
  View view;
  Core core;
  TrackingController<float, Learning> loop;
  Commands<float> flown{}, looped{};
  autopilot::StepReport report;
  Status status = Status::ok;

  static autopilot::CoreSettings settings(float delay_s) {
    autopilot::CoreSettings result;
    result.lowest_command = 0;  // a loop's rotors may stand still
    result.state_delay_s = delay_s;
    return result;
  }
  static View opened(const test::BlockBytes& block) {
    View view;
    REQUIRE(View::open(block.data(), block.size(), view) == Status::ok);
    return view;
  }
  static Learning learning(const View& view, const Core::Vehicle& vehicle, float delay_s) {
    const Airframe<float>& airframe = vehicle.airframe();
    BiasSettings<float> bias = bias_settings<StructuredQuadModel>();
    const float across_s = bias.across_time_constant_s;
    if (delay_s > 0) bias = quick_where_told(bias);
    bias.across_time_constant_s = across_s;
    return {Network({view, {}}), airframe, bias, FlownMotion<float>(25'000, airframe.rise_time_constant_s(0), delay_s),
            Analytic{Core::Analytic(vehicle)}};
  }
  /// `delay_s`: of the states; told, the bias is quick and follows the noise.
  explicit Both(float delay_s = 0)
      : view(opened(block)),
        core(settings(delay_s)),
        loop(core.vehicle().airframe(),
             autopilot::detail::outer_loop(settings(delay_s), core.vehicle().airframe(),
                                           core.vehicle().site().gravity_m_s2),
             learning(view, core.vehicle(), delay_s)) {
    REQUIRE(core.offer_model(block.data(), block.size()) == Status::ok);
  }

  /// `local`: a sample of position and velocity came; without one the state has the last.
  void tick(std::uint64_t now_us, State<float> state, const TrajectoryPoint<float>& point, bool local = true) {
    REQUIRE(core.body_rates(now_us, state.body_rates_rad_s) == Status::ok);
    REQUIRE(core.attitude(now_us, state.attitude) == Status::ok);
    state.attitude = normalized(state.attitude);  // as the core does
    if (local) REQUIRE(core.local(now_us, {state.position_m, state.velocity_m_s}) == Status::ok);
    REQUIRE(core.set_point(now_us, point) == Status::ok);
    REQUIRE(core.step(now_us, flown, report) == autopilot::Reaction::flies);
    status = loop(state, point, now_us, looped);
    REQUIRE(has_output(status));
    REQUIRE((status == Status::fell_back) == (report.status == Status::fell_back));
    REQUIRE(flown == looped);
    const Learning::Learner& learner = loop.feed_forward().learner();
    check_same(learner.own(), core.bias());
    check_same(learner.last(), core.analytic_bias());
    REQUIRE(learner.handed_over() == core.learner().handed_over());
  }
  static void check_same(const detail::MotionBias<float>& one, const detail::MotionBias<float>& other) {
    const auto &a = one.learnt(), &b = other.learnt();
    REQUIRE(a.sums == b.sums);
    REQUIRE(a.across_m_s2 == b.across_m_s2);
    REQUIRE(a.across_rate_m_s3 == b.across_rate_m_s3);
    REQUIRE(std::array{a.roll_pitch_noise, a.across_noise_m_s2, a.waited_s} ==
            std::array{b.roll_pitch_noise, b.across_noise_m_s2, b.waited_s});
    REQUIRE(a.status == b.status);
  }
};

}  // namespace

TEST_CASE("of the same ticks, loop and flight stack make the same commands, to the bit") {
  Both both;  // the core's commands drive no motors, and the ticks are too far apart for a motion: nothing is learnt
  std::mt19937_64 engine(9);
  int own = 0, replaced = 0, at_end = 0;
  for (std::uint64_t now_us = 1'000'000; now_us < 101'000'000; now_us += 20'000) {
    // from motions that the model knows to some that no rotor makes
    const float most = static_cast<float>(uniform(engine, 0, 1) * uniform(engine, 0, 1));
    const auto drawn = [&] { return most * static_cast<float>(uniform(engine, -1, 1)); };
    const auto vector = [&](float scale) { return Vector3<float>(scale * drawn(), scale * drawn(), scale * drawn()); };
    State<float> state;
    state.position_m = vector(5);
    state.velocity_m_s = vector(8);
    state.attitude = normalized(from_euler<float>({2 * drawn(), drawn(), 3 * drawn()}));
    state.body_rates_rad_s = vector(5);
    TrajectoryPoint<float> point;  // a flight stack's has no snap
    point.position_m = vector(5);
    point.velocity_m_s = vector(8);
    point.acceleration_m_s2 = vector(12);
    point.jerk_m_s3 = vector(40);
    point.yaw_rad = 3 * drawn();
    point.yaw_rate_rad_s = drawn();

    both.tick(now_us, state, point);
    ++(both.report.status == Status::fell_back ? replaced : own);
    at_end += saturated(both.flown) ? 1 : 0;
  }
  CHECK(own > 500);
  CHECK(replaced > 500);
  CHECK(at_end > 100);
}

TEST_CASE(
    "and they learn the same, through a weak rotor, a payload, commands at their ends, samples and ticks missing") {
  using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;
  Airframe<double> loaded = airframe_value<StructuredQuadModel::Vehicle, double>();
  const Vehicle light(loaded, paper_site<double>(), {}, {});
  loaded.mass_kg *= 1.2;
  const Vehicle heavy(loaded, paper_site<double>(), {}, {});
  float delay_s = 0;
  SUBCASE("slow, of a delay that is not told") {}
  SUBCASE("quick, of one that is") { delay_s = 0.004f; }
  Both both(delay_s);
  both.core.situation({true, false});
  FigureEight<double> eight;
  eight.center_m = {0, 0, -20};
  VehicleState<double> flies;
  flies.body.position_m = eight.sample(0).position_m;
  State<float> seen;
  std::mt19937_64 engine(3);
  int at_end = 0, replaced = 0;
  double weak = 0, laden = 0;
  for (int i = 0; i < 10'000; ++i) {
    const double time_s = 0.002 * i;
    Commands<double> given{};
    for (std::size_t rotor = 0; rotor < given.size(); ++rotor) given[rotor] = static_cast<double>(both.flown[rotor]);
    if (time_s > 4) given[2] *= 0.85;
    REQUIRE((time_s > 10 ? heavy : light).step(flies, given, 0.002) == Status::ok);
    if (time_s >= 16 && time_s < 16.06) continue;  // no ticks
    const bool local = !(time_s >= 18 && time_s < 18.06);
    const auto noisy = [&](const Vector3<double>& of) {
      const auto noise = [&] { return 0.01 * uniform(engine, -1, 1); };
      return (of + Vector3<double>(noise(), noise(), noise())).cast<float>().eval();
    };
    if (local) seen.position_m = noisy(flies.body.position_m), seen.velocity_m_s = noisy(flies.body.velocity_m_s);
    const Quaternion<double>& q = flies.body.attitude;
    seen.attitude = {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
                     static_cast<float>(q.z)};
    seen.body_rates_rad_s = noisy(flies.body.body_rates_rad_s);
    const TrajectoryPoint<double> there = eight.sample(time_s);
    TrajectoryPoint<float> point;
    point.position_m = there.position_m.cast<float>();
    point.velocity_m_s = there.velocity_m_s.cast<float>();
    point.acceleration_m_s2 = there.acceleration_m_s2.cast<float>();
    point.jerk_m_s3 = there.jerk_m_s3.cast<float>();
    if (time_s >= 13 && time_s < 13.5) point.acceleration_m_s2[2] -= 30;  // all the thrust that there is
    both.tick(static_cast<std::uint64_t>(1'000'000 + 2000 * i), seen, point, local);
    at_end += saturated(both.flown) ? 1 : 0;
    replaced += both.status == Status::fell_back ? 1 : 0;
    const SignedSums<float>& sums = both.core.bias().sums();
    if (time_s < 9.9) weak = static_cast<double>(sums[1]);
    if (time_s < 12.9) laden = static_cast<double>(sums[0]);
  }
  CHECK(std::fabs(weak) > 0.05);
  CHECK(laden > 0.3);
  CHECK(at_end > 100);
  CHECK(replaced > 10);
}
