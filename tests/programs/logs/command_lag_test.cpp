// SPDX-License-Identifier: MIT
#include "logs/command_lag.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "programs/logs/synthetic_flight.hpp"

using pinnquad::Flight;
using pinnquad::logs::CommandLag;
using pinnquad::logs::estimate_command_lag;
using pinnquad::logs::remove_lag;
using pinnquad::test::synthetic_flight;
using pinnquad::test::SyntheticVehicle;

TEST_CASE("a pure delay is found to a fifth of a row, on each motion") {
  for (const double delay_s : {0.0, 0.02, 0.05, 0.12}) {
    CAPTURE(delay_s);
    SyntheticVehicle vehicle;
    vehicle.motor_time_constant_s = 0;
    vehicle.delay_s = delay_s;
    vehicle.acceleration_noise_rad_s2 = 1;
    // a command acts from its row on: the motion of the next row is the first to have it
    const double expected_s = delay_s + 0.01;
    const CommandLag lag = estimate_command_lag({synthetic_flight(vehicle)}, vehicle.period_s);
    REQUIRE(lag.found);
    CHECK(lag.warning == "");
    CHECK(std::abs(lag.lag_s - expected_s) < 0.2 * vehicle.period_s);
    CHECK(lag.confidence > 0.3);
    CHECK(lag.motions[0].found);
    CHECK(lag.motions[1].found);
    CHECK(lag.motions[3].found);
  }
}

TEST_CASE("nothing is found where commands and motion have nothing to do with each other") {
  Flight flight = synthetic_flight({0.01, 300, 0.05, 0.01, 1, 0, 1});
  const Flight other = synthetic_flight({0.01, 300, 0.05, 0.01, 1, 0, 99});
  for (std::size_t row = 0; row < flight.size(); ++row) flight[row].commands = other[row].commands;
  const CommandLag lag = estimate_command_lag({flight}, 0.01);
  CHECK_FALSE(lag.found);
  CHECK(lag.lag_s == 0);
  CHECK(lag.warning.find("no lag stands out") != std::string::npos);
  CHECK(estimate_command_lag({}, 0.01).warning.find("no stretch") != std::string::npos);
  CHECK_FALSE(estimate_command_lag({Flight(10)}, 0.01).found);
}

TEST_CASE("motion before its command is said to be a clock's fault") {
  SyntheticVehicle vehicle;
  vehicle.motor_time_constant_s = 0;
  vehicle.delay_s = 0;
  const Flight flight = remove_lag(synthetic_flight(vehicle), vehicle.period_s, 0.05);
  const CommandLag lag = estimate_command_lag({flight}, vehicle.period_s);
  REQUIRE(lag.found);
  CHECK(std::abs(lag.lag_s + 0.04) < 0.002);
  CHECK(lag.warning.find("before the commands") != std::string::npos);
}

TEST_CASE("a lag between two rows is found there, not at the next row") {
  SyntheticVehicle vehicle;
  vehicle.motor_time_constant_s = 0;
  vehicle.delay_s = 0.05;
  for (const double earlier_s : {0.004, 0.013, 0.027}) {
    CAPTURE(earlier_s);
    const Flight flight = remove_lag(synthetic_flight(vehicle), vehicle.period_s, earlier_s);
    const CommandLag lag = estimate_command_lag({flight}, vehicle.period_s);
    REQUIRE(lag.found);
    CHECK(std::abs(lag.lag_s - (0.06 - earlier_s)) < 0.2 * vehicle.period_s);
  }
}

/// Rows 50 ms apart held the maximum to their own places: 8 ms were told as 3, 46 as 50.
TEST_CASE("a lag is found between rows that are far apart") {
  constexpr double period_s = 0.05;
  const auto sum = [](double t) {
    return 0.1 * std::sin(9 * t) + 0.08 * std::sin(15 * t + 1) + 0.06 * std::sin(23 * t + 2);
  };
  for (const double delay_s : {0.008, 0.022, 0.046}) {
    CAPTURE(delay_s);
    std::mt19937_64 engine(7);
    Flight flight;
    for (int row = 0; row < 1200; ++row) {
      const double t = row * period_s;
      pinnquad::Sample sample;
      sample.time_s = t;
      sample.commands = {0.4 - sum(t), 0.4 + sum(t), 0.4 + sum(t), 0.4 - sum(t)};
      sample.angular_acceleration_rad_s2[0] = 100 * sum(t - delay_s) + 2 * pinnquad::standard_normal(engine);
      flight.push_back(sample);
    }
    const CommandLag lag = estimate_command_lag({flight}, period_s);
    REQUIRE(lag.found);
    CHECK(std::abs(lag.lag_s - delay_s) < 0.003);
    CHECK(lag.give_or_take_s < 0.006);  // a tenth of a row, and little more
    CHECK(lag.likely());
    CHECK_FALSE(lag.known());
    CHECK(lag.warning.find("rows 50 ms apart don't tell it to 5 ms: it looks like") != std::string::npos);
  }
}

TEST_CASE("a lag that the flight is too short to tell to 5 ms is not known") {
  SyntheticVehicle vehicle;
  vehicle.acceleration_noise_rad_s2 = 12;
  const Flight whole = synthetic_flight(vehicle);
  Flight part;
  for (std::size_t row = 0; row < 150; ++row) part.push_back(whole[row]);
  const CommandLag all = estimate_command_lag({whole}, vehicle.period_s),
                   some = estimate_command_lag({part}, vehicle.period_s);
  CHECK(some.give_or_take_s > 3 * all.give_or_take_s);
  CHECK(all.give_or_take_s < CommandLag::known_s);
  CHECK((some.give_or_take_s <= CommandLag::known_s || !some.known()));
}

