// SPDX-License-Identifier: MIT
// No good log is refused, however it was flown; a fault is found wherever the flight has motion enough. In the
// environment PINNQUAD_FLIGHTS sets how many are flown: 56 by default, each kind at each set of rates, in both axes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "pinnquad/data/plausibility.hpp"
#include "pinnquad/logs/read_dataset.hpp"
#include "programs/logs/own_flights.hpp"
#include "support/temporary_folder.hpp"

using namespace pinnquad_test;
using pinnquad::Flight;

namespace {

struct Imported {
  std::vector<Flight> flights;
  std::string refused;  ///< or what contradicts the vehicle
  double lag_s = 0;
  bool lag_known = true, lag_likely = false;
};

Imported imported(const OwnFlight& plan, const std::vector<LoggedInstant>& instants, const std::string& mapping) {
  const TemporaryFolder folder;
  pinnquad::logs::LogSettings settings;
  settings.mapping = folder.write("own.toml", mapping);
  settings.airframe = plan.small ? "crazyflie_2_1" : "paper_quadrotor";
  const std::string log = folder.write("flight.ulg", own_ulog(instants, plan));
  Imported result;
  try {
    const auto dataset = pinnquad::logs::read_dataset({log}, settings);
    const auto& flights = dataset.flights.flights();
    result.flights.assign(flights.begin(), flights.end());
    if (!dataset.contradictions.empty()) result.refused = dataset.contradictions.front();
    result.lag_s = dataset.lag_removed_s;
    for (const std::string& warning : dataset.warnings) {
      if (warning.find("lag not known") == std::string::npos) continue;
      result.lag_known = false;
      result.lag_likely = warning.find("are removed, as it looks: give --lag") != std::string::npos;
    }
  } catch (const std::exception& error) {
    result.refused = error.what();
  }
  return result;
}

Imported imported(const OwnFlight& plan, const std::vector<LoggedInstant>& instants) {
  return imported(plan, instants, own_mapping(plan));
}

Imported imported(const OwnFlight& plan) { return imported(plan, flown_instants(plan)); }

/// The delay at which roll and pitch commands are most like what rotors and the gyro's filter make of them, both less
/// their mean over a second; before a knock, a catch or a crash.
double true_lag_s(const std::vector<LoggedInstant>& instants, const OwnFlight& plan) {
  constexpr double step_s = 0.002, filter_s = 1 / (2 * 3.14159265 * 40);
  constexpr std::size_t longest = 60, half = 250;
  constexpr int signs[2][4] = {{-1, 1, 1, -1}, {1, -1, 1, -1}};
  const double rotor_s = plan.small
                             ? pinnquad::airframe_value<pinnquad::Crazyflie, double>().rotor_time_constant_s
                             : pinnquad::airframe_value<pinnquad::PaperQuadrotor, double>().rotor_time_constant_s;
  const auto without_mean = [](const std::vector<double>& series) {
    std::vector<double> result, sums{0};
    for (const double value : series) sums.push_back(sums.back() + value);
    for (std::size_t row = half; row + half < series.size(); ++row)
      result.push_back(series[row] - (sums[row + half + 1] - sums[row - half]) / (2 * half + 1));
    return result;
  };
  const double share = plan.kind == FlightKind::knock ? 0.2 : 0.98;
  const auto last = static_cast<std::size_t>(share * static_cast<double>(instants.size()));
  std::vector<double> alike(longest, 0.0);
  for (const auto& sign : signs) {
    std::vector<double> commands, made;
    double rotor = 0, filtered = 0;
    for (std::size_t row = 0; row < last; ++row) {
      double command = 0;
      for (std::size_t k = 0; k < 4; ++k) command += sign[k] * instants[row].commands[k];
      commands.push_back(command);
      made.push_back(filtered);
      rotor += (1 - std::exp(-step_s / rotor_s)) * (command - rotor);
      filtered += (1 - std::exp(-step_s / filter_s)) * (rotor - filtered);
    }
    commands = without_mean(commands);
    made = without_mean(made);
    for (std::size_t lag = 0; lag < longest; ++lag) {
      double product = 0, squares = 0;
      for (std::size_t row = longest; row < made.size(); ++row) {
        product += commands[row - lag] * made[row];
        squares += commands[row - lag] * commands[row - lag];
      }
      alike[lag] += product / std::sqrt(squares);
    }
  }
  return step_s * static_cast<double>(std::max_element(alike.begin(), alike.end()) - alike.begin());
}

std::size_t flights_to_fly() {
  constexpr std::size_t usual = 56;
  const char* const asked = std::getenv("PINNQUAD_FLIGHTS");
  return asked != nullptr ? static_cast<std::size_t>(std::strtoul(asked, nullptr, 10)) : usual;
}

}  // namespace

