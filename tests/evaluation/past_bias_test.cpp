// SPDX-License-Identifier: MIT
// The bias of the past on rows: none of a row's own or of later ones, its time constants by rows that did not train.
#include "pinnquad/evaluation/past_bias.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"

using namespace pinnquad;

namespace {

constexpr double period_s = 0.02, rounding = 1e-9;
const Airframe<double> airframe = airframe_value<PaperQuadrotor, double>();

/// Commands of `flown(row)`; the rest of a sample plays no part.
template <class Flown>
Flight flight_of(std::size_t rows, const Flown& flown, std::size_t gap_at = 0, double gap_s = 0) {
  Flight flight(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    Sample sample;
    sample.time_s = period_s * static_cast<double>(i) + (gap_at > 0 && i >= gap_at ? gap_s : 0);
    sample.commands = flown(i);
    flight[i] = sample;
  }
  return flight;
}

std::vector<Commands<double>> half(std::size_t rows) { return {rows, {0.5, 0.5, 0.5, 0.5}}; }
BiasSettings<double> all_of(double time_s) {
  return detail::bias_settings_of<double>(SignedSums<double>{time_s, time_s, time_s, time_s});
}

}  // namespace

TEST_CASE("a step of the commands is followed as first order follows it, from the delay on") {
  const Flight flight = flight_of(400, [](std::size_t i) {
    const double u = i < 100 ? 0.5 : 0.6;
    return Commands<double>{u, u, u, u};
  });
  const RowSet rows(flight, {0, flight.size()});
  for (const double delay_s : {0.0, 0.02, 0.1}) {
    const double time_s = 0.3;
    const auto with = with_past_bias(rows, half(400), airframe, all_of(time_s), delay_s);
    // of delay 0 the row before is the youngest
    const auto late = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(delay_s / period_s)));
    for (std::size_t row = 0; row < 400; ++row) {
      const double learnt = row < 100 + late ? 0 : static_cast<double>(row - 99 - late);
      const double expected = 0.5 + 0.1 * (1 - std::pow(time_s / (time_s + period_s), learnt));
      for (const double u : with[row]) CHECK(std::abs(u - expected) <= rounding);
    }
  }
}

TEST_CASE("no row knows its own command or a later one") {
  std::mt19937_64 random(2);
  std::normal_distribution<double> noise(0, 0.1);
  std::vector<Commands<double>> commands(300);
  for (Commands<double>& u : commands) {
    for (double& one : u) one = 0.5 + noise(random);
  }
  const Flight flight = flight_of(300, [&](std::size_t i) { return commands[i]; });
  const auto before = with_past_bias(RowSet(flight, {0, 300}), half(300), airframe, all_of(0.1), 0.06);
  for (const std::size_t changed : {50u, 150u, 299u}) {
    auto other = commands;
    for (std::size_t i = changed; i < other.size(); ++i) other[i] = {0, 1, 0, 1};
    const Flight later = flight_of(300, [&](std::size_t i) { return other[i]; });
    const auto after = with_past_bias(RowSet(later, {0, 300}), half(300), airframe, all_of(0.1), 0.06);
    std::size_t alike = 0;
    while (alike < 300 && after[alike] == before[alike]) ++alike;
    CHECK(alike == std::min<std::size_t>(300, changed + 3));
  }
}

TEST_CASE("each signed sum has its own: a weak rotor is thrust, roll, pitch and yaw") {
  const Flight flight = flight_of(400, [](std::size_t) { return Commands<double>{0.5, 0.5, 0.62, 0.5}; });
  const RowSet rows(flight, {0, 400});
  const auto with = with_past_bias(rows, half(400), airframe, all_of(0.2), 0.05);
  for (std::size_t i = 0; i < 4; ++i) CHECK(std::abs(with[399][i] - flight[399].commands[i]) <= 1e-6);
  BiasSettings<double> thrust_alone = detail::bias_settings_of<double>(SignedSums<double>{0.2, 0, 0, 0});
  const auto of_thrust = with_past_bias(rows, half(400), airframe, thrust_alone, 0.05);
  for (std::size_t i = 0; i < 4; ++i) CHECK(std::abs(of_thrust[399][i] - 0.53) <= 1e-6);
}