TEST_CASE("segments are not joined: a lag is looked for inside each") {
  SyntheticVehicle vehicle;
  const Flight whole = synthetic_flight(vehicle);
  std::vector<Flight> parts;
  for (std::size_t row = 0; row < whole.size(); ++row) {
    if (row % 500 == 0) parts.emplace_back();
    parts.back().push_back(whole[row]);
  }
  const CommandLag one = estimate_command_lag({whole}, 0.01), many = estimate_command_lag(parts, 0.01);
  CHECK(std::abs(many.lag_s - one.lag_s) < 0.003);
}

namespace {

/// A loop about x with rotors of 20 ms: gusts turn the vehicle, or steps of the wanted rate alone.
Flight looped(double gust_rad_s2, double steps_rad_s) {
  constexpr double period_s = 0.005, rotor_s = 0.02, gust_s = 0.3, effectiveness = 100, gain = 12, integral_gain = 30;
  std::mt19937_64 engine(3);
  double rate = 0, motor = 0, gust = 0, sum = 0, wanted = 0;
  Flight flight;
  for (int row = 0; row < 8000; ++row) {
    if (row % 60 == 0) wanted = steps_rad_s * pinnquad::standard_normal(engine);
    gust +=
        -period_s / gust_s * gust + gust_rad_s2 * std::sqrt(2 * period_s / gust_s) * pinnquad::standard_normal(engine);
    sum += period_s * (wanted - rate);
    const double command = (gain * (wanted - rate) + integral_gain * sum) / effectiveness;
    motor += (1 - std::exp(-period_s / rotor_s)) * (command - motor);
    pinnquad::Sample sample;
    sample.time_s = row * period_s;
    sample.commands = {0.4 - command / 4, 0.4 + command / 4, 0.4 + command / 4, 0.4 - command / 4};
    sample.body_rates_rad_s[0] = rate;
    sample.angular_acceleration_rad_s2[0] = effectiveness * motor + gust;
    sample.linear_acceleration_m_s2 = {0, 0, 0};
    rate += period_s * sample.angular_acceleration_rad_s2[0];
    flight.push_back(sample);
  }
  return flight;
}

}  // namespace

TEST_CASE("gusts come back through the controller, and make no lag") {
  const CommandLag quiet = estimate_command_lag({looped(0, 1)}, 0.005),
                   gusts = estimate_command_lag({looped(8, 0)}, 0.005);
  REQUIRE(quiet.known());
  CHECK(std::abs(quiet.lag_s - 0.02) < 0.005);
  CHECK((!gusts.known() || std::abs(gusts.lag_s - 0.02) < 0.005));
  CHECK((gusts.known() || gusts.warning.find("through the controller") != std::string::npos));
}

TEST_CASE("a wild hundredth of a flight does not decide its lag") {
  Flight flight = synthetic_flight();
  const CommandLag before = estimate_command_lag({flight}, 0.01);
  std::mt19937_64 engine(5);
  for (std::size_t row = flight.size() - 60; row < flight.size(); ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      flight[row].angular_acceleration_rad_s2[axis] += 300 * pinnquad::standard_normal(engine);
      flight[row].linear_acceleration_m_s2[axis] += 50 * pinnquad::standard_normal(engine);
    }
  }
  const CommandLag after = estimate_command_lag({flight}, 0.01);
  REQUIRE(before.known());
  CHECK((!after.known() || std::abs(after.lag_s - before.lag_s) < 0.005));
}

TEST_CASE("removing a lag moves a line by it, in whole and part rows, both ways") {
  std::vector<double> line;
  for (int row = 0; row < 20; ++row) line.push_back(2.0 * row);
  for (const double lag_s : {0.0, 0.02, 0.015, -0.013}) {
    CAPTURE(lag_s);
    const auto moved = remove_lag(line, 0.01, lag_s);
    std::size_t missing = 0;
    for (std::size_t row = 0; row < line.size(); ++row) {
      if (std::isnan(moved[row])) {
        missing += 1;
        continue;
      }
      CHECK(moved[row] == doctest::Approx(2 * (static_cast<double>(row) - lag_s / 0.01)));
    }
    CHECK(missing == static_cast<std::size_t>(std::ceil(std::abs(lag_s) / 0.01 - 1e-9)));
  }
}

TEST_CASE("of a flight only the commands move; rows without one are gone, extra columns stay with their rows") {
  Flight flight = synthetic_flight({0.01, 5, 0.05, 0.01, 1, 0, 1});
  std::vector<double> volts(flight.size());
  for (std::size_t row = 0; row < volts.size(); ++row) volts[row] = static_cast<double>(row);
  flight.add_column({{"battery_voltage", "V"}, volts});
  flight.name = "one";
  const Flight moved = remove_lag(flight, 0.01, 0.03);
  REQUIRE(moved.size() == flight.size() - 3);
  CHECK(moved.name == "one");
  for (std::size_t row = 0; row < moved.size(); ++row) {
    CHECK(moved[row].commands[2] == flight[row].commands[2]);
    CHECK(moved[row].time_s == flight[row + 3].time_s);
    CHECK(moved.column("battery_voltage")->values[row] == static_cast<double>(row + 3));
  }
}
