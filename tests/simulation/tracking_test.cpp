// SPDX-License-Identifier: MIT
// Closed loop on trajectories: feed-forward policies under the same feedback, and the fallback's book-keeping.
#include "pinnquad/simulation/tracking.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"
#include "support/hover.hpp"
#include "support/small_model_variants.hpp"

namespace {

using namespace pinnquad;

using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;

Vehicle vehicle() { return Vehicle(airframe_value<PaperQuadrotor, double>(), paper_site<double>(), {}, {}); }

FigureEight<double> course() {
  FigureEight<double> eight;
  eight.center_m = Vector3<double>(0, 0, -20);
  return eight;
}

using Analytic = AnalyticInverse<Vehicle>;
Analytic analytic_inverse() { return Analytic(vehicle()); }

/// Stands in for a trained network: the interface of InverseDynamics, the vehicle's formula in float, times `gain`.
struct FakeInverseDynamics {
  using Scalar = float;
  using Features = PaperFeatures;
  using Inputs = MotionInputs<float>;
  using Report = InverseDynamics<test::SmallModel>::Report;

  float gain = 1;
  float max_speed_m_s = 100;

  Status predict(const Inputs& in, const PlaceAndTime<double>& place, Commands<float>& commands,
                 Report& report) const noexcept {
    report.cause = predict(in, commands);
    if (report.cause == Status::ok) return Status::ok;
    const bool written = has_output(analytic_inverse()(in, place, commands));
    return written ? Status::fell_back : report.cause;
  }

  Status predict(const Inputs& in, Commands<float>& commands) const noexcept {
    if (in.velocity_m_s.norm() > max_speed_m_s) return Status::outside_envelope;
    const Quadrotor<float, StandardAtmosphere, QuadraticDrag> quadrotor(airframe_value<PaperQuadrotor, float>(),
                                                                        paper_site<float>(), {}, {});
    State<float> state;
    state.attitude = in.attitude;
    state.velocity_m_s = body_to_world(in.attitude, in.velocity_m_s);
    state.body_rates_rad_s = in.body_rates_rad_s;
    const Status status = inverse_commands(
        quadrotor, state, {in.linear_acceleration_m_s2, in.angular_acceleration_rad_s2}, 0.0f, commands);
    for (float& u : commands) u *= gain;
    return status;
  }
};

using FakeNetwork = NetworkInverse<FakeInverseDynamics>;

template <class FeedForward>
TrackingResult<double> tracked(const FeedForward& feed_forward) {
  return track(vehicle(), course(), FlightController<double>{}, feed_forward);
}

TrackingResult<double> tracked_without_jerk() {
  struct Plain {
    FigureEight<double> path;
    TrajectoryPoint<double> sample(double time_s) const noexcept { return without_jerk(path.sample(time_s)); }
  };
  return track(vehicle(), Plain{course()}, FlightController<double>{}, analytic_inverse());
}

}  // namespace

TEST_CASE("a path is flown more closely with its jerk and snap than without") {
  const TrackingResult<double> analytic = tracked(analytic_inverse());
  const TrackingResult<double> alone = tracked_without_jerk();
  MESSAGE("analytic inverse ", 100 * analytic.rmse_m, " cm, without jerk ", 100 * alone.rmse_m, " cm");
  REQUIRE(analytic.status == Status::ok);
  REQUIRE(alone.status == Status::ok);
  CHECK(analytic.flown_s == doctest::Approx(30));
  CHECK(analytic.max_speed_m_s > 4.5);
  CHECK(analytic.rmse_m < 0.05);  // rotor lag and lateral drag, which four rotors can't answer, are left
  CHECK(analytic.max_error_m >= analytic.rmse_m);
  CHECK(alone.rmse_m > 2 * analytic.rmse_m);
  CHECK(alone.rmse_m < 1);  // worse, but the feedback holds it
  CHECK(analytic.saturated_share == 0);
  CHECK(analytic.fallback.asked == 0);
}