/// Rows 50 ms apart were told to 5 ms, and were up to 8 ms off: what is removed of them is nearer than any guess, and
/// not known.
TEST_CASE("no own flight is refused; its lag is right to 5 ms, or not known") {
  constexpr double slow_filter_s = 0.008, known_s = 0.005, likely_s = 0.01, far_apart_s = 0.05;
  std::size_t known = 0, likely = 0, close = 0, far = 0;
  for (std::size_t n = 0; n < flights_to_fly(); ++n) {
    const OwnFlight plan = own_flight(n);
    CAPTURE(n);
    CAPTURE(flight_kind_names[static_cast<std::size_t>(plan.kind)]);
    const std::vector<LoggedInstant> instants = flown_instants(plan);
    const Imported read = imported(plan, instants);
    CHECK(read.refused == "");
    if (!read.refused.empty()) continue;
    const double row_s = read.flights[0][1].time_s - read.flights[0][0].time_s;
    const bool far_apart = row_s > 0.9 * far_apart_s;
    CHECK_FALSE((far_apart && read.lag_known));
    (far_apart ? far : close) += 1;
    if (!read.lag_known && !read.lag_likely) continue;
    (read.lag_known ? known : likely) += 1;
    const double lag_s = true_lag_s(instants, plan), tolerance_s = read.lag_known ? known_s : likely_s;
    CHECK(read.lag_s > lag_s - tolerance_s);  // an angular acceleration of the log is filtered once more
    CHECK(read.lag_s < lag_s + tolerance_s + (plan.derivative ? slow_filter_s : 0));
  }
  CHECK(10 * known > 8 * close);
  CHECK(2 * likely > far);
}

/// Roll, pitch and yaw answer a knock before the commands do: 49 ms were removed, the wrong way.
TEST_CASE("a knock is no motion before its commands") {
  const Imported read = imported(own_flight(24));
  CHECK((!read.lag_known || read.lag_s > 0));
}

/// The three were refused: "found that of w_z", "found that of w_z negated", "found that of w_y negated". A knock and a
/// catch decided; in the third, pitch moves yaw, and its own column follows pitch far better.
TEST_CASE("calm flights with a knock or a catch by hand keep their own derivatives") {
  for (const std::size_t n : {10u, 12u, 124u}) {
    CAPTURE(n);
    const Imported read = imported(own_flight(n));
    CHECK(read.refused == "");
    CHECK(read.flights.size() == 1);
  }
}

/// They were refused: "the commands explain 0 % of roll and pitch acceleration in the order they have".
TEST_CASE("a catch by hand does not decide the order of the motors") {
  for (const std::size_t n : {61u, 656u}) {
    CAPTURE(n);
    CHECK(imported(own_flight(n)).refused == "");
  }
}

/// Without an accelerometer it passed without a word: what is derived of a velocity agrees with it in any axes.
TEST_CASE("a velocity in the body's axes, read as the world's, is found by the tilt where there is no accelerometer") {
  std::size_t lively = 0, found = 0;
  for (std::size_t n = 0; n < flights_to_fly(); n += 3) {
    const OwnFlight plan = own_flight(n);
    CAPTURE(n);
    CAPTURE(flight_kind_names[static_cast<std::size_t>(plan.kind)]);
    std::string mapping = own_mapping(plan);
    const std::size_t begin = mapping.find("[specific_force]");
    mapping.erase(begin, mapping.find("[velocity]") - begin);
    std::vector<LoggedInstant> instants = flown_instants(plan);
    CHECK(imported(plan, instants, mapping).refused == "");
    if (plan.kind != FlightKind::lively && plan.kind != FlightKind::gusts) continue;
    using pinnquad::swap_enu_ned, pinnquad::swap_flu_frd;
    for (LoggedInstant& now : instants) {
      now.velocity_m_s = pinnquad::world_to_body(now.attitude, now.velocity_m_s);
      if (plan.enu_flu)
        now.velocity_m_s = swap_enu_ned(swap_flu_frd(now.velocity_m_s));  // own_ulog() swaps the world's
    }
    ++lively;
    found +=
        imported(plan, instants, mapping).refused.find("velocities in the body's axes") != std::string::npos ? 1 : 0;
  }
  CHECK(10 * found > 9 * lively);
}

TEST_CASE("one wild block is no evidence, nine that agree are") {
  using pinnquad::detail::is_plain;
  CHECK_FALSE(is_plain({}));
  CHECK_FALSE(is_plain({1e6}));
  CHECK_FALSE(is_plain({1e6, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}));
  CHECK_FALSE(is_plain({1, 1, 1, 1, 1, 1, 1, 1, 1}));
  CHECK(is_plain({1, 1, 1, 1, 1, 1, 1, 1, 1, 1}));
  CHECK_FALSE(is_plain({-1, -1, -1, -1, -1, -1, -1, -1, -1, -1}));
  const std::vector<double> weights = pinnquad::detail::block_weights({1, 1, 1, 1, 1, 1, 1, 1, 100});
  CHECK(weights.front() == 1);
  CHECK(weights.back() == doctest::Approx(0.01));
}
