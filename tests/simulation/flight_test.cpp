// SPDX-License-Identifier: MIT
// Recorded flights: repeatable, within bounds, and true to the dynamics that made them.
#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/simulation/simulator.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"
#include "pinnquad/evaluation/summary.hpp"
#include "support/long_flight.hpp"

namespace {

using namespace pinnquad;

using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;

template <class Name = PaperQuadrotor>
Vehicle vehicle() {
  return Vehicle(airframe_value<Name, double>(), paper_site<double>(), {}, {});
}

RandomPilot<std::mt19937_64> pilot(const Vehicle& quadrotor, std::uint64_t seed) {
  return RandomPilot<std::mt19937_64>(std::mt19937_64(seed), pilot_style(quadrotor, FlightPlan{}.start_m),
                                      quadrotor.site().ground_z_m);
}

RecordedFlight flown(std::uint64_t seed, std::size_t samples, const Vehicle& quadrotor = vehicle()) {
  FlightPlan plan;
  plan.samples = samples;
  return fly(quadrotor, pilot(quadrotor, seed), plan);
}

State<double> state_of(const Vehicle& quadrotor, const Sample& sample) {
  State<double> state;
  state.attitude = from_euler<double>({sample.roll_rad, sample.pitch_rad, sample.yaw_rad});
  state.velocity_m_s = body_to_world(state.attitude, sample.velocity_m_s);
  state.body_rates_rad_s = sample.body_rates_rad_s;
  state.position_m[2] = quadrotor.site().ground_z_m - sample.altitude_m;
  return state;
}

Commands<double> inverse_of(const Vehicle& quadrotor, const Sample& sample) {
  Commands<double> commands{};
  const Accelerations<double> motion{sample.linear_acceleration_m_s2, sample.angular_acceleration_rad_s2};
  REQUIRE(inverse_commands(quadrotor, state_of(quadrotor, sample), motion, sample.time_s, commands) == Status::ok);
  return commands;
}

std::vector<double> features_of(const Sample& s) {
  const Sample::Values v = to_values(s);
  std::vector<double> x(v.begin() + 1, v.begin() + 15);
  x.push_back(std::sin(s.yaw_rad));
  x.push_back(std::cos(s.yaw_rad));
  return x;
}

}  // namespace

TEST_CASE("the same seed gives the same bits, another seed another flight") {
  const RecordedFlight first = flown(3, 400), again = flown(3, 400), other = flown(4, 400);
  REQUIRE(first.report.rows == 400);
  CHECK(content_hash(first.flight) == content_hash(again.flight));
  CHECK(content_hash(first.flight) != content_hash(other.flight));
}

TEST_CASE("rows come at exact multiples of the sample period, from a hover") {
  const RecordedFlight recorded = flown(1, 100);
  CHECK(FlightPlan{}.sample_period_s() == doctest::Approx(0.05).epsilon(1e-15));
  for (std::size_t i = 0; i < recorded.flight.size(); ++i) {
    CHECK(recorded.flight[i].time_s == static_cast<double>(i + 1) * FlightPlan{}.sample_period_s());
  }
  CHECK(recorded.flight[0].velocity_m_s.norm() < 0.2);
}

TEST_CASE("recorded accelerations are the derivatives of recorded velocities") {
  // A row every 0.1 ms: central differences err by h / 4 times the jump in jerk where a command changes, up to
  // 3e4 rad/s^3 at a stick frame: below 1 rad/s^2 at the worst instant, and a hundredth of the signal in the mean.
  FlightPlan plan;
  plan.samples = 20000;
  plan.physics_step_s = 1e-4;
  plan.steps_per_control = 1;
  plan.controls_per_sample = 1;
  const Vehicle quadrotor = vehicle();
  const Flight flight = fly(quadrotor, pilot(quadrotor, 2), plan).flight;
  REQUIRE(flight.size() == plan.samples);
  constexpr double mean_square_tolerance = 1e-4;  // 1 % of the signal
  Vector3<double> linear_error = Vector3<double>::Zero(), linear = linear_error, angular_error = linear_error,
                  angular = linear_error;
  for (std::size_t i = 1; i + 1 < flight.size(); ++i) {
    const double scale = 1 / (flight[i + 1].time_s - flight[i - 1].time_s);
    const Vector3<double> v_dot = (flight[i + 1].velocity_m_s - flight[i - 1].velocity_m_s) * scale;
    const Vector3<double> w_dot = (flight[i + 1].body_rates_rad_s - flight[i - 1].body_rates_rad_s) * scale;
    linear_error += (v_dot - flight[i].linear_acceleration_m_s2).cwiseAbs2();
    linear += flight[i].linear_acceleration_m_s2.cwiseAbs2();
    angular_error += (w_dot - flight[i].angular_acceleration_rad_s2).cwiseAbs2();
    angular += flight[i].angular_acceleration_rad_s2.cwiseAbs2();
  }
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    CHECK(linear_error[axis] <= mean_square_tolerance * linear[axis]);
    CHECK(angular_error[axis] <= mean_square_tolerance * angular[axis]);
  }
}

