// SPDX-License-Identifier: MIT
// Slopes of a structured model of flights whose gyro is noisy, and of the same flights without.
#include "pinnquad/training/structured/slopes_under_noise.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/pinnquad.hpp"

using namespace pinnquad;

namespace {

/// Without noise. One flight is all that is flown: it takes longest.
const Flight& quiet() {
  static const Flight flight = [] {
    FlightPlan plan = AgileFlight::plan();
    plan.samples = 4000;
    const Quadrotor<double, StandardAtmosphere, QuadraticDrag> vehicle(
        airframe_value<PaperQuadrotor, double>(), paper_site<double>(), StandardAtmosphere{}, QuadraticDrag{});
    return fly(vehicle, AgileFlight::pilot(vehicle, std::mt19937_64(3)), plan).flight;
  }();
  return flight;
}

/// Its first rows, by a gyro that is noisy.
Flight flown(double gyro_noise_rad_s, std::size_t samples) {
  Flight flight(samples);
  std::copy_n(quiet().begin(), samples, flight.begin());
  std::mt19937_64 engine(4);
  constexpr double between_samples_s = 0.01;
  for (Sample& sample : flight) {
    for (int i = 0; i < 3; ++i) {
      const double before = standard_normal(engine), now = standard_normal(engine);
      sample.body_rates_rad_s[i] += gyro_noise_rad_s * now;
      sample.angular_acceleration_rad_s2[i] += gyro_noise_rad_s * (now - before) / between_samples_s;
    }
  }
  return flight;
}

StructuredFits::Fit fitted(const Flight& flight, bool pinned = false) {
  StructuredSettings settings;
  settings.residual.epochs = 3;
  settings.altitude = StructuredSettings::Altitude::no;
  settings.pinned_slopes = pinned;
  settings.seeds = 1;
  const Dataset dataset(flight);
  return fit_structured(split_for_training(dataset), given_airframe<PaperQuadrotor>(), settings).best();
}

const Flight& noisy() {
  static const Flight flight = flown(0.03, quiet().size());
  return flight;
}
const StructuredFits::Fit& noisy_fit() {
  static const StructuredFits::Fit fit = fitted(noisy());
  return fit;
}

Certificate certificate_of_fit(const StructuredFits::Fit& fit) { return *fit.model.written.certificate; }

double error_on(const StructuredFits::Fit& fit, const Flight& flight) {
  const RowSet rows(flight, {0, flight.size()});
  return model_errors(fit.model, rows).mean.mean_absolute;
}

const AxisSlopes own = hover_slopes(airframe_value<PaperQuadrotor, double>());
const double own_thrust = hover_thrust_slope(airframe_value<PaperQuadrotor, double>());

using Setting = Context<InverseFeatures, PaperQuadrotor, AxisCommandOutputs>;

}  // namespace

TEST_CASE("noise of the gyro bends the slopes of least squares; those by smoothed rows are the airframe's") {
  const StructuredFits::Fit& fit = noisy_fit();
  const Certificate certificate = certificate_of_fit(fit);
  CHECK(certificate.proven());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const MeasuredSlope& slope = fit.slopes.of[1 + axis];
    CHECK(slope.known);
    CHECK(slope.smoothed());
    CHECK(slope.least_squares < 0.8 * own[axis]);
    CHECK(slope.slope == doctest::Approx(own[axis]).epsilon(0.05));
    CHECK(slope.lower < 1.03 * own[axis]);  // rotor lag makes a quiet flight's 1.02 of the airframe's
    CHECK(slope.upper > own[axis]);
    CHECK(certificate.slope[axis] == doctest::Approx(slope.slope).epsilon(1e-5));
    CHECK(certificate.residual_lower[1 + axis] == 0);
    CHECK(certificate.residual_upper[1 + axis] == 0);
  }
  // w x v moves the specific force by little
  CHECK(fit.slopes.of[0].known);
  CHECK(fit.slopes.of[0].slope == doctest::Approx(own_thrust).epsilon(0.05));
  CHECK(certificate.thrust_slope == doctest::Approx(fit.slopes.of[0].slope).epsilon(1e-5));

  // without noise: 0.007 of a model that was trained so, 0.045 of least squares; the mean of the noisy angular
  // acceleration about yaw alone makes 0.02 of some flights
  CHECK(error_on(fit, quiet()) < 0.009);
}