TEST_CASE("a network that knows the formula tracks like the formula; a broken one visibly worse") {
  const TrackingResult<double> analytic = tracked(analytic_inverse());
  const TrackingResult<double> network = tracked(FakeNetwork({}));
  const TrackingResult<double> zeroed = tracked(FakeNetwork({0.0f, 100.0f}));
  REQUIRE(network.status == Status::ok);
  constexpr double float_rounding_m = 1e-3;  // float commands, and sea-level density instead of 20 m up: 0.2 %
  CHECK(std::abs(network.rmse_m - analytic.rmse_m) <= float_rounding_m);
  CHECK(network.fallback.asked == 15000);
  CHECK(network.fallback.fallbacks() == 0);
  CHECK(zeroed.rmse_m > 5 * analytic.rmse_m);
}

TEST_CASE("where the network declines for a while the fallback flies, and is counted by Status") {
  const TrackingResult<double> slow_only = tracked(FakeNetwork({1.0f, 4.0f}));
  CHECK(slow_only.fallback.asked == 15000);
  CHECK(slow_only.fallback.of(Status::outside_envelope) == slow_only.fallback.fallbacks());
  CHECK(slow_only.fallback.of(Status::ok) == 15000 - slow_only.fallback.fallbacks());
  // the eight's own speed is above 4 m/s for a tenth of a period or more, around each crossing
  int fast = 0;
  for (int tick = 0; tick < 15000; ++tick) fast += course().sample(0.002 * tick).velocity_m_s.norm() > 4 ? 1 : 0;
  CHECK(std::abs(static_cast<int>(slow_only.fallback.fallbacks()) - fast) <= 20);  // flown a little late and slower
  CHECK(slow_only.rmse_m < 0.05);
}

TEST_CASE("one way to fall back: the guard's, in the loop too") {
  using Formula = AnalyticInverse<Vehicle>;
  using Falling = InverseDynamics<test::NowhereTrained, Extend<TrainingGuard, Fallback<Formula>>>;
  const Formula formula(vehicle());
  const TrackingResult<double> analytic = tracked(formula);
  const TrackingResult<double> fallen = tracked(NetworkInverse<Falling>(Falling(Falling::Guard(formula))));
  constexpr double float_rounding_m = 1e-6;
  CHECK(fallen.status == Status::ok);
  CHECK(std::abs(fallen.rmse_m - analytic.rmse_m) <= float_rounding_m);
  CHECK(fallen.fallback.asked == 15000);
  CHECK(fallen.fallback.of(Status::outside_envelope) == 15000);

  // without a fallback the policy declines: the rigid body and the feedback fly on, worse by the air that it does not
  // know
  using Declining = InverseDynamics<test::NowhereTrained>;
  const TrackingResult<double> declined = tracked(NetworkInverse<Declining>(Declining{}));
  CHECK(analytic.declined == Status::ok);
  CHECK(fallen.declined == Status::ok);
  CHECK(declined.declined == Status::outside_envelope);
  CHECK(declined.status == Status::ok);
  CHECK(declined.flown_s == doctest::Approx(30));
  CHECK(declined.fallback.fallbacks() == 15000);
  CHECK(declined.rmse_m < tracked_without_jerk().rmse_m);
}

namespace {

/// Comes to a Status that a test chooses; where it has output, the analytic inverse's commands times `gain`.
struct ChosenStatus {
  Analytic inner;
  Status status;
  double gain = 1;

  Status operator()(const State<double>& state, const Accelerations<double>& desired, std::uint64_t time_us,
                    Commands<double>& commands) noexcept {
    if (!has_output(status)) return status;
    static_cast<void>(inner(state, desired, time_us, commands));
    for (double& u : commands) u *= gain;
    return status;
  }
};

}  // namespace

TEST_CASE("a tick says what the feed-forward came to, and keeps the feedback whatever that is") {
  const Vehicle quadrotor = vehicle();
  State<double> off;  // rolled to the left of where it should be, and turning further
  off.position_m = Vector3<double>(0, 0, -20);
  off.attitude = from_euler<double>({-0.3, 0, 0});
  off.body_rates_rad_s[0] = -0.5;
  const TrajectoryPoint<double> still = test::Hover<double>{Vector3<double>(0, 0, -20), 0.0}.sample(0);
  for (int i = 0; i < status_count; ++i) {
    const auto chosen = static_cast<Status>(i);
    TrackingController<double, ChosenStatus> controller(quadrotor.airframe(), FlightController<double>{},
                                                        {analytic_inverse(), chosen});
    Commands<double> commands{};
    CAPTURE(to_string(chosen));
    CHECK(controller(off, still, 0, commands) == (has_output(chosen) ? chosen : Status::fell_back));
    CHECK(controller.feed_forward_status() == chosen);
    const Wrench<double> made = quadrotor.rotors().wrench(commands, 1.0);
    CHECK(made.torque_N_m[0] > 0.01);  // back to the right
    CHECK(-made.force_N[2] > 0.7 * quadrotor.airframe().mass_kg * standard_gravity_m_s2<double>);
  }
}