TEST_CASE("motion and command: alike behind the rotor lag, the same without it") {
  SUBCASE("5 ms lag") {
    const Vehicle quadrotor = vehicle();
    double squares = 0;
    std::size_t count = 0;
    for (const Sample& sample : flown(1, 2000).flight) {
      const Commands<double> inverse = inverse_of(quadrotor, sample);
      for (std::size_t i = 0; i < 4; ++i) {
        squares += (inverse[i] - sample.commands[i]) * (inverse[i] - sample.commands[i]);
        ++count;
      }
    }
    const double rmse = std::sqrt(squares / static_cast<double>(count));
    CHECK(rmse < 0.012);  // 5 ms times the commands' rate of change
    CHECK(rmse > 0.004);  // and no identity
  }
  SUBCASE("no lag") {
    Airframe<double> airframe = airframe_value<PaperQuadrotor, double>();
    airframe.rotor_time_constant_s = 0;
    const Vehicle quadrotor(airframe, paper_site<double>(), {}, {});
    constexpr double rounding = 1e-9;  // Euler angles in between; drag's deadband may flip an axis at 0.1 m/s: 1e-4 N
    for (const Sample& sample : flown(1, 500, quadrotor).flight) {
      const Commands<double> inverse = inverse_of(quadrotor, sample);
      for (std::size_t i = 0; i < 4; ++i) CHECK(inverse[i] == doctest::Approx(sample.commands[i]).epsilon(rounding));
    }
  }
}

TEST_CASE("a row holds the command as the rotors clip it, and the height above ground") {
  VehicleState<double> state;
  state.body.position_m[2] = -10;
  state.time_s = 1.5;
  const Sample sample = ExactRecorder{}(vehicle(), state, {-0.2, 0.3, 1.4, 1.0});
  CHECK(sample.commands == Commands<double>{0.0, 0.3, 1.0, 1.0});
  CHECK(sample.altitude_m == 10.877);
  CHECK(sample.time_s == 1.5);
  CHECK(sample.linear_acceleration_m_s2[2] == standard_gravity_m_s2<double>);  // rotors still: free fall
}

TEST_CASE("tilt: the angle between the body's down axis and the world's") {
  const auto tilt = [](double roll, double pitch) { return tilt_rad(from_euler<double>({roll, pitch, 1.1})); };
  CHECK(tilt(0, 0) <= 1e-7);  // the cosine's rounding
  CHECK(tilt(0.3, 0) == doctest::Approx(0.3).epsilon(1e-12));
  CHECK(tilt(0, -0.7) == doctest::Approx(0.7).epsilon(1e-12));
  CHECK(tilt(0.4, 0.6) == doctest::Approx(std::acos(std::cos(0.4) * std::cos(0.6))).epsilon(1e-12));
  CHECK(tilt(3.0, 0) == doctest::Approx(3.0).epsilon(1e-12));
  CHECK(tilt_rad({0, 1, 0, 0}) == doctest::Approx(3.141592653589793));
}

TEST_CASE("a report's figures are those of the rows") {
  // a vehicle that can hardly climb, under a pilot who was not told
  const Vehicle heavy = vehicle<ReferenceQuadrotor15>();
  FlightPlan plan;
  plan.samples = 400;
  const RecordedFlight recorded = fly(heavy, RandomPilot<std::mt19937_64>(std::mt19937_64(5)), plan);
  const FlightReport& report = recorded.report;
  double fastest_m_s = 0, steepest_rad = 0, lowest_m = 1e9, highest_m = -1e9;
  std::size_t at_end = 0;
  for (const Sample& sample : recorded.flight) {
    fastest_m_s = std::max(fastest_m_s, sample.velocity_m_s.norm());
    steepest_rad = std::max(steepest_rad, std::acos(std::cos(sample.roll_rad) * std::cos(sample.pitch_rad)));
    lowest_m = std::min(lowest_m, sample.altitude_m);
    highest_m = std::max(highest_m, sample.altitude_m);
    bool end = false;
    for (const double u : sample.commands) end = end || u == 0 || u == 1;
    at_end += end ? 1 : 0;
  }
  constexpr double rounding = 1e-9;
  CHECK(report.rows == recorded.flight.size());
  CHECK(report.max_speed_m_s == doctest::Approx(fastest_m_s).epsilon(rounding));
  CHECK(report.max_tilt_rad == doctest::Approx(steepest_rad).epsilon(rounding));
  CHECK(report.min_altitude_m == lowest_m);
  CHECK(report.max_altitude_m == highest_m);
  CHECK(report.saturated_share == static_cast<double>(at_end) / static_cast<double>(report.rows));
  CHECK(at_end > 0);
  CHECK(at_end < report.rows);
  CHECK(steepest_rad > 0.1);
}

