// SPDX-License-Identifier: MIT
// Signals of real and simulated logs whose truth is known from elsewhere: derivatives, lags, and checks that have
// nothing to find.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "logs/clock.hpp"
#include "logs/command_lag.hpp"
#include "logs/motor_order_check.hpp"
#include "logs/row_checks.hpp"
#include "logs/savitzky_golay.hpp"
#include "pinnquad/data/motion_checks.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "programs/logs/finite_segments.hpp"
#include "reference/reference_rows.hpp"

using namespace pinnquad;        // NOLINT: a test of many of its names
using namespace pinnquad::logs;  // NOLINT

namespace {

std::string logs_folder() { return test::reference_folder() + "/flight_logs/"; }
std::string circle_folder() { return test::reference_folder() + "/sih/test_circle_csv/test_circle_"; }
bool absent(const std::string& path) { return !std::ifstream(path); }

/// Flights of ../shared/reference/flight_logs, parted where a row is missing; commands as logged, in the order of the
/// airframe.
std::vector<Flight> logged_flights(const std::string& name, double period_s) {
  const test::ReferenceTable table(name, logs_folder());
  std::vector<Flight> flights(1);
  for (std::size_t row = 0; row < table.size(); ++row) {
    const auto vector = [&](const char* prefix) {
      const auto v = table.vector(row, prefix);
      return Vector3<double>(v[0], v[1], v[2]);
    };
    Sample sample;
    sample.time_s = table.at(row, "t");
    const double step_s = flights.back().empty() ? period_s : sample.time_s - flights.back().back().time_s;
    if (!(step_s > 0 && step_s < 1.5 * period_s)) flights.emplace_back();
    sample.body_rates_rad_s = vector("w");
    sample.velocity_m_s = vector("vb");
    sample.linear_acceleration_m_s2 = vector("ab") - cross(sample.body_rates_rad_s, sample.velocity_m_s);
    sample.angular_acceleration_rad_s2 = vector("dw");
    sample.roll_rad = table.at(row, "roll");
    sample.pitch_rad = table.at(row, "pitch");
    sample.yaw_rad = table.at(row, "yaw");
    sample.altitude_m = -table.at(row, "pz");
    sample.commands = {table.at(row, "u1"), table.at(row, "u3"), table.at(row, "u4"), table.at(row, "u2")};
    flights.back().push_back(sample);
  }
  return flights;
}

void check_nothing_found(const std::vector<Flight>& flights, double period_s, double lag_s) {
  std::vector<Flight> aligned;
  std::size_t grounded = 0;
  for (const Flight& flight : flights) {
    CHECK_FALSE(find_turning_mistake(flight).has_value());
    const RowMask out = grounded_rows(flight, period_s);
    grounded += static_cast<std::size_t>(std::count(out.begin(), out.end(), true));
    aligned.push_back(remove_lag(flight, period_s, lag_s));
  }
  CHECK(grounded == 0);
  const MotorOrderCheck order = check_motor_order(aligned, PaperQuadrotor::value<double>());
  CHECK_FALSE(order.finding.has_value());
  CHECK_FALSE(order.ambiguous);
}

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

/// Its authors took 30 ms, rows are 20 ms apart.
TEST_CASE("NanoBench: the lag, the angular acceleration of the file, and nothing to complain of" *
          doctest::skip(absent(logs_folder() + "nanobench_subset_50hz.csv"))) {
  const std::vector<Flight> flights = logged_flights("nanobench_subset_50hz.csv", 0.02);
  const CommandLag lag = estimate_command_lag(flights, 0.02);
  std::printf("NanoBench: lag %.1f ms, confidence %.2f\n", 1e3 * lag.lag_s, lag.confidence);
  CHECK(lag.found);
  CHECK(lag.warning == "");
  CHECK(std::abs(lag.lag_s - 0.03) < 0.01);
  check_nothing_found(flights, 0.02, lag.lag_s);
  // the file's derivative is filtered in its own way: alike, not equal
  std::vector<double> rate, derivative;
  for (const Sample& sample : flights.front()) {
    rate.push_back(sample.body_rates_rad_s[1]);
    derivative.push_back(sample.angular_acceleration_rad_s2[1]);
  }
  const auto choice = choose_savitzky_golay(rate, {{0, rate.size()}}, 0.02, 1);
  const auto got = savitzky_golay(rate, 0.02, choice.filter, 1);
  double both = 0, ours = 0, theirs = 0;
  for (std::size_t row = 0; row < got.size(); ++row) {
    both += got[row] * derivative[row];
    ours += got[row] * got[row];
    theirs += derivative[row] * derivative[row];
  }
  CHECK(both / std::sqrt(ours * theirs) > 0.97);
}

/// Its authors took 35 ms.
TEST_CASE("arpl: the lag, and nothing to complain of" * doctest::skip(absent(logs_folder() + "arpl_crazyflie.csv"))) {
  const std::vector<Flight> flights = logged_flights("arpl_crazyflie.csv", 0.005);
  const CommandLag lag = estimate_command_lag(flights, 0.005);
  std::printf("arpl: lag %.1f ms, confidence %.2f\n", 1e3 * lag.lag_s, lag.confidence);
  CHECK(lag.found);
  CHECK(std::abs(lag.lag_s - 0.035) < 0.006);
  check_nothing_found(flights, 0.005, lag.lag_s);
}

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
    REQUIRE(pinnquad::test::finite_segments({&w, &true_w}).size() == 1);
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