TEST_CASE("pieces begin anew, a row without a prediction teaches nothing, over a gap the bias fades") {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto higher = [](std::size_t) { return Commands<double>{0.6, 0.6, 0.6, 0.6}; };
  const Flight flight = flight_of(400, higher);
  RowSet pieces(flight, {0, 200});
  pieces.add(flight, {200, 400});
  const auto with = with_past_bias(pieces, half(400), airframe, all_of(0.1), 0.05);
  CHECK(std::abs(with[199][0] - 0.6) <= 1e-6);
  CHECK(with[200][0] == 0.5);

  auto holes = half(400);
  for (std::size_t i = 100; i < 110; ++i) holes[i] = {none, none, none, none};
  const auto over_holes = with_past_bias(RowSet(flight, {0, 400}), holes, airframe, all_of(0.1), 0.05);
  CHECK(std::isnan(over_holes[105][0]));
  CHECK(std::abs(over_holes[110][0] - 0.6) <= 1e-6);

  const Flight gap = flight_of(400, higher, 200, 5.0);
  const auto over_gap = with_past_bias(RowSet(gap, {0, 400}), half(400), airframe, all_of(0.1), 0.05);
  CHECK(over_gap[204][0] < 0.55);  // it has faded for 5 s
  CHECK(over_gap[399][0] == doctest::Approx(0.6));
  CHECK_THROWS_AS(with_past_bias(RowSet(gap, {0, 400}), half(399), airframe, all_of(0.1), 0.05), std::invalid_argument);
}

TEST_CASE("time constants: the shortest that costs no more than a twentieth, none below what is stable") {
  // thrust drifts with a sine of 5 s, roll is white noise, pitch a constant, yaw fits
  std::mt19937_64 random(9);
  std::normal_distribution<double> noise(0, 0.02);
  const detail::SignedMix<double> mix = detail::signed_mix(airframe);
  const Flight flight = flight_of(6000, [&](std::size_t i) {
    const double sums[4] = {0.4 * std::sin(6.283185307179586 * period_s * static_cast<double>(i) / 5), noise(random),
                            0.1, 1e-6 * noise(random)};
    Commands<double> u{0.5, 0.5, 0.5, 0.5};
    for (std::size_t r = 0; r < 4; ++r) {
      for (std::size_t k = 0; k < 4; ++k) u[r] += mix.by[r][k] * sums[k];
    }
    return u;
  });
  const RowSet rows(flight, {0, flight.size()});
  const BiasTrial free = try_biases(rows, half(6000), airframe, {0.05, 0});
  CHECK(free.rows == 6000);
  CHECK(free.best_s()[0] == 0.05);
  CHECK(free.best_s()[1] == 0.1);  // noise: sqrt(1 + T / (2 c + T)) of it is 1.04 there, 1.08 at 0.05 s
  CHECK(free.best_s()[2] == 0.05);
  const BiasTrial bounded = try_biases(rows, half(6000), airframe, {0.05, 0.25});
  CHECK(bounded.best_s()[0] == 0.3);
  CHECK(bounded.best_s()[2] == 0.3);
  CHECK(try_biases(rows, half(6000), airframe, {0.05, least_bias_time_constant_s(0.06)}).best_s() == bounded.best_s());
  BiasTrial twice = bounded;
  twice += bounded;
  CHECK(twice.rows == 12000);
  CHECK(twice.best_s() == bounded.best_s());
  CHECK(BiasTrial{}.best_s() == SignedSums<double>{});
}

TEST_CASE("the least that a loop takes grows with the lag") {
  CHECK(least_bias_time_constant_s(0.005) == doctest::Approx(0.19));
  CHECK(least_bias_time_constant_s(0.05) == doctest::Approx(0.28));
}
