// SPDX-License-Identifier: MIT
// The figures of a model on held-out flights, where the truth is known: noise of a known variance, gains and lags that
// the models were given, rows that were moved out of the envelope.
#include "training/held_out_dynamics.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "judged_run.hpp"
#include "training/log_kinds.hpp"

namespace {

using pinnquad_test::Judged;

constexpr double period_s = 0.02, noise = 0.03, lag = 0.85;

/// Flights whose commands are a slow signal and white noise. Each row knows the signal: motors 1 to 3 by the body
/// rates, the fourth by the altitude.
pinnquad::Dataset known_flights(int flights, std::size_t rows) {
  std::mt19937_64 engine(7);
  std::normal_distribution<double> normal(0, 1);
  pinnquad::Dataset dataset;
  for (int f = 1; f <= flights; ++f) {
    pinnquad::Flight flight;
    flight.name = "flight" + std::to_string(f);
    pinnquad::Commands<double> slow{};
    for (std::size_t row = 0; row < rows; ++row) {
      pinnquad::Sample sample;
      sample.time_s = period_s * static_cast<double>(row);
      for (std::size_t i = 0; i < slow.size(); ++i) {
        slow[i] = lag * slow[i] + (1 - lag) * normal(engine);
        const double truth = 0.5 + 0.3 * slow[i];
        if (i < 3) sample.body_rates_rad_s[static_cast<int>(i)] = truth;
        if (i == 3) sample.altitude_m = truth;
        sample.commands[i] = truth + noise * normal(engine);
      }
      flight.push_back(sample);
    }
    dataset.add(std::move(flight));
  }
  return dataset;
}

pinnquad::Commands<double> truth_of(const pinnquad::Sample& sample) {
  const auto& known = sample.body_rates_rad_s;
  return {known[0], known[1], known[2], sample.altitude_m};
}

programs::ModelKind kind_of(const char* key,
                            std::shared_ptr<const programs::TrainedNetwork> (*fit)(const programs::FitTask&)) {
  return {key, key, programs::TimeReach::present, false, pinnquad_test::always, fit};
}

/// The truth; half of its swings; the truth of three rows before.
programs::ModelKind true_kind() {
  return kind_of("true", [](const programs::FitTask&) {
    return pinnquad_test::by_row([](const pinnquad::RowSet& rows, std::size_t row) { return truth_of(rows[row]); });
  });
}
programs::ModelKind half_kind() {
  return kind_of("half", [](const programs::FitTask&) {
    return pinnquad_test::by_row([](const pinnquad::RowSet& rows, std::size_t row) {
      pinnquad::Commands<double> made = truth_of(rows[row]);
      for (double& u : made) u = 0.5 + 0.5 * (u - 0.5);
      return made;
    });
  });
}
programs::ModelKind late_kind() {
  return kind_of("late", [](const programs::FitTask&) {
    return pinnquad_test::by_row(
        [](const pinnquad::RowSet& rows, std::size_t row) { return truth_of(rows[row < 3 ? 0 : row - 3]); });
  });
}

programs::HeldOutDynamics dynamics_of(const Judged& run, std::size_t kind) {
  return programs::held_out_dynamics(run.plan, run.fits, run.judged, kind, run.plan.first_seed);
}

}  // namespace

TEST_CASE("the ceiling is what noise of a known variance leaves, whatever the models err at low frequencies") {
  const Judged run(known_flights(4, 6000), {pinnquad_test::constant_kind(), half_kind(), true_kind()},
                   {{"flight2", "flight3"}, {}}, 1);
  const programs::HeldOutDynamics dynamics = dynamics_of(run, 1);
  REQUIRE(dynamics.has_spectra());
  CHECK(dynamics.period_s == doctest::Approx(period_s));
  const double signal = 0.3 * 0.3 * (1 - lag) / (1 + lag);
  for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
    CHECK(dynamics.ceiling.r2[motor] == doctest::Approx(signal / (signal + noise * noise)).epsilon(0.02));
    CHECK(run.judged.kinds[dynamics.ceiling.kind[motor]].kind.key == std::string("true"));
  }
  CHECK(dynamics.ceiling.white);
  // the perfect model reaches it
  CHECK(pinnquad::summarize(per_seed(run.judged.kinds[2], [](const programs::JudgedFit& fit) {
          return programs::mean_over_motors(fit.errors.r2);
        })).mean == doctest::Approx(programs::mean_over_motors(dynamics.ceiling.r2)).epsilon(0.02));
  const nlohmann::json told = programs::ceiling_json(dynamics, run.judged);
  CHECK(told["per_motor"]["u3"]["noise"].get<double>() == doctest::Approx(noise).epsilon(0.05));
  CHECK(told["from_hz"].get<double>() == doctest::Approx(0.75 * 25));
}

TEST_CASE("noise that is not white is said to be not") {
  pinnquad::Dataset smoothed;
  const pinnquad::Dataset flights = known_flights(3, 3000);
  for (pinnquad::Flight flight : flights.flights()) {
    pinnquad::Commands<double> last{};
    for (pinnquad::Sample& sample : flight) {  // noise that is a mean of two: none at half the sampling rate
      const pinnquad::Commands<double> truth = truth_of(sample);
      for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
        const double now = sample.commands[i] - truth[i];
        sample.commands[i] = truth[i] + 0.5 * (now + last[i]);
        last[i] = now;
      }
    }
    smoothed.add(std::move(flight));
  }
  const Judged run(smoothed, {true_kind()}, {{"flight2"}, {}}, 1);
  CHECK_FALSE(dynamics_of(run, 0).ceiling.white);
}

