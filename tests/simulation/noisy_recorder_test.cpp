// SPDX-License-Identifier: MIT
// A noisy recorder: the errors that were ordered, no others, and what they do to the correlation of Fig. 2.
#include "pinnquad/simulation/recorder.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/evaluation/summary.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/simulation/simulator.hpp"
#include "support/long_flight.hpp"

namespace {

using namespace pinnquad;

using Engine = std::mt19937_64;
using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;
using Recorder = NoisyRecorder<Engine>;

Vehicle vehicle() { return Vehicle(airframe_value<PaperQuadrotor, double>(), paper_site<double>(), {}, {}); }

RandomPilot<Engine> pilot(const Vehicle& quadrotor, std::uint64_t seed) {
  return RandomPilot<Engine>(Engine(seed), pilot_style(quadrotor, FlightPlan{}.start_m), quadrotor.site().ground_z_m);
}

VehicleState<double> turning() {
  VehicleState<double> state;
  state.body.position_m = Vector3<double>(3, -4, -20);
  state.body.attitude = from_euler<double>({0.3, -0.2, 2.5});
  state.body.velocity_m_s = Vector3<double>(2, 1, -3);
  state.body.body_rates_rad_s = Vector3<double>(0.5, -0.4, 0.2);
  state.rotors = {0.4, 0.5, 0.6, 0.7};
  state.time_s = 1.25;
  return state;
}

constexpr Commands<double> some_commands{0.41, 0.52, 0.63, 0.74};

/// `count` rows of the same instant: what differs from row to row is noise.
std::vector<Sample::Values> rows_of_one_instant(const RecorderErrors& errors, std::size_t count,
                                                std::uint64_t seed = 5) {
  Recorder recorder(Engine(seed), errors);
  const VehicleState<double> state = turning();
  recorder.hold(some_commands, state.time_s - 0.002);
  std::vector<Sample::Values> rows;
  for (std::size_t i = 0; i < count; ++i) rows.push_back(to_values(recorder(vehicle(), state, some_commands)));
  return rows;
}

Sample::Values exact_row() { return to_values(ExactRecorder{}(vehicle(), turning(), some_commands)); }

constexpr std::size_t first_acceleration = 4, first_velocity = 7, first_rate = 10, first_angle = 13, altitude = 16;

std::vector<double> noise_of(const std::vector<Sample::Values>& rows, std::size_t field) {
  std::vector<double> noise;
  for (const Sample::Values& row : rows) noise.push_back(row[field] - exact_row()[field]);
  return noise;
}

double deviation(const std::vector<double>& values) {
  double squares = 0;
  for (const double v : values) squares += v * v;
  return std::sqrt(squares / static_cast<double>(values.size()));  // the mean is 0
}

/// doctest's Approx is absolute for small values; deviations are compared by their ratio.
bool within(double share, double value, double expected) { return std::abs(value / expected - 1) < share; }

}  // namespace

static_assert(is_recorder<ExactRecorder> && is_recorder<Recorder>);
static_assert(!is_recorder<int> && !is_recorder<SteadyPilot>);

TEST_CASE("without errors the rows are those of the exact recorder") {
  CHECK(rows_of_one_instant({}, 1)[0] == exact_row());
  const Vehicle quadrotor = vehicle();
  FlightPlan plan;
  plan.samples = 200;
  const Flight exact = fly(quadrotor, pilot(quadrotor, 1), plan).flight;
  const Flight noisy = fly(quadrotor, pilot(quadrotor, 1), plan, Recorder(Engine(9))).flight;
  REQUIRE(noisy.size() == exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i) REQUIRE(to_values(noisy[i]) == to_values(exact[i]));
}