TEST_CASE("what leaves the commands' range is said to be limited, and does not hide a fallback") {
  const Vehicle quadrotor = vehicle();
  State<double> off;
  off.attitude = from_euler<double>({-0.3, 0, 0});
  const TrajectoryPoint<double> still = test::Hover<double>{}.sample(0);
  Commands<double> commands{};
  for (const Status chosen : {Status::ok, Status::limited, Status::fell_back}) {
    TrackingController<double, ChosenStatus> controller(quadrotor.airframe(), FlightController<double>{},
                                                        {analytic_inverse(), chosen, 3});
    CHECK(controller(off, still, 0, commands) == (chosen == Status::ok ? Status::limited : chosen));
    CHECK(saturated(commands));
  }
}

TEST_CASE("a circle, and a hover that stays") {
  Circle<double> circle;
  circle.center_m = Vector3<double>(0, 0, -20);
  const AnalyticInverse<Vehicle> inverse(vehicle());
  const TrackingResult<double> round = track(vehicle(), circle, FlightController<double>{}, inverse);
  CHECK(round.status == Status::ok);
  CHECK(round.rmse_m < 0.05);
  const test::Hover<double> still{Vector3<double>(1, 2, -20), 0.5};
  CHECK(track(vehicle(), still, FlightController<double>{}, inverse).max_error_m <= 1e-9);
}

namespace {

/// Another policy's commands; what the loop asked it with is written down, and every fourth time all rotors are told to
/// give all they have and more.
struct Witness {
  struct Seen {
    State<double> state;
    double time_s;
  };
  Analytic inner;
  std::vector<Seen>* seen;

  Status operator()(const State<double>& state, const Accelerations<double>& desired, std::uint64_t time_us,
                    Commands<double>& commands) noexcept {
    seen->push_back({state, seconds_of(time_us)});  // has room
    const Status status = inner(state, desired, time_us, commands);
    if (seen->size() % 4 == 0) commands = {2, 2, 2, 2};
    return status;
  }
};

}  // namespace

TEST_CASE("a result's figures are those of what was flown") {
  TrackingPlan<double> plan;
  plan.duration_s = 4;
  std::vector<Witness::Seen> seen;
  seen.reserve(3000);
  const auto flown = track(vehicle(), course(), FlightController<double>{}, Witness{analytic_inverse(), &seen}, plan);
  REQUIRE(flown.status == Status::ok);
  REQUIRE(seen.size() == 2000);
  double squares = 0, farthest_m = 0, fastest_m_s = 0;
  for (const auto& [state, time_s] : seen) {
    const double error_m = (course().sample(time_s).position_m - state.position_m).norm();
    squares += error_m * error_m;
    farthest_m = std::max(farthest_m, error_m);
    fastest_m_s = std::max(fastest_m_s, state.velocity_m_s.norm());
  }
  constexpr double rounding = 1e-12;
  CHECK(flown.flown_s == doctest::Approx(4));
  CHECK(flown.rmse_m == doctest::Approx(std::sqrt(squares / 2000)).epsilon(rounding));
  CHECK(flown.max_error_m == doctest::Approx(farthest_m).epsilon(rounding));
  CHECK(flown.max_speed_m_s == doctest::Approx(fastest_m_s).epsilon(rounding));
  CHECK(flown.saturated_share == 0.25);
}