TEST_CASE("a model of half the swings is followed with a gain of 2, a late one ahead of time") {
  const Judged run(known_flights(4, 4000), {half_kind(), late_kind(), true_kind()}, {{"flight2"}, {}}, 1);
  const programs::HeldOutDynamics half = dynamics_of(run, 0), late = dynamics_of(run, 1), right = dynamics_of(run, 2);
  for (std::size_t sum = 0; sum < programs::sum_names.size(); ++sum) {
    CAPTURE(sum);
    CHECK(half.followed[sum].gain == doctest::Approx(2).epsilon(0.03));
    CHECK(std::abs(half.followed[sum].delay_s) < 4 * half.followed[sum].delay_error_s);
    CHECK(late.followed[sum].delay_s == doctest::Approx(-3 * period_s).epsilon(0.05));
    CHECK(right.followed[sum].gain == doctest::Approx(1).epsilon(0.03));
    CHECK(std::abs(right.followed[sum].gain - 1) < 4 * right.followed[sum].gain_error);
  }
  const nlohmann::json told = programs::response_json(half, "half");
  CHECK(told["sums"]["yaw"]["gain"].get<double>() == doctest::Approx(2).epsilon(0.03));
  CHECK(told["sums"]["yaw"]["bands"]["coherence"].size() == told["sums"]["yaw"]["bands"]["frequency_hz"].size());
}

TEST_CASE("rows of another sampling, and too few of them, have no spectra and say why") {
  Judged gaps(known_flights(3, 200), {pinnquad_test::constant_kind()}, {{"flight2"}, {}}, 1);
  for (std::size_t row = 0; row < 200; row += 20) gaps.judged.counts[0][row] = false;
  CHECK(dynamics_of(gaps, 0).why_not.find("without a gap") != std::string::npos);
  CHECK(programs::ceiling_json(dynamics_of(gaps, 0), gaps.judged)["r2"].is_null());
  pinnquad::Dataset mixed;
  const pinnquad::Dataset even = known_flights(4, 200);
  for (pinnquad::Flight flight : even.flights()) {
    for (pinnquad::Sample& sample : flight) sample.time_s *= flight.name == "flight3" ? 2 : 1;
    mixed.add(std::move(flight));
  }
  const Judged uneven(mixed, {pinnquad_test::constant_kind()}, {{"flight2", "flight3"}, {}}, 1);
  CHECK(dynamics_of(uneven, 0).why_not.find("no one time") != std::string::npos);
}

TEST_CASE("the stretch that is drawn is the one with the middle error") {
  pinnquad::Dataset flights = known_flights(3, 2500);  // five stretches of 10 s
  Judged run(flights, {true_kind()}, {{"flight2"}, {}}, 1);
  programs::Predictions& made = run.fits.finished.front().held_out;
  for (std::size_t row = 0; row < made.size(); ++row) {
    const double off = std::array<double, 5>{0.5, 0.1, 0.3, 0.2, 0.4}[row / 500];
    for (double& u : made[row]) u += off;
  }
  const programs::HeldOutStretch typical = dynamics_of(run, 0).typical;
  CHECK(typical.row == 1000);
  CHECK(typical.size == 500);
}

TEST_CASE("the guard's reasons are counted, with the feature that is furthest out") {
  using namespace pinnquad_test;
  const pinnquad::Dataset flown = simulated_dataset(4, 400);
  pinnquad::Dataset flights;
  constexpr std::size_t moved = 17;
  for (pinnquad::Flight flight : flown.flights()) {
    for (std::size_t row = 100; flight.name == "flight2" && row < 100 + moved; ++row) {
      flight[row].angular_acceleration_rad_s2[1] = -900;
    }
    flights.add(std::move(flight));
  }
  const Judged run(flights, {constant_kind(), programs::log_ridge()}, {{"flight2"}, {}}, 1);
  const programs::FinishedFit* ridge = nullptr;
  for (const programs::FinishedFit& fit : run.fits.finished) ridge = fit.kind == 1 ? &fit : ridge;
  REQUIRE(ridge != nullptr);
  const programs::GuardCounts guard = programs::guard_of_seed(run.fits, 1, run.plan.first_seed);
  CHECK(guard.rows == 400);
  std::uint64_t refused = 0;
  for (const auto& commands : ridge->model->guarded_predictions(run.plan.folds[0].split.test)) {
    refused += programs::detail::answered(commands) ? 0u : 1u;
  }
  CHECK(guard.rows - guard.answered() == refused);
  CHECK(guard.outside_envelope >= moved);
  CHECK(guard.furthest.at("wdot_y") >= moved);
  std::uint64_t all = 0;
  for (const auto& [feature, count] : guard.furthest) all += count;
  CHECK(all == guard.outside_envelope);
  const nlohmann::json told = programs::guard_json(guard, "ridge");
  CHECK(told["answered_share"].get<double>() == doctest::Approx(1 - static_cast<double>(refused) / 400));
  CHECK(told["refused"]["outside_envelope"].get<double>() >= moved / 400.0);
}