TEST_CASE("gyro noise: white in the rates, its difference over the interval in the accelerations") {
  constexpr std::size_t count = 20000;
  constexpr double sampling_error = 0.03;  // four standard errors of 20,000 values
  RecorderErrors errors;
  errors.gyro_noise_rad_s = 0.02;
  errors.derivative_interval_s = 0.008;
  const std::vector<Sample::Values> rows = rows_of_one_instant(errors, count);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    const std::vector<double> rates = noise_of(rows, first_rate + axis);
    const std::vector<double> accelerations = noise_of(rows, first_acceleration + axis);
    CHECK(within(sampling_error, deviation(rates), 0.02));
    CHECK(within(sampling_error, deviation(accelerations), std::sqrt(2.0) * 0.02 / 0.008));
    // the later of the two gyro samples is the one of the rates
    CHECK(within(sampling_error, pearson_correlation(rates, accelerations), std::sqrt(0.5)));
    const std::vector<double> earlier(rates.begin(), rates.end() - 1), later(rates.begin() + 1, rates.end());
    CHECK(std::abs(pearson_correlation(earlier, later)) < sampling_error);
    for (std::size_t other = 0; other < axis; ++other) {
      CHECK(std::abs(pearson_correlation(rates, noise_of(rows, first_rate + other))) < sampling_error);
    }
  }
  for (const Sample::Values& row : rows) {
    for (const std::size_t field : {1u, 2u, 3u, 7u, 8u, 9u, 13u, 14u, 15u, 16u, 17u, 18u, 19u, 20u}) {
      REQUIRE(row[field] == exact_row()[field]);  // and nothing else
    }
  }
}

TEST_CASE("velocity and attitude noise have the deviations ordered") {
  constexpr double sampling_error = 0.03;
  RecorderErrors errors;
  errors.velocity_noise_m_s = 0.1;
  errors.attitude_noise_rad = 0.01;
  const std::vector<Sample::Values> rows = rows_of_one_instant(errors, 20000);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CHECK(within(sampling_error, deviation(noise_of(rows, first_velocity + axis)), 0.1));
    CHECK(deviation(noise_of(rows, first_rate + axis)) == 0);
  }
  // a turn about the body's y and z axes changes pitch by cos(roll) and -sin(roll) of it: the deviation stays
  CHECK(within(sampling_error, deviation(noise_of(rows, first_angle + 1)), 0.01));
  CHECK(deviation(noise_of(rows, altitude)) == 0);
}

TEST_CASE("one error changed leaves the noise of the others alone") {
  RecorderErrors gyro, both;
  gyro.gyro_noise_rad_s = both.gyro_noise_rad_s = 0.02;
  both.velocity_noise_m_s = 0.3;
  both.command_jitter_s = 0.01;
  const std::vector<Sample::Values> a = rows_of_one_instant(gyro, 50), b = rows_of_one_instant(both, 50);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t field = 0; field < 3; ++field) {
      REQUIRE(a[i][first_rate + field] == b[i][first_rate + field]);
      REQUIRE(a[i][first_acceleration + field] == b[i][first_acceleration + field]);
    }
  }
  CHECK(rows_of_one_instant(gyro, 50) == a);
  CHECK(rows_of_one_instant(gyro, 50, 6) != a);
}

TEST_CASE("a late command is the one that was held so long ago") {
  const Vehicle quadrotor = vehicle();
  constexpr double tick_s = 0.002;
  const auto number = [](int tick) { return Commands<double>{tick * 1e-3, 0.5, -0.5, 1.5}; };
  RecorderErrors errors;
  SUBCASE("latency of whole ticks, found in spite of rounding") {
    errors.command_latency_s = 0.010;
    Recorder recorder(Engine(1), errors);
    VehicleState<double> state = turning();
    state.time_s = 0;
    for (int tick = 0; tick < 400; ++tick) {
      recorder.hold(number(tick), state.time_s);
      state.time_s += tick_s;  // a row after this tick lies at (tick + 1) * 2 ms
      const Sample sample = recorder(quadrotor, state, number(tick));
      const int in_force = tick + 1 - 5 < 0 ? 0 : tick + 1 - 5;  // before the first tick: the first
      REQUIRE(sample.commands == Commands<double>{in_force * 1e-3, 0.5, 0.0, 1.0});
    }
  }
  SUBCASE("no latency: the last") {
    Recorder recorder(Engine(1), errors);
    VehicleState<double> state = turning();
    recorder.hold(number(1), state.time_s - 2 * tick_s);
    recorder.hold(number(2), state.time_s - tick_s);
    CHECK(recorder(quadrotor, state, number(2)).commands[0] == 2e-3);
  }
  SUBCASE("jitter: uniform between latency and latency + jitter") {
    errors.command_latency_s = 0.010;
    errors.command_jitter_s = 0.020;
    Recorder recorder(Engine(1), errors);
    VehicleState<double> state = turning();
    state.time_s = 0.2;
    for (int tick = 0; tick < 100; ++tick) recorder.hold(number(tick), tick * tick_s);
    std::array<int, 100> count{};
    constexpr int rows = 20000;
    for (int row = 0; row < rows; ++row) {
      ++count[static_cast<std::size_t>(std::lround(recorder(quadrotor, state, number(99)).commands[0] * 1e3))];
    }
    for (std::size_t tick = 0; tick < 100; ++tick) {  // 0.17 to 0.19 s: ticks 85 to 94
      if (tick < 85 || tick > 94) {
        CHECK(count[tick] <= (tick == 95 ? 1 : 0));
      } else {
        CHECK(count[tick] == doctest::Approx(rows / 10.0).epsilon(0.1));  // four standard errors
      }
    }
  }
}

