// SPDX-License-Identifier: MIT
// Smoothed series against closed forms: derivatives and gains of sines, rotors behind lag and delay, gaps left out.
#include "pinnquad/regression/smoothed_flights.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace pinnquad;

namespace {

using detail::SmoothedFlights;

/// Rows every `period_s` whose rates and commands are sines.
Flight sines(double period_s, double duration_s, double rad_s) {
  Flight flight;
  for (std::size_t row = 0; double(row) * period_s < duration_s; ++row) {
    Sample sample;
    const double t = double(row) * period_s;
    sample.time_s = t;
    sample.body_rates_rad_s = {std::sin(rad_s * t), 2, 0.5 * std::cos(rad_s * t)};
    sample.velocity_m_s = {3 * std::sin(rad_s * t), 0, -1};
    for (double& u : sample.commands) u = 0.5 + 0.2 * std::sin(rad_s * t);
    flight.push_back(sample);
  }
  return flight;
}

double amplitude(const std::vector<double>& series) {
  const auto [least, most] = std::minmax_element(series.begin(), series.end());
  return (*most - *least) / 2;
}

}  // namespace

TEST_CASE("a derivative is the smoothed series' own, at coarse and at fine rows") {
  for (const double period_s : {0.004, 0.01, 0.02}) {
    CAPTURE(period_s);
    constexpr double rad_s = 2 * pi * 1.5;
    const Flight flight = sines(period_s, 6, rad_s);
    const SmoothedFlights smoothed({flight, {0, flight.size()}}, 0.16);
    REQUIRE(smoothed.size() > 100);
    // both lose the same share of their amplitude, so that the derivative's is rad_s times the other's
    CHECK(amplitude(smoothed.angular_acceleration()[0]) ==
          doctest::Approx(rad_s * amplitude(smoothed.rates()[0])).epsilon(0.01));
    CHECK(amplitude(smoothed.rates()[0]) < 1);
    CHECK(smoothed.rates()[1][0] == doctest::Approx(2));
    CHECK(std::abs(smoothed.angular_acceleration()[1][0]) < 1e-9);
    CHECK(smoothed.rate_products()[0][50] == doctest::Approx(2 * smoothed.rates()[2][50]));
    CHECK(smoothed.squared_velocity()[2][0] == doctest::Approx(-1));
  }
}

TEST_CASE("thrust behind lag and delay has the amplitude and the phase of a first-order lag") {
  constexpr double rad_s = 2 * pi * 2, lag_s = 0.04, delay_s = 0.015;
  for (const double period_s : {0.004, 0.02}) {
    CAPTURE(period_s);
    const Flight flight = sines(period_s, 6, rad_s);
    const SmoothedFlights smoothed({flight, {0, flight.size()}}, 0.16);
    const auto now = smoothed.thrust_fractions(0, {});
    const auto late = smoothed.thrust_fractions(0, {lag_s, lag_s, delay_s});
    const double gain = 1 / std::sqrt(1 + rad_s * lag_s * rad_s * lag_s);
    CHECK(amplitude(late[0]) == doctest::Approx(gain * amplitude(now[0])).epsilon(0.01));
    double sine = 0, cosine = 0;  // against the phase of the commands
    for (std::size_t i = 0; i < now[0].size(); ++i) {
      const double ahead = smoothed.angular_acceleration()[0][i] / rad_s;
      sine += (late[0][i] - 0.5) * smoothed.rates()[0][i];
      cosine += (late[0][i] - 0.5) * ahead;
    }
    CHECK(std::atan2(-cosine, sine) == doctest::Approx(std::atan(rad_s * lag_s) + rad_s * delay_s).epsilon(0.02));
  }
}

TEST_CASE("commands and motion that run alike are alike, whichever way they are smoothed") {
  Flight flight = sines(0.02, 6, 1);
  for (Sample& sample : flight) {
    const double ramp = 0.2 + 0.05 * sample.time_s;
    sample.body_rates_rad_s = {ramp, 0, 0};
    sample.commands = {ramp, ramp, ramp, ramp};
  }
  const SmoothedFlights smoothed({flight, {0, flight.size()}}, 0.16);
  const auto thrust = smoothed.thrust_fractions(0, {});
  for (const std::size_t i : {std::size_t(0), smoothed.size() / 2}) {
    CHECK(thrust[0][i] == doctest::Approx(smoothed.rates()[0][i]).epsilon(1e-12));
    CHECK(smoothed.angular_acceleration()[0][i] == doctest::Approx(0.05));
  }
}

TEST_CASE("falling thrust may have a lag of its own; a curve bends the thrust before the lag") {
  const Flight flight = sines(0.004, 6, 2 * pi * 2);
  const SmoothedFlights smoothed({flight, {0, flight.size()}}, 0.16);
  const auto mean = [](const std::vector<double>& series) {
    double sum = 0;
    for (const double value : series) sum += value / double(series.size());
    return sum;
  };
  const double even = mean(smoothed.thrust_fractions(0, {0.04, 0.04, 0})[0]);
  const double slow_fall = mean(smoothed.thrust_fractions(0, {0.02, 0.06, 0})[0]);
  CHECK(even == doctest::Approx(0.5).epsilon(0.01));
  CHECK(slow_fall > even + 0.01);
  CHECK(mean(smoothed.thrust_fractions(1, {})[0]) == doctest::Approx(0.25 + 0.2 * 0.2 / 2).epsilon(0.02));
}

TEST_CASE("a gap parts the stretches; short ones and rows without a period are left out") {
  Flight flight = sines(0.01, 4, 6);
  const std::size_t whole = SmoothedFlights({flight, {0, flight.size()}}, 0.16).size();
  Flight parted = flight;
  parted.keep_rows([](std::size_t row) { return row < 150 || row >= 250; });
  const SmoothedFlights smoothed({parted, {0, parted.size()}}, 0.16);
  REQUIRE(smoothed.size() > 0);
  CHECK(smoothed.size() < whole - 50);
  CHECK(smoothed.stretch(0) == 0);
  CHECK(smoothed.stretch(smoothed.size() - 1) == 1);
  Flight brief = flight;
  brief.keep_rows([](std::size_t row) { return row % 40 < 39; });
  CHECK(SmoothedFlights({brief, {0, brief.size()}}, 0.16).size() == 0);
  CHECK(SmoothedFlights({flight, {0, 1}}, 0.16).size() == 0);
}

TEST_CASE("the force by the velocity is that of the accelerometer without its offset; none without a velocity") {
  Flight flight = sines(0.01, 4, 6);
  for (Sample& sample : flight) {
    const double t = sample.time_s;
    sample.linear_acceleration_m_s2 = {18 * std::cos(6 * t), 0, 0.1};  // z: the accelerometer is wrong by 0.1
  }
  const SmoothedFlights smoothed({flight, {0, flight.size()}}, 0.16);
  for (const std::size_t i : {std::size_t(0), smoothed.size() / 2}) {
    CHECK(smoothed.kinematic_force()[0][i] == doctest::Approx(smoothed.specific_force()[0][i]).epsilon(0.02).scale(9));
    CHECK(smoothed.specific_force()[2][i] - smoothed.kinematic_force()[2][i] == doctest::Approx(0.1));
  }
  for (Sample& sample : flight) sample.velocity_m_s.setZero();
  CHECK(SmoothedFlights({flight, {0, flight.size()}}, 0.16).kinematic_force()[2].empty());
}