TEST_CASE("of a quiet flight least squares are kept to the bit, with intervals") {
  const Flight flight = flown(0, 2500);
  const Dataset dataset(flight);
  const RowSplit split = split_for_training(dataset);
  const StructuredFits::Fit fit = fitted(flight);
  const auto context = make_context<Setting>(split.train);
  const auto base = monotone_base<Setting>(fit_monotone_base(context, split.train));
  CHECK_FALSE(fit.slopes.smoothed());
  for (std::size_t k = 0; k < 4; ++k) {
    const MeasuredSlope& slope = fit.slopes.of[k];
    CHECK(slope.known);
    CHECK_FALSE(slope.smoothed());
    CHECK(slope.least_squares == doctest::Approx(slope.slope).epsilon(0.01));
    CHECK(slope.lower < slope.slope);
    CHECK(slope.slope < slope.upper);
    CHECK(slope.upper - slope.lower < 0.1 * slope.slope);
  }
  for (std::size_t i = 0; i < base.parameters.size(); ++i) CHECK(fit.parameters[i] == base.parameters[i]);
}

TEST_CASE("pinned slopes are not measured, nor those about the axes of a window, nor of few rows") {
  const StructuredFits::Fit pinned = fitted(flown(0.03, 1500), true);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CHECK_FALSE(pinned.slopes.of[1 + axis].known);
    CHECK(certificate_of_fit(pinned).slope[axis] == doctest::Approx(own[axis]).epsilon(1e-5));
  }
  CHECK(pinned.slopes.of[0].known);
  CHECK_FALSE(fitted(flown(0.03, 300)).slopes.of[1].known);

  using Window = PartlyWindowed<InverseFeatures, InverseAccelerations, 3, PeriodMicroseconds<50000>>;
  const Flight flight = flown(0, 100);
  const RowSet rows(flight, {0, flight.size()});
  const auto noisy_of = [&](const auto& context) { return detail::noisy_features(fit_context(context)); };
  CHECK(noisy_of(make_context<Context<Window, PaperQuadrotor, AxisCommandOutputs>>(rows)).size() == 3);
  CHECK(noisy_of(make_context<Setting>(rows)) == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
}

TEST_CASE("a window's thrust slope, all taps together, is held where noise bends that of the present") {
  using Window = PartlyWindowed<InverseFeatures, InverseAccelerations, 5, PeriodMicroseconds<50000>>;
  constexpr int taps = Window::Window::taps;
  const auto fit_of = [](const Flight& flight) {
    StructuredSettings settings;
    settings.residual.epochs = 3;
    settings.seeds = 1;
    const Dataset dataset(flight);
    return fit_structured<Window, Window>(split_for_training(dataset), given_airframe<PaperQuadrotor>(), settings)
        .best();
  };
  CHECK_FALSE(fit_of(quiet()).slopes.of[0].known);

  Flight shaken = quiet();
  std::mt19937_64 engine(5);
  for (Sample& sample : shaken) sample.linear_acceleration_m_s2[2] += 5 * standard_normal(engine);
  const auto fit = fit_of(shaken);
  const Certificate certificate = certificate_of_fit(fit);
  CHECK(fit.slopes.of[0].smoothed());
  CHECK(fit.slopes.of[0].least_squares < 0.8 * own_thrust);
  CHECK_FALSE(fit.slopes.of[1].known);
  CHECK(certificate.held_thrust_slope == doctest::Approx(fit.slopes.of[0].slope).epsilon(1e-4));
  CHECK(certificate.held_thrust_slope == doctest::Approx(own_thrust).epsilon(0.1));
  CHECK(certificate.residual_upper[0] == certificate.residual_lower[0]);

  const RowSet rows(shaken, {100, 600});
  std::array<double, taps> denoised{}, measured{};
  const Dataset dataset(shaken);
  const FitContext context =
      fit_context(make_context<Context<Window, PaperQuadrotor, AxisCommandOutputs>>(split_for_training(dataset).train));
  const std::vector<int> places = context.features.thrusts();
  REQUIRE(places.size() == taps);
  each_denoised(context, fit.slopes, rows, [&](std::size_t row, const std::vector<double>& x) {
    for (std::size_t tap = 0; tap < places.size(); ++tap) {
      const auto at = 100 + row - tap;
      const double truth = sample_features<InverseFeatures, double>(quiet()[at])[0];
      denoised[tap] += std::pow(x[static_cast<std::size_t>(places[tap])] - truth, 2);
      measured[tap] += std::pow(sample_features<InverseFeatures, double>(shaken[at])[0] - truth, 2);
    }
  });
  for (std::size_t tap = 0; tap < denoised.size(); ++tap) CHECK(denoised[tap] < 0.8 * measured[tap]);
}