namespace {

constexpr int recorders = 3;

/// Three recorders of one flight.
struct Together {
  std::array<std::vector<Sample>, recorders>* rows;
  ExactRecorder exact{};
  Recorder noisy_gyro;
  Recorder late;

  void hold(const Commands<double>& commands, double time_s) {
    noisy_gyro.hold(commands, time_s);
    late.hold(commands, time_s);
  }
  template <class... Effects>
  Sample operator()(const Quadrotor<double, Effects...>& quadrotor, const VehicleState<double>& state,
                    const Commands<double>& commands) {
    (*rows)[0].push_back(exact(quadrotor, state, commands));
    (*rows)[1].push_back(noisy_gyro(quadrotor, state, commands));
    (*rows)[2].push_back(late(quadrotor, state, commands));
    return (*rows)[0].back();
  }
};

}  // namespace

TEST_CASE("Fig. 2: exact rows correlate above 0.95, the two stated errors bring roll to the paper's 0.67" *
          pinnquad::test::long_flight()) {
  constexpr double paper_correlation = 0.67, tolerance = 0.03;
  const Vehicle quadrotor = vehicle();
  const auto roll_signs = allocation_signs(quadrotor.airframe(), 0);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    std::array<std::vector<Sample>, recorders> rows;
    const Together together{&rows,
                            {},
                            Recorder(Engine(seed + 100), noisy_gyro_errors()),
                            Recorder(Engine(seed + 200), late_command_errors())};
    fly(quadrotor, pilot(quadrotor, seed), FlightPlan{}, together);
    std::array<double, recorders> correlation{};
    for (std::size_t i = 0; i < recorders; ++i) {
      std::vector<double> sums, accelerations;
      for (const Sample& sample : rows[i]) {
        sums.push_back(signed_sum(roll_signs, sample.commands));
        accelerations.push_back(sample.angular_acceleration_rad_s2[0]);
      }
      correlation[i] = pearson_correlation(sums, accelerations);
    }
    CHECK(correlation[0] > 0.95);
    CHECK(std::abs(correlation[1] - paper_correlation) < tolerance);
    CHECK(std::abs(correlation[2] - paper_correlation) < tolerance);
    MESSAGE("roll correlation: exact ", correlation[0], ", noisy gyro ", correlation[1], ", late commands ",
            correlation[2]);
  }
}

TEST_CASE("errors that are none refuse the flight before it begins") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto status = [](const RecorderErrors& errors) {
    Simulator<Vehicle, SteadyPilot, Recorder> simulator(vehicle(), SteadyPilot{}, {}, Recorder(Engine(1), errors));
    const bool flies = simulator.advance(0.1);
    CHECK(flies == (simulator.status() == Status::ok));
    CHECK(simulator.recording().size() == (flies ? 2 : 0));
    return simulator.status();
  };
  CHECK(status({}) == Status::ok);
  CHECK(status(noisy_gyro_errors()) == Status::ok);
  for (const double bad : {-0.01, nan, std::numeric_limits<double>::infinity()}) {
    CAPTURE(bad);
    for (double RecorderErrors::*error : {&RecorderErrors::gyro_noise_rad_s, &RecorderErrors::derivative_interval_s,
                                          &RecorderErrors::command_latency_s, &RecorderErrors::command_jitter_s,
                                          &RecorderErrors::velocity_noise_m_s, &RecorderErrors::attitude_noise_rad}) {
      RecorderErrors errors;
      errors.*error = bad;
      CHECK(status(errors) == Status::out_of_range);
    }
  }
  RecorderErrors no_time_apart;
  no_time_apart.derivative_interval_s = 0;
  CHECK(status(no_time_apart) == Status::out_of_range);
}
