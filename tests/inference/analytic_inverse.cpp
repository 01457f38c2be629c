// SPDX-License-Identifier: MIT
#include "pinnquad/inference/analytic_inverse.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/dryden.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/random_states.hpp"

using namespace pinnquad;
using pinnquad::test::RandomStates;

namespace {

template <class... Effects>
Quadrotor<double, Effects...> vehicle(Effects... effects) {
  return Quadrotor<double, Effects...>(airframe_value<PaperQuadrotor, double>(), paper_site<double>(), effects...);
}

/// The commands that the vehicle's own inverse gives for the whole state.
template <class Quad>
Commands<double> expected_of(const Quad& quadrotor, const State<double>& state, const Accelerations<double>& motion,
                             double time_s) {
  Commands<double> commands{};
  REQUIRE(inverse_commands(quadrotor, state, motion, time_s, commands) == Status::ok);
  return commands;
}

/// Double arithmetic of another order: velocity into the body frame and back.
constexpr double rounding = 1e-9;

double apart(const Accelerations<double>& a, const Accelerations<double>& b) {
  return (a.linear_m_s2 - b.linear_m_s2).norm() + (a.angular_rad_s2 - b.angular_rad_s2).norm();
}

void check_equal(const Commands<double>& a, const Commands<double>& b) {
  for (std::size_t i = 0; i < 4; ++i) CHECK(std::fabs(a[i] - b[i]) <= rounding * (1 + std::fabs(b[i])));
}

}  // namespace

TEST_CASE("what the answer varies with is the most that an effect does") {
  CHECK(AnalyticInverse<Quadrotor<float>>::varies_with == VariesWith::motion);
  CHECK(AnalyticInverse<Quadrotor<float, QuadraticDrag, RotorDrag, ConstantWind>>::varies_with == VariesWith::motion);
  CHECK(AnalyticInverse<Quadrotor<float, QuadraticDrag, StandardAtmosphere>>::varies_with == VariesWith::height);
  CHECK(AnalyticInverse<Quadrotor<float, GroundEffect<Conyers>>>::varies_with == VariesWith::height);
  CHECK(AnalyticInverse<Quadrotor<float, StandardAtmosphere, PeriodicWind>>::varies_with == VariesWith::place_and_time);
  CHECK(AnalyticInverse<Quadrotor<float, DrydenTurbulence<>>>::varies_with == VariesWith::place_and_time);
}

TEST_CASE("effects that say they don't vary with place and time don't") {
  RandomStates random(201);
  const auto anywhere = vehicle(ConstantWind{{3.0, -2.0, 0.5}}, QuadraticDrag{}, RotorDrag{});
  const auto by_height = vehicle(StandardAtmosphere{}, QuadraticDrag{}, GroundEffect<Conyers>{});
  for (int i = 0; i < test::draws; ++i) {
    auto state = random.state<double>();
    const auto commands = random.commands<double>();
    const auto here = anywhere.evaluate(state, commands, 0.0).motion;
    const auto low = by_height.evaluate(state, commands, 0.0).motion;
    state.position_m[0] += 40;
    state.position_m[1] -= 70;
    CHECK(apart(by_height.evaluate(state, commands, 17.0).motion, low) <= rounding);
    state.position_m[2] -= 500;
    CHECK(apart(anywhere.evaluate(state, commands, 17.0).motion, here) <= rounding);
    CHECK(apart(by_height.evaluate(state, commands, 17.0).motion, low) > 1e-3);  // a twentieth of the air's density
  }
}