TEST_CASE("a sum by smoothed rows has no residual, the others keep theirs") {
  Flight bent = flown(0.03, 2500);
  for (Sample& sample : bent) {
    for (double& u : sample.commands) u += 0.1 * std::abs(sample.velocity_m_s[0]);
  }
  StructuredSettings settings;
  settings.residual.epochs = 20;
  settings.altitude = StructuredSettings::Altitude::no;
  settings.seeds = 1;
  const Dataset dataset(bent);
  const auto fit = fit_structured(split_for_training(dataset), given_airframe<PaperQuadrotor>(), settings).best();
  const Certificate certificate = certificate_of_fit(fit);
  CHECK(certificate.proven());
  CHECK(fit.slopes.of[1].smoothed());
  CHECK(certificate.residual_upper[1] - certificate.residual_lower[1] == 0);
  CHECK(certificate.residual_upper[0] - certificate.residual_lower[0] > 0.1);
}

TEST_CASE("neighbours are a tenth of a second away, and none is beyond a gap or another piece") {
  Flight flight = flown(0, 200);
  for (std::size_t row = 120; row < flight.size(); ++row) flight[row].time_s += 1;
  RowSet rows(flight, {10, 60});
  rows.add(flight, {100, 200});
  std::vector<std::size_t> seen;
  const FitContext context = fit_context(make_context<Setting>(rows));
  const auto are_of = [&](const double* x, std::size_t row) {
    const auto expected = sample_features<InverseFeatures, double>(flight[row]);
    return std::equal(expected.begin(), expected.end(), x);
  };
  for (const FlightRows& piece : rows.pieces()) {
    detail::each_with_neighbours(context, piece,
                                 [&](std::size_t row, const double* x, const double* before, const double* after) {
                                   CHECK(are_of(x, row));
                                   CHECK(are_of(before, row - 2));
                                   CHECK(are_of(after, row + 2));
                                   seen.push_back(row);
                                 });
  }
  std::vector<std::size_t> expected;
  for (const auto& [begin, end] : {std::pair<std::size_t, std::size_t>{12, 58}, {102, 118}, {122, 198}}) {
    for (std::size_t row = begin; row < end; ++row) expected.push_back(row);
  }
  CHECK(seen == expected);
}

TEST_CASE("rows to judge by are nearer to the truth than those with noise, and all else is as it was") {
  const StructuredFits::Fit& fit = noisy_fit();
  const RowSet rows(noisy(), {100, 600});
  const Dataset dataset(noisy());
  const FitContext context = fit_context(make_context<Setting>(split_for_training(dataset).train));
  double denoised = 0, measured = 0;
  std::size_t count = 0;
  each_denoised(context, fit.slopes, rows, [&](std::size_t row, const std::vector<double>& x) {
    const auto truth = sample_features<InverseFeatures, double>(quiet()[100 + row]);
    const auto seen = sample_features<InverseFeatures, double>(noisy()[100 + row]);
    denoised += std::pow(x[1] - truth[1], 2);
    measured += std::pow(seen[1] - truth[1], 2);
    for (std::size_t i = 4; i < x.size(); ++i) CHECK(x[i] == seen[i]);
    ++count;
  });
  CHECK(count == 500 - 4);
  CHECK(denoised < 0.8 * measured);
}