TEST_CASE("answers are counted by Status; neither the network's own nor what was limited is a fallback") {
  FallbackCount count;
  std::uint32_t asked = 0;
  for (int status = 0; status < status_count; ++status) {
    for (int times = 0; times <= status; ++times, ++asked) count.add(static_cast<Status>(status));
  }
  CHECK(count.asked == asked);
  for (int status = 0; status < status_count; ++status) {
    CHECK(count.of(static_cast<Status>(status)) == static_cast<std::uint32_t>(status) + 1);
  }
  CHECK(count.fallbacks() == asked - count.of(Status::ok) - count.of(Status::limited));
}

TEST_CASE("the loop recovers from a start far off, in every direction") {
  const Vehicle quadrotor = vehicle();
  const test::Hover<double> goal{Vector3<double>(0, 0, -20), 0.0};
  for (int direction = 0; direction < 6; ++direction) {
    VehicleState<double> state;
    state.body.position_m = Vector3<double>(0, 0, -20);
    state.body.position_m[direction % 3] += direction < 3 ? 5 : -5;
    REQUIRE(hover_trim(quadrotor, state.body.position_m, state.rotors) == Status::ok);
    TrackingController<double, Analytic> controller(quadrotor.airframe(), FlightController<double>{},
                                                    analytic_inverse());
    Commands<double> commands{};
    for (std::uint64_t i = 0; i < 8000; ++i) {
      REQUIRE(has_output(controller(state.body, goal.sample(state.time_s), 1000 * i, commands)));
      REQUIRE(quadrotor.step(state, commands, 0.001) == Status::ok);
    }
    CHECK((state.body.position_m - Vector3<double>(0, 0, -20)).norm() <= 0.01);
  }
}

TEST_CASE("a controller that changes to another airframe and other limits flies as one that was made of them") {
  Airframe<double> other = vehicle().airframe();
  other.rotors[0].y_m *= 1.4;  // who desaturates by it gives up another share of the torque
  FlightLimits<double> low;
  low.max_horizontal_acceleration_m_s2 = 2;
  const FlightController<double> outer({}, low);
  using Tracking = TrackingController<double, Analytic>;
  Tracking changes(vehicle().airframe(), FlightController<double>{}, analytic_inverse());
  Tracking stays = changes, made(other, outer, analytic_inverse());
  State<double> far;
  far.position_m = course().center_m + Vector3<double>(20, -9, 30);
  far.body_rates_rad_s = Vector3<double>(6, -5, 2);
  const TrajectoryPoint<double> point = course().sample(0.0);
  Commands<double> before{}, after{}, unchanged{}, wanted{};
  REQUIRE(has_output(changes(far, point, 2'000, before)));
  changes.change_to(other, outer);
  REQUIRE(has_output(changes(far, point, 4'000, after)));
  REQUIRE(has_output(stays(far, point, 4'000, unchanged)));
  REQUIRE(has_output(made(far, point, 4'000, wanted)));
  CHECK(before == unchanged);
  CHECK(after == wanted);
  CHECK(after != before);
}

TEST_CASE("float flies it too") {
  using FloatVehicle = Quadrotor<float, StandardAtmosphere, QuadraticDrag>;
  const FloatVehicle quadrotor(airframe_value<PaperQuadrotor, float>(), paper_site<float>(), {}, {});
  FigureEight<float> eight;
  eight.center_m[2] = -20;
  const TrackingResult<float> result =
      track(quadrotor, eight, FlightController<float>{}, AnalyticInverse<FloatVehicle>(quadrotor));
  CHECK(result.status == Status::ok);
  CHECK(result.rmse_m < 0.05f);
}

TEST_CASE("bad input ends the flight with its Status") {
  FigureEight<double> broken = course();
  broken.half_width_m = std::numeric_limits<double>::quiet_NaN();
  const TrackingResult<double> result = track(vehicle(), broken, FlightController<double>{}, analytic_inverse());
  CHECK(result.status == Status::not_finite);
  CHECK(result.flown_s == 0);

  TrackingController<double, Analytic> controller(vehicle().airframe(), FlightController<double>{}, analytic_inverse());
  Commands<double> commands{42, 42, 42, 42};
  State<double> state;
  state.velocity_m_s[0] = std::numeric_limits<double>::infinity();
  CHECK(controller(state, course().sample(1.0), 1'000'000, commands) == Status::not_finite);
  CHECK(commands[0] == 42);
}
