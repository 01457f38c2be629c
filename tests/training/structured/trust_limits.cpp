// SPDX-License-Identifier: MIT
#include "pinnquad/training/structured/trust_limits.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/core/random.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/inference/command_residual.hpp"

using namespace pinnquad;

TEST_CASE("block maxima: whole blocks alone") {
  CHECK(block_maxima({1, 5, 2, -3, -4, -2, 9}, 3) == std::vector<double>{5, -2});
  CHECK(block_maxima({1, 2}, 3).empty());
  CHECK(block_maxima({1, 2}, 0).empty());
}

TEST_CASE("a limit by enough blocks is exceeded by new ones as often as asked, whatever their distribution") {
  std::mt19937_64 engine(11);
  constexpr int trials = 4000, blocks = 99, fresh = 20;
  for (const double blocks_per_alarm : {25.0, 50.0, 100.0}) {
    int exceeded = 0;
    const auto draw = [&] { return std::exp(2 * standard_normal(engine)); };
    for (int trial = 0; trial < trials; ++trial) {
      std::vector<double> maxima;
      for (int i = 0; i < blocks; ++i) maxima.push_back(draw());
      const double limit = detail::alarm_limit(maxima, blocks_per_alarm);
      for (int i = 0; i < fresh; ++i) exceeded += draw() > limit ? 1 : 0;
    }
    CHECK(exceeded * blocks_per_alarm / (trials * fresh) == doctest::Approx(1).epsilon(0.15));
  }
}

TEST_CASE("with fewer blocks the tail is continued: right for a power law, beyond it for an exponential tail") {
  std::vector<double> power, exponential;
  constexpr int blocks = 1000;
  for (int i = 0; i < blocks; ++i) {
    const double beyond = (i + 0.5) / blocks;
    power.push_back(std::pow(beyond, -0.5));
    exponential.push_back(-std::log(beyond));
  }
  CHECK(detail::alarm_limit(power, 10000) == doctest::Approx(100).epsilon(0.1));
  CHECK(detail::alarm_limit(exponential, 10000) > std::log(10000.0));
  CHECK(detail::alarm_limit(exponential, 10000) < 4 * std::log(10000.0));
  CHECK_THROWS_AS(detail::alarm_limit(std::vector<double>(7, 1.0), 60), std::invalid_argument);
  CHECK_THROWS_AS(detail::alarm_limit(std::vector<double>(20, 0.0), 60), std::invalid_argument);
}

namespace {

using Features = Joined<AngularAcceleration, BodyRates>;

struct Limits {
  static constexpr double command_residual_factor = 0.2, command_residual_limit = 0.05, command_residual_cleared = 0.02;
};

/// Says 0.5 always.
AskedModel half_always() {
  AskedModel model;
  model.units.assign(Features::units.begin(), Features::units.end());
  model.is_column.assign(6, false);
  model.envelope_lower.assign(6, -5);
  model.envelope_upper.assign(6, 5);
  model.each_row = detail::rows_of_features<Features, float>();
  model.each_exact_row = detail::rows_of_features<Features, double>();
  model.predict = [](const double*) { return Commands<double>{0.5, 0.5, 0.5, 0.5}; };
  return model;
}

Flight noisy(std::size_t rows, unsigned seed) {
  std::mt19937_64 engine(seed);
  Flight flight(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    flight[row].time_s = 0.05 * static_cast<double>(row);
    for (int i = 0; i < 3; ++i) {
      flight[row].angular_acceleration_rad_s2[i] = standard_normal(engine);
      flight[row].body_rates_rad_s[i] = standard_normal(engine);
    }
    for (double& u : flight[row].commands) u = 0.5 + 0.02 * standard_normal(engine);
  }
  return flight;
}

}  // namespace

TEST_CASE("the command residual's means are those of the monitor that flies") {
  std::mt19937_64 engine(12);
  std::vector<double> errors;
  CommandResidualMonitor<Limits> monitor;
  std::vector<double> flown;
  for (int i = 0; i < 300; ++i) {
    const auto error = static_cast<float>(uniform(engine, 0, 0.1));
    errors.push_back(static_cast<double>(error));
    REQUIRE(monitor.update({error, -error, error, -error}, {}) == Status::ok);
    flown.push_back(static_cast<double>(monitor.mean()));
  }
  const auto means = command_residual_means(errors, 0.2);
  for (std::size_t i = 0; i < means.size(); ++i) CHECK(means[i] == doctest::Approx(flown[i]).epsilon(1e-5));
}

