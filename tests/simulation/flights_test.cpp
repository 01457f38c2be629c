// SPDX-License-Identifier: MIT
// The paper's three flights: their bounds, their structure, and that their inputs vary enough to learn from.
#include "pinnquad/simulation/flights.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"
#include "pinnquad/evaluation/summary.hpp"
#include "support/long_flight.hpp"

namespace {

using namespace pinnquad;

constexpr std::uint64_t fastest_seed = 167;  // of 1 to 200 in D1: 8.29 m/s if the pilot did not ease off

/// Seed 1 stands for all: `fly d1 --statistics 200` flies the others.
template <class PaperFlight>
RecordedFlight flown(std::uint64_t seed = 1) {
  return fly<PaperFlight>(airframe_value<PaperQuadrotor, double>(), std::mt19937_64(seed));
}

/// Of seeds 1 to 200 (docs/flights.md), a little wider: how far the steepest row leans, and rows with a rotor at its
/// end.
struct Bounds {
  std::size_t rows;
  double least_tilt_deg, most_tilt_deg;
  double least_saturated, most_saturated;
};
constexpr Bounds d1 = {15000, 50.5, 53.5, 0.005, 0.018}, d2 = {6000, 27, 47, 0, 0.0005},
                 d3 = {5000, 50, 53, 0.003, 0.028};

void check_common_bounds(const RecordedFlight& recorded, const Bounds& bounds) {
  const FlightReport& report = recorded.report;
  CHECK(report.end == FlightEnd::completed);
  CHECK(report.rows == bounds.rows);
  CHECK(recorded.flight.size() == bounds.rows);
  CHECK(recorded.flight.front().time_s == doctest::Approx(0.05));
  CHECK(report.max_speed_m_s <= 8.0);
  CHECK(report.min_altitude_m > 0);
  const double tilt_deg = report.max_tilt_rad * 57.29577951308232;
  CHECK(tilt_deg >= bounds.least_tilt_deg);
  CHECK(tilt_deg <= bounds.most_tilt_deg);
  CHECK(report.saturated_share >= bounds.least_saturated);
  CHECK(report.saturated_share <= bounds.most_saturated);
}

/// Standard deviation of each of the 16 features.
std::vector<double> feature_spreads(const Flight& flight) {
  std::vector<std::vector<double>> series(PaperFeatures::size);
  for (const Sample& sample : flight) {
    const auto x = sample_features<PaperFeatures, double>(sample);
    for (std::size_t i = 0; i < x.size(); ++i) series[i].push_back(x[i]);
  }
  std::vector<double> spreads;
  for (const std::vector<double>& one : series) spreads.push_back(summarize(one).deviation);
  return spreads;
}

}  // namespace

TEST_CASE("D1: bounds, and the flight that the library's parts make by default" * pinnquad::test::long_flight()) {
  const RecordedFlight recorded = flown<AgileFlight>();
  check_common_bounds(recorded, d1);
  CHECK(recorded.report.max_speed_m_s > 7);
  check_common_bounds(flown<AgileFlight>(fastest_seed), d1);
  const Quadrotor<double, StandardAtmosphere, QuadraticDrag> quadrotor(airframe_value<PaperQuadrotor, double>(),
                                                                       paper_site<double>(), {}, {});
  const RandomPilot<std::mt19937_64> pilot(std::mt19937_64(1), pilot_style(quadrotor, FlightPlan{}.start_m),
                                           quadrotor.site().ground_z_m);
  CHECK(content_hash(fly(quadrotor, pilot).flight) == content_hash(recorded.flight));
}

