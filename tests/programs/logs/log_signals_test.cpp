// SPDX-License-Identifier: MIT
// Signals of a simulated log whose truth is known from elsewhere: derivatives and lags.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "logs/clock.hpp"
#include "logs/command_lag.hpp"
#include "logs/savitzky_golay.hpp"
#include "reference/reference_rows.hpp"

using namespace pinnquad;        // NOLINT: a test of many of its names
using namespace pinnquad::logs;  // NOLINT

namespace {

std::string circle_folder() { return test::reference_folder() + "/sih/test_circle_csv/test_circle_"; }
bool absent(const std::string& path) { return !std::ifstream(path); }

std::vector<double> column(const test::ReferenceTable& table, const std::string& name) {
  std::vector<double> values;
  for (std::size_t row = 0; row < table.size(); ++row) values.push_back(table.at(row, name));
  return values;
}
std::vector<double> seconds(const test::ReferenceTable& table) {
  std::vector<double> time_s = column(table, "timestamp");
  for (double& t : time_s) t *= 1e-6;
  return time_s;
}

}  // namespace

/// Motors of 50 ms and one sample of transport (README of the flights): from the true rates the time constant comes
/// back; the gyro's filter adds 6 ms, and its noise, which comes back as commands in this calm flight, some more.
TEST_CASE("SIH: derivative of the gyro against the truth, lag and time constant of the motors" *
          doctest::skip(absent(circle_folder() + "vehicle_angular_velocity_0.csv"))) {
  const auto table = [&](const char* topic) {
    return test::ReferenceTable(std::string(topic) + "_0.csv", circle_folder());
  };
  const auto gyro = table("vehicle_angular_velocity"), truth = table("vehicle_angular_velocity_groundtruth"),
             motors = table("actuator_motors");
  const CleanClock gyro_clock = clean_clock(seconds(gyro)), truth_clock = clean_clock(seconds(truth)),
                   motor_clock = clean_clock(seconds(motors));
  const UniformClock clock{29, 0.004, 25000};  // in Offboard, in the air
  Flight measured(clock.rows), true_flight(clock.rows);
  for (std::size_t row = 0; row < clock.rows; ++row) measured[row].time_s = true_flight[row].time_s = clock.at(row);
  const auto put = [&](std::size_t i) {
    const auto u =
        resample(motor_clock, column(motors, "control[" + std::to_string(i) + "]"), clock, Resampling::hold, 0.02);
    for (std::size_t row = 0; row < clock.rows; ++row)
      measured[row].commands[i] = true_flight[row].commands[i] = u[row];
  };
  for (std::size_t i = 0; i < 4; ++i) put(i);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    const std::string name = "xyz[" + std::to_string(axis) + "]";
    const auto w = resample(gyro_clock, column(gyro, name), clock, Resampling::linear, 0.02);
    const auto true_w = resample(truth_clock, column(truth, name), clock, Resampling::linear, 0.02);
    for (const auto* series : {&w, &true_w}) {
      REQUIRE(std::all_of(series->begin(), series->end(), [](double value) { return std::isfinite(value); }));
    }
    const auto choice = choose_savitzky_golay(w, {{0, w.size()}}, clock.period_s, 1);
    const auto derivative = savitzky_golay(w, clock.period_s, choice.filter, 1);
    const auto true_derivative = savitzky_golay(true_w, clock.period_s, {2, 1}, 1);
    for (std::size_t row = 0; row < clock.rows; ++row) {
      measured[row].body_rates_rad_s[axis] = w[row];
      measured[row].angular_acceleration_rad_s2[axis] = derivative[row];
      true_flight[row].body_rates_rad_s[axis] = true_w[row];
      true_flight[row].angular_acceleration_rad_s2[axis] = true_derivative[row];
    }
    const auto error = [&](const SavitzkyGolay& filter) {
      constexpr std::size_t gyro_delay_rows = 1, margin = 120;
      const auto got = savitzky_golay(w, clock.period_s, filter, 1);
      double squares = 0;
      for (std::size_t row = margin; row + margin < clock.rows; ++row) {
        squares += std::pow(got[row] - true_derivative[row - gyro_delay_rows], 2);
      }
      return std::sqrt(squares / static_cast<double>(clock.rows));
    };
    double best = std::numeric_limits<double>::infinity();
    for (const int order : {2, 4}) {
      for (int half = 2; half <= 100; half += 1 + half / 4) best = std::min(best, error({order, half}));
    }
    std::printf("SIH axis %d: order %d, half window %d, error %.3f, best %.3f rad/s^2\n", static_cast<int>(axis),
                choice.filter.order, choice.filter.half_window, error(choice.filter), best);
    CHECK(error(choice.filter) < 1.2 * best);
  }
  const CommandLag true_lag = estimate_command_lag({true_flight}, clock.period_s),
                   lag = estimate_command_lag({measured}, clock.period_s);
  std::printf("SIH: lag by the truth %.1f ms, by the gyro %.1f ms\n", 1e3 * true_lag.lag_s, 1e3 * lag.lag_s);
  CHECK(std::abs(true_lag.lag_s - 0.036) < 0.008);
  CHECK(lag.lag_s > true_lag.lag_s + 0.004);
  CHECK(lag.lag_s < true_lag.lag_s + 0.02);
}
