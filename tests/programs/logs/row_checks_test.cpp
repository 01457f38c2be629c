// SPDX-License-Identifier: MIT
#include "logs/row_checks.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>

#include "logs/specific_force.hpp"
#include "programs/logs/synthetic_flight.hpp"

using pinnquad::Flight;
using pinnquad::logs::RowMask;

namespace {
std::ptrdiff_t count(const RowMask& rows) { return std::count(rows.begin(), rows.end(), true); }
}  // namespace
using pinnquad::test::synthetic_flight;

TEST_CASE("a command at its limit marks its row, also where the limit is the mapping's") {
  Flight flight = synthetic_flight();
  CHECK(count(pinnquad::logs::saturated_rows(flight)) == 0);
  flight[10].commands[1] = 1;
  flight[20].commands[3] = 0;
  flight[30].commands[0] = 0.9995;
  RowMask mask = pinnquad::logs::saturated_rows(flight);
  CHECK(count(mask) == 3);
  CHECK((mask[10] && mask[20] && mask[30]));
  for (std::size_t row = 100; row < 106; ++row) flight[row].commands[2] = 0.93;
  mask = pinnquad::logs::saturated_rows(flight);
  CHECK(count(mask) == 9);
  CHECK((mask[100] && mask[105]));
  CHECK(pinnquad::logs::saturated_rows(Flight()).empty());
}

TEST_CASE("a vehicle that stands with idle motors is on the ground, one that hovers or dives is not") {
  Flight flight = synthetic_flight();
  CHECK(count(pinnquad::logs::grounded_rows(flight, 0.01)) == 0);
  for (std::size_t row = 0; row < 600; ++row) {  // what an accelerometer reads is the same 9.81 as in hover
    flight[row].commands = {0.05, 0.05, 0.05, 0.05};
    flight[row].body_rates_rad_s.setZero();
    flight[row].linear_acceleration_m_s2.setZero();
  }
  for (std::size_t row = 3000; row < 3100; ++row) {  // dives: less thrust, and the specific force with it
    for (double& u : flight[row].commands) u *= 0.3;
    const auto force = pinnquad::logs::specific_force_m_s2(flight[row]);
    flight[row].linear_acceleration_m_s2 += -0.7 * force;
  }
  const RowMask mask = pinnquad::logs::grounded_rows(flight, 0.01);
  std::size_t early = 0, later = 0;
  for (std::size_t row = 0; row < mask.size(); ++row) (row < 600 ? early : later) += mask[row] ? 1 : 0;
  CHECK(early == 600);
  CHECK(later <= 65);  // the margin and half the smoothing
  CHECK(count(pinnquad::logs::grounded_rows(Flight(100), 0.01)) == 100);
}

TEST_CASE("a hop between two contacts is ground, the end of a log is not a contact") {
  Flight flight = synthetic_flight();
  const auto stand = [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      flight[row].commands = {0.05, 0.05, 0.05, 0.05};
      flight[row].body_rates_rad_s.setZero();
      flight[row].linear_acceleration_m_s2.setZero();
    }
  };
  stand(1000, 1100);
  stand(1200, 1300);
  const RowMask mask = pinnquad::logs::grounded_rows(flight, 0.01);
  for (std::size_t row = 1000; row < 1300; ++row) CHECK(mask[row]);
  CHECK_FALSE(mask[0]);
  CHECK_FALSE(mask.back());
  CHECK_FALSE(mask[900]);
  CHECK_FALSE(mask[1400]);
}

TEST_CASE("on the ground is what the log calls landed, and what is lower than the mapping's least height") {
  pinnquad::logs::LogRows rows;
  rows.flight = Flight(6);
  for (std::size_t row = 0; row < 6; ++row) rows.flight[row].altitude_m = 0.1 * static_cast<double>(row);
  rows.has_altitude = true;
  rows.landed = {false, false, false, false, true, false};
  pinnquad::logs::Mapping mapping;
  CHECK(pinnquad::logs::on_the_ground(rows, mapping, 0.01) == RowMask{false, false, false, false, true, false});
  mapping.least_height_m = 0.15;
  CHECK(pinnquad::logs::on_the_ground(rows, mapping, 0.01) == RowMask{true, true, false, false, true, false});
  rows.landed.clear();
  CHECK(pinnquad::logs::on_the_ground(rows, mapping, 0.01) == RowMask{true, true, false, false, false, false});
  rows.has_altitude = false;
  CHECK(count(pinnquad::logs::on_the_ground(rows, mapping, 0.01)) == 0);
}

TEST_CASE("a value like none of its neighbours is found, whatever its column; motion and turning round are not") {
  const Flight good = synthetic_flight();
  CHECK(count(pinnquad::logs::outlier_rows(good)) == 0);
  for (const std::size_t field : {2u, 5u, 8u, 11u, 13u, 16u}) {
    CAPTURE(field);
    Flight flight = good;
    auto values = to_values(flight[777]);
    values[field] += field == 5 ? 2000 : (field == 13 ? 2 : 60);
    flight[777] = pinnquad::to_sample(values);
    const RowMask mask = pinnquad::logs::outlier_rows(flight);
    CHECK(mask[777]);
    CHECK(count(mask) == 1);
  }
  Flight wrapped = good;
  for (std::size_t row = 0; row < wrapped.size(); ++row) wrapped[row].yaw_rad += row % 2 == 0 ? 0 : 6.283185307179586;
  CHECK(count(pinnquad::logs::outlier_rows(wrapped)) == 0);
}

TEST_CASE("flights of another's rows weigh as much, and a pause longer than the parts is no part") {
  Flight flight = synthetic_flight();
  flight.weight = 3;
  flight.name = "a";
  flight.keep_rows([](std::size_t row) { return row < 500 || row >= 900; });
  const auto parts = pinnquad::logs::split_at_gaps(flight, 0.015);
  REQUIRE(parts.size() == 2);
  CHECK((parts[1].weight == 3 && pinnquad::logs::joined(parts).weight == 3));
  CHECK(pinnquad::logs::first_rows(flight, 10).weight == 3);
  const std::size_t rows = flight.size();
  std::size_t sum = 0;
  for (const Flight& part : pinnquad::logs::cut(std::move(flight), 0.5)) {
    CHECK(part.size() >= 49);
    sum += part.size();
  }
  CHECK(sum == rows);
}