TEST_CASE("D2: heights within 0.1 to 2 m and over most of them, landings and flights, all features vary" *
          pinnquad::test::long_flight()) {
  const RecordedFlight recorded = flown<NearGroundFlight>();
  check_common_bounds(recorded, d2);
  CHECK(recorded.report.min_altitude_m >= 0.1);
  CHECK(recorded.report.max_altitude_m <= 2.0);
  CHECK(recorded.report.min_altitude_m < 0.2);
  CHECK(recorded.report.max_altitude_m > 1.5);
  CHECK(recorded.report.max_speed_m_s > 2.5);

  int landings = 0;
  bool down = true;
  std::size_t in_ground_effect = 0;
  for (const Sample& sample : recorded.flight) {
    const bool low = sample.altitude_m < 0.25;
    if (low && !down) ++landings;
    if (low || sample.altitude_m > 0.3) down = low;
    in_ground_effect += sample.altitude_m < 10 * 0.1143 ? 1 : 0;  // Conyers' curve ends at Z / R = 10
  }
  CHECK(landings >= 8);
  CHECK(in_ground_effect > recorded.flight.size() / 2);

  // least spreads: linear m/s^2, angular rad/s^2, m/s, rad/s, rad, sin and cos of yaw
  const double least[16] = {0.1, 0.1, 0.3, 2, 2, 0.2, 0.3, 0.3, 0.1, 0.1, 0.1, 0.1, 0.03, 0.03, 0.3, 0.3};
  const std::vector<double> spreads = feature_spreads(recorded.flight);
  REQUIRE(spreads.size() == 16);
  for (std::size_t i = 0; i < spreads.size(); ++i) {
    CAPTURE(i);
    CHECK(spreads[i] > least[i]);
  }
}

TEST_CASE("D3: bounds, and a wind that shows") {
  const RecordedFlight recorded = flown<WindyFlight>();
  check_common_bounds(recorded, d3);
  CHECK(recorded.report.max_speed_m_s > 7);
  // the wind is the paper's: 2.5 sin(pi t / 5) + 2.5 m/s towards north
  const WindyFlight::Vehicle vehicle = flight_vehicle<WindyFlight>(airframe_value<PaperQuadrotor, double>());
  CHECK(vehicle.surroundings({}, 2.5).wind_m_s[0] == doctest::Approx(5.0));
  CHECK(vehicle.surroundings({}, 7.5).wind_m_s[0] == doctest::Approx(0.0));
  CHECK(vehicle.surroundings({}, 1.0).wind_m_s.tail<2>().norm() == 0);
}

TEST_CASE("styles follow the airframe: the heavy one flies all three within bounds" * pinnquad::test::long_flight()) {
  const Airframe<double> heavy = airframe_value<ReferenceQuadrotor15, double>();
  const auto vehicle = flight_vehicle<NearGroundFlight>(heavy);
  const NearGroundStyle style = near_ground_style(vehicle, NearGroundFlight::plan().start_m);
  CHECK(style.thumbs.roll_pitch_deviation_rad_s < NearGroundStyle{}.thumbs.roll_pitch_deviation_rad_s);
  CHECK(style.velocity_lag_s > NearGroundStyle{}.velocity_lag_s);
  const RecordedFlight low = fly<NearGroundFlight>(heavy, std::mt19937_64(1));
  CHECK(low.report.end == FlightEnd::completed);
  CHECK(low.report.min_altitude_m >= 0.1);
  CHECK(low.report.max_altitude_m <= 2.0);
  CHECK(fly<WindyFlight>(heavy, std::mt19937_64(1)).report.end == FlightEnd::completed);
}

TEST_CASE("the share of thrust that a hover takes tells who stays on the ground") {
  Airframe<double> airframe = airframe_value<PaperQuadrotor, double>();
  const Vector3<double> place(0, 0, -35);
  CHECK(hover_command(flight_vehicle<AgileFlight>(airframe), place) == doctest::Approx(0.506).epsilon(0.01));
  airframe.mass_kg *= 1.95;
  CHECK(hover_command(flight_vehicle<AgileFlight>(airframe), place) > 0.97);
  airframe.mass_kg = 0;
  CHECK(std::isnan(hover_command(flight_vehicle<AgileFlight>(airframe), place)));
}
