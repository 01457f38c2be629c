// SPDX-License-Identifier: MIT
// Where a log's ground is (logs/derived_motion.hpp): where the vehicle stood before the flight, wherever it lands.
#include "logs/derived_motion.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace {

/// Stands at `start_m`, flies 10 m above it, lands on `end_m`; a cell without a number among the first. A row each
/// second.
double ground_of(double start_m, double end_m, bool says_landed) {
  pinnquad::logs::CommonRows rows;
  rows.period_s = 1;
  std::vector<double> height;
  const auto add = [&](double height_m, double landed, int count) {
    for (int i = 0; i < count; ++i) {
      rows.time_s.push_back(static_cast<double>(rows.rows()));
      height.push_back(height_m);
      if (says_landed) rows.landed.push_back(landed);
    }
  };
  add(std::numeric_limits<double>::quiet_NaN(), 1, 1);
  add(start_m, 1, 20);
  add(start_m + 10, 0, 100);
  add(end_m, 1, 60);
  pinnquad::logs::Mapping mapping;
  mapping.ground_from_log = true;
  pinnquad::logs::LogRows result;
  const double ground_m = pinnquad::logs::ground_height(rows, height, mapping, result);
  CHECK(result.told.size() == 1);
  return ground_m;
}

}  // namespace

TEST_CASE("the ground is where it stood before take-off, also where it lands on a roof or in a pit") {
  for (const double end_m : {488.0, 503.0, 480.0}) {
    CAPTURE(end_m);
    CHECK(ground_of(488, end_m, true) == doctest::Approx(488));
  }
}

TEST_CASE("without a word of landing the ground is the lowest height; a mapping that says it is believed") {
  CHECK(ground_of(488, 503, false) == doctest::Approx(488));
  CHECK(ground_of(488, 480, false) == doctest::Approx(480));
  pinnquad::logs::CommonRows rows;
  rows.time_s = {0, 1};
  pinnquad::logs::Mapping mapping;
  mapping.ground_m = 12.5;
  pinnquad::logs::LogRows result;
  CHECK(pinnquad::logs::ground_height(rows, {20, 30}, mapping, result) == doctest::Approx(12.5));
}

TEST_CASE("altitude is above that ground, whether the log has heights or positions") {
  pinnquad::logs::CommonRows rows;
  rows.period_s = 0.02;
  const std::vector<double> heights = {488, 488, 489.5, 492};
  for (std::size_t row = 0; row < heights.size(); ++row) {
    rows.time_s.push_back(rows.period_s * static_cast<double>(row));
    rows.landed.push_back(row < 2 ? 1 : 0);
    for (std::size_t i = 0; i < 4; ++i) {
      rows.attitude[i].push_back(i == 0 ? 1 : 0);
      rows.commands[i].push_back(0.5);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (auto* quantity : {&rows.body_rates, &rows.angular_acceleration, &rows.specific_force, &rows.velocity})
        (*quantity)[axis].push_back(0);
    }
  }
  SUBCASE("heights") { rows.altitude = heights; }
  SUBCASE("positions, which point down") {
    for (const double height : heights) {
      rows.position[0].push_back(0);
      rows.position[1].push_back(0);
      rows.position[2].push_back(-height);
    }
  }
  pinnquad::logs::BoundLog log;
  pinnquad::logs::Source source;
  log.of(pinnquad::logs::Quantity::velocity).source = &source;
  pinnquad::logs::Mapping mapping;
  mapping.ground_from_log = true;
  const pinnquad::logs::LogRows made = pinnquad::logs::rows_of_log(rows, log, mapping, "flight.csv");
  REQUIRE(made.flight.size() == 4);
  CHECK(made.has_altitude);
  CHECK(made.landed == std::vector<bool>{true, true, false, false});
  const std::vector<double> above = {0, 0, 1.5, 4};
  for (std::size_t row = 0; row < above.size(); ++row)
    CHECK(made.flight[row].altitude_m == doctest::Approx(above[row]));
}