TEST_CASE("from the network's inputs: the same commands as from the whole state") {
  RandomStates random(202);
  const auto anywhere = vehicle(ConstantWind{{3.0, -2.0, 0.5}}, QuadraticDrag{}, RotorDrag{});
  const auto by_height = vehicle(StandardAtmosphere{}, QuadraticDrag{}, GroundEffect<Conyers>{});
  const auto gusty = vehicle(StandardAtmosphere{}, PeriodicWind{}, QuadraticDrag{}, GroundEffect<Conyers>{});
  for (int i = 0; i < test::draws; ++i) {
    auto state = random.state<double>();
    state.position_m[2] = 0.877 - random.scalar<double>(0.3, 8.0);  // near the ground, where height matters
    const auto motion = random.motion<double>();
    const auto time_us = static_cast<std::uint64_t>(random.scalar<double>(0, 20e6));
    const double time_s = seconds_of(time_us);
    MotionInputsWithAltitude<double> inputs;
    static_cast<MotionInputs<double>&>(inputs) = motion_inputs(state, motion);
    inputs.altitude_m = 0.877 - state.position_m[2];
    const MotionInputs<double>& without_altitude = inputs;
    const PlaceAndTime<double> place{state.position_m, time_s};
    Commands<double> commands{};

    REQUIRE(AnalyticInverse<std::decay_t<decltype(anywhere)>>(anywhere)(without_altitude, commands) == Status::ok);
    check_equal(commands, expected_of(anywhere, state, motion, time_s));
    const AnalyticInverse<std::decay_t<decltype(by_height)>> height(by_height);
    REQUIRE(height(inputs, commands) == Status::ok);
    check_equal(commands, expected_of(by_height, state, motion, time_s));
    REQUIRE(height(without_altitude, place, commands) == Status::ok);
    check_equal(commands, expected_of(by_height, state, motion, time_s));
    const AnalyticInverse<std::decay_t<decltype(gusty)>> wind(gusty);
    REQUIRE(wind(without_altitude, place, commands) == Status::ok);
    check_equal(commands, expected_of(gusty, state, motion, time_s));
    // the altitude measured outweighs the place's height
    PlaceAndTime<double> drifted = place;
    drifted.position_m[2] -= 3;
    REQUIRE(wind(inputs, drifted, commands) == Status::ok);
    check_equal(commands, expected_of(gusty, state, motion, time_s));
    // as a feed-forward policy
    REQUIRE(wind(state, motion, time_us, commands) == Status::ok);
    check_equal(commands, expected_of(gusty, state, motion, time_s));
  }
}

TEST_CASE("an attitude that is a unit quaternion only to its tolerance is the rotation that the features see") {
  RandomStates random(203);
  const auto quadrotor = vehicle(QuadraticDrag{});
  const AnalyticInverse<std::decay_t<decltype(quadrotor)>> inverse(quadrotor);
  for (int i = 0; i < test::draws; ++i) {
    auto inputs = motion_inputs(random.state<double>(), random.motion<double>());
    Commands<double> exact{}, stretched{};
    REQUIRE(inverse(inputs, exact) == Status::ok);
    for (double* part : {&inputs.attitude.w, &inputs.attitude.x, &inputs.attitude.y, &inputs.attitude.z})
      *part *= 1.0004;
    REQUIRE(inverse(inputs, stretched) == Status::ok);
    check_equal(stretched, exact);
  }
}

TEST_CASE("bad inputs, places and times are refused; what does not fit the narrower scalar too") {
  RandomStates random(204);
  const auto quadrotor = vehicle(StandardAtmosphere{}, PeriodicWind{}, QuadraticDrag{});
  const AnalyticInverse<std::decay_t<decltype(quadrotor)>> inverse(quadrotor);
  MotionInputs<float> inputs;
  PlaceAndTime<double> place;
  const Commands<float> before{1.0F, 2.0F, 3.0F, 4.0F};
  Commands<float> commands = before;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    auto broken = place;
    broken.position_m[2] = bad;
    CHECK(inverse(inputs, broken, commands) == Status::not_finite);
    broken = place;
    broken.time_s = bad;
    CHECK(inverse(inputs, broken, commands) == Status::not_finite);
    auto broken_inputs = inputs;
    broken_inputs.attitude.w = float(bad);
    CHECK(inverse(broken_inputs, place, commands) == Status::not_finite);
  }
  inputs.attitude = {0.0F, 0.0F, 0.0F, 0.0F};
  CHECK(inverse(inputs, place, commands) == Status::not_unit_quaternion);
  inputs.attitude = {};
  inputs.velocity_m_s[0] = 1e30F;  // v^2 is a double, not a float
  inputs.velocity_m_s[2] = 1e30F;
  CHECK(inverse(inputs, place, commands) == Status::output_not_finite);
  CHECK(commands == before);
  inputs.velocity_m_s.setZero();
  CHECK(inverse(inputs, place, commands) == Status::ok);
}