TEST_CASE("bounds over seeds: speed, tilt, altitude, saturation" * pinnquad::test::long_flight()) {
  const PilotStyle style;
  for (std::uint64_t seed = 11; seed < 14; ++seed) {
    CAPTURE(seed);
    const RecordedFlight recorded = flown(seed, 2000);
    const FlightReport& report = recorded.report;
    CHECK(report.end == FlightEnd::completed);
    CHECK(report.rows == 2000);
    CHECK(report.max_speed_m_s < 1.05 * style.max_speed_m_s);
    CHECK(report.max_speed_m_s > 0.85 * style.max_speed_m_s);
    CHECK(report.min_altitude_m > style.lowest_m);
    CHECK(report.max_altitude_m < style.highest_m);
    CHECK(report.max_tilt_rad < 0.95);  // 54 degrees, 49 of them asked for: no gimbal lock in the Euler angles
    CHECK(report.max_tilt_rad > 0.8);
    CHECK(report.saturated_share < 0.03);
    CHECK(report.saturated_share > 0);
    for (const Sample& sample : recorded.flight) {
      for (const double u : sample.commands) CHECK((u >= 0 && u <= 1));
    }
  }
}

TEST_CASE("a full flight: signed command sums follow angular accelerations, and the blocks of the split are alike" *
          pinnquad::test::long_flight()) {
  const Vehicle quadrotor = vehicle();
  const Flight flight = flown(1, 15000).flight;
  REQUIRE(flight.size() == 15000);
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    const std::array<double, 4> signs = allocation_signs(quadrotor.airframe(), axis);
    std::vector<double> sums, accelerations;
    for (const Sample& sample : flight) {
      sums.push_back(signed_sum(signs, sample.commands));
      accelerations.push_back(sample.angular_acceleration_rad_s2[axis]);
    }
    const double correlation = pearson_correlation(sums, accelerations);
    CHECK(correlation > 0.95);
    CHECK(correlation < 0.995);  // Fig. 2: the lag shows
  }
  const auto split = split_contiguous(flight.size());
  std::vector<double> lowest = features_of(flight[0]), highest = lowest;
  for (std::size_t i = split.train.begin; i < split.train.end; ++i) {
    const std::vector<double> x = features_of(flight[i]);
    for (std::size_t k = 0; k < x.size(); ++k) {
      lowest[k] = std::min(lowest[k], x[k]);
      highest[k] = std::max(highest[k], x[k]);
    }
  }
  std::size_t outside = 0;
  for (std::size_t i = split.test.begin; i < split.test.end; ++i) {
    const std::vector<double> x = features_of(flight[i]);
    bool out = false;
    for (std::size_t k = 0; k < x.size(); ++k) out |= x[k] < lowest[k] || x[k] > highest[k];
    outside += out ? 1 : 0;
  }
  CHECK(outside <= split.test.size() / 20);  // 5 %
}

TEST_CASE("a vehicle that can hardly climb flies within what it can") {
  const Vehicle heavy = vehicle<ReferenceQuadrotor15>();
  const PilotStyle style = pilot_style(heavy, FlightPlan{}.start_m);
  CHECK(style.max_climb_m_s < 4);
  CHECK(style.max_yaw_rate_rad_s < PilotStyle{}.max_yaw_rate_rad_s);
  CHECK(pilot_style(vehicle(), FlightPlan{}.start_m).max_climb_m_s == doctest::Approx(8));
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const FlightReport report = flown(seed, 3000, heavy).report;
    CHECK(report.end == FlightEnd::completed);
    CHECK(report.max_tilt_rad < 1.05);
  }
}

TEST_CASE("effects compose: ground effect near the ground changes the flight") {
  const Quadrotor<double, StandardAtmosphere, QuadraticDrag, GroundEffect<Conyers>> quadrotor(
      airframe_value<PaperQuadrotor, double>(), paper_site<double>(), {}, {}, {});
  FlightPlan plan;
  plan.samples = 40;
  plan.start_m = Vector3<double>(0, 0, 0.5);  // 0.38 m above ground
  const RecordedFlight recorded = fly(quadrotor, SteadyPilot{}, plan);
  CHECK(recorded.report.end == FlightEnd::completed);
  CHECK(recorded.flight.back().commands[0] !=
        doctest::Approx(inverse_of(vehicle(), recorded.flight.back())[0]).epsilon(1e-3));
}

TEST_CASE("an observer is told each row, with the true state") {
  FlightPlan plan;
  plan.samples = 7;
  std::size_t calls = 0;
  fly(vehicle(), SteadyPilot{}, plan, [&calls](const auto& flies) {
    ++calls;
    CHECK(flies.recording().size() == calls);
    CHECK(flies.vehicle().time_s == flies.recording().back().time_s);
    CHECK(flies.vehicle().body.position_m[2] == doctest::Approx(-35));
  });
  CHECK(calls == 7);
}
