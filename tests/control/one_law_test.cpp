// SPDX-License-Identifier: MIT
// One law: what a loop flies (TrackingController) and what a flight stack flies (NeuralController) are the same bits.
#include <doctest/doctest.h>

#include <cstdint>
#include <random>

#include "../../examples/models/structured_quadrotor.hpp"
#include "pinnquad/control/autopilot/neural_controller.hpp"
#include "pinnquad/control/tracking_controller.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "support/block_bytes.hpp"

using namespace pinnquad;

namespace {

using Core = autopilot::NeuralController<StructuredQuadModel>;
using View = ModelView<StructuredQuadModel>;

/// The network behind the core's guard; where it declines, the analytic inverse, whatever its commands.
struct NetworkElseAnalytic {
  NetworkInverse<InverseDynamics<View, Core::NetworkGuard>> network;
  Core::Analytic analytic;

  Status operator()(const State<float>& state, const Accelerations<float>& demand, std::uint64_t time_us,
                    Commands<float>& commands) noexcept {
    if (has_output(network(state, demand, time_us, commands))) return Status::ok;
    const Status status = analytic(motion_inputs(state, demand), commands);
    return has_output(status) ? Status::fell_back : status;
  }
};

}  // namespace

TEST_CASE("of the same ticks, loop and flight stack make the same commands, to the bit") {
  const test::BlockBytes block(model_block<StructuredQuadModel>());
  View view;
  REQUIRE(View::open(block.data(), block.size(), view) == Status::ok);

  autopilot::CoreSettings settings;
  settings.lowest_command = 0;  // a loop's rotors may stand still
  Core core(settings);          // its commands drive no motors: it learns nothing
  REQUIRE(core.offer_model(block.data(), block.size()) == Status::ok);
  const auto& vehicle = core.vehicle();
  const auto outer = autopilot::detail::outer_loop(settings, vehicle.airframe(), vehicle.site().gravity_m_s2);
  TrackingController<float, NetworkElseAnalytic> loop(
      vehicle.airframe(), outer,
      {NetworkInverse<InverseDynamics<View, Core::NetworkGuard>>({view, {}}), Core::Analytic(vehicle)});
  std::mt19937_64 engine(9);
  int own = 0, replaced = 0, at_end = 0;
  for (std::uint64_t now_us = 1'000'000; now_us < 6'000'000; now_us += 1000) {
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

    REQUIRE(core.body_rates(now_us, state.body_rates_rad_s) == Status::ok);
    REQUIRE(core.attitude(now_us, state.attitude) == Status::ok);
    state.attitude = normalized(state.attitude);  // as the core does
    REQUIRE(core.local(now_us, {state.position_m, state.velocity_m_s}) == Status::ok);
    REQUIRE(core.set_point(now_us, point) == Status::ok);
    Commands<float> flown{}, looped{};
    autopilot::StepReport report;
    REQUIRE(core.step(now_us, flown, report) == autopilot::Reaction::flies);
    const Status status = loop(state, point, now_us, looped);
    REQUIRE(has_output(status));
    REQUIRE((status == Status::fell_back) == (report.status == Status::fell_back));
    REQUIRE(flown == looped);
    ++(report.status == Status::fell_back ? replaced : own);
    at_end += saturated(flown) ? 1 : 0;
  }
  CHECK(own > 500);
  CHECK(replaced > 500);
  CHECK(at_end > 100);
}