TEST_CASE("fitted limits: new flights of the same kind raise as many alarms as asked, others many") {
  const Flight training = noisy(2000, 21), validation = noisy(20000, 22), fresh = noisy(100000, 23);
  FittedTrust::Settings settings;
  settings.seconds_per_alarm = 100;
  const auto trust = fit_trust(half_always(), RowSet(training, {0, training.size()}),
                               RowSet(validation, {0, validation.size()}), settings);
  CHECK(trust.update_period_s == doctest::Approx(0.05));
  CHECK(trust.command_residual_cleared < trust.command_residual_limit);
  CHECK(trust.command_residual_cleared > 0.0159);  // mean |error| = 0.02 sqrt(2 / pi)
  const auto alarms = [&](const Flight& flight) {
    const auto series = trust_series(half_always(), trust.distribution, RowSet(flight, {0, flight.size()}));
    std::array<int, 2> count{};
    for (const double most : block_maxima(series.squared_distances, 200))
      count[0] += most > trust.squared_distance_limit ? 1 : 0;
    for (const double most : block_maxima(command_residual_means(series.errors, 0.2), 200)) {
      count[1] += most > trust.command_residual_limit ? 1 : 0;
    }
    return count;
  };
  for (const int count : alarms(fresh)) {  // of 500 blocks 50, as far as 100 blocks tell
    CHECK(count > 15);
    CHECK(count < 100);
  }
  Flight other = noisy(2000, 24);
  for (Sample& sample : other) {
    sample.body_rates_rad_s[0] = 5 + sample.angular_acceleration_rad_s2[0];
    for (double& u : sample.commands) u += 0.1;
  }
  CHECK(alarms(other)[0] == 10);
  CHECK(alarms(other)[1] == 10);
}

namespace {

/// The text of what fit_trust() throws; empty if it does not.
std::string refusal(const Flight& training, const RowSet& validation) {
  try {
    static_cast<void>(fit_trust(half_always(), RowSet(training, {0, training.size()}), validation));
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

bool says(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a limit of the command residual that no command can exceed is refused: the tail of a short validation") {
  const Flight training = noisy(2000, 31);
  Flight calm = noisy(8 * 200, 32), spread = calm;
  CHECK(refusal(training, RowSet(calm, {0, calm.size()})).empty());
  // blocks whose errors differ by orders of magnitude: the power law that is laid through four of them ends beyond 1
  for (std::size_t row = 0; row < spread.size(); ++row) {
    const double share = std::pow(0.3, 8.0 - static_cast<double>(row / 200));
    for (double& u : spread[row].commands) u = 0.5 + share;
  }
  const std::string said = refusal(training, RowSet(spread, {0, spread.size()}));
  CAPTURE(said);
  CHECK(says(said, "command residual"));
  CHECK(says(said, "80 s"));
}

TEST_CASE("a limit of the distance that no features within the envelope exceed is refused") {
  const Flight training = noisy(2000, 33);
  Flight spread = noisy(8 * 200, 34);
  for (std::size_t block = 0; block < 8; ++block) {
    for (std::size_t row = 200 * block; row < 200 * (block + 1); ++row) {
      for (int i = 0; i < 3; ++i) spread[row].body_rates_rad_s[i] = 1e-3 * std::pow(10.0, static_cast<double>(block));
      spread[row].angular_acceleration_rad_s2.setZero();
    }
  }
  CHECK(says(refusal(training, RowSet(spread, {0, spread.size()})), "distance"));
}

TEST_CASE("validation rows that are too few: how long they last, and how long is needed") {
  const Flight training = noisy(2000, 35), validation = noisy(1200, 36);
  const std::string said = refusal(training, RowSet(validation, {0, validation.size()}));
  CAPTURE(said);
  CHECK(says(said, "80 s"));
  CHECK(says(said, "60 s"));
}

TEST_CASE(
    "the period of the command residual's updates is that of the rows, whatever short piece comes last or first") {
  const Flight training = noisy(2000, 37), validation = noisy(20000, 38);
  Flight late = noisy(2, 39);
  late[1].time_s = late[0].time_s + 0.09;
  RowSet last(validation, {0, validation.size()}), first(late, {0, 2}), single(validation, {0, validation.size()});
  last.add(late, {0, 2});
  first.add(validation, {0, validation.size()});
  single.add(late, {0, 1});  // one row has no period
  for (const RowSet& rows : {last, first, single}) {
    const auto trust = fit_trust(half_always(), RowSet(training, {0, training.size()}), rows);
    CHECK(trust.update_period_s == doctest::Approx(0.05).epsilon(1e-4));
  }
}
