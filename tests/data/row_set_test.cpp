// SPDX-License-Identifier: MIT
#include "pinnquad/data/row_set.hpp"

#include <doctest/doctest.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "recorded_flight.hpp"

using pinnquad::Flight;
using pinnquad::RowSet;
using pinnquad_test::random_flight;

TEST_CASE("rows of several flights count through, in the order in which they were added") {
  const Flight a = random_flight(7, 1), b = random_flight(5, 2);
  RowSet rows;
  CHECK(rows.empty());
  CHECK(rows.size() == 0);
  rows.add(b, {1, 4});
  rows.add(a, {2, 2});  // nothing
  rows.add(a, {0, 2});
  rows.add(a, {6, 7});
  REQUIRE(rows.size() == 6);
  CHECK(rows.pieces().size() == 3);
  const pinnquad::Sample* expected[] = {&b[1], &b[2], &b[3], &a[0], &a[1], &a[6]};
  for (std::size_t i = 0; i < 6; ++i) CHECK(&rows[i] == expected[i]);
}

TEST_CASE("rows that a flight does not have are refused") {
  const Flight flight = random_flight(7, 3);
  CHECK_NOTHROW(RowSet(flight, {0, 7}));
  CHECK_THROWS_AS(RowSet(flight, {0, 8}), std::invalid_argument);
  CHECK_THROWS_AS(RowSet(flight, {5, 4}), std::invalid_argument);
}

TEST_CASE("a set of a dataset's rows reads the same rows after more flights were added") {
  pinnquad::Dataset dataset;
  dataset.add(random_flight(7, 1));
  const RowSet rows(dataset[0], {0, 7});
  const Flight first = dataset[0];
  for (unsigned seed = 2; seed < 40; ++seed) {
    Flight other = random_flight(7, seed);
    other.name = std::to_string(seed);
    dataset.add(std::move(other));
  }
  CHECK(rows.pieces().front().flight == &dataset[0]);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    CHECK(&rows[row] == &dataset[0][row]);
    CHECK(pinnquad::to_values(rows[row]) == pinnquad::to_values(first[row]));
  }
}

TEST_CASE("the period is the median step; recordings whose periods differ by more than a hundredth have none") {
  const auto recorded = [](double period_s, unsigned seed, double begin_s = 0, std::size_t count = 9) {
    Flight flight = random_flight(count, seed);
    Flight timed;
    for (std::size_t row = 0; row < flight.size(); ++row) {
      pinnquad::Sample sample = flight[row];
      sample.time_s = begin_s + period_s * static_cast<double>(row) + (row > 5 ? 1.0 : 0.0);  // one gap
      timed.push_back(sample);
    }
    return timed;
  };
  const Flight first = recorded(0.01, 1), alike = recorded(0.010005, 2), other = recorded(0.0105, 3);
  CHECK(pinnquad::sample_period_s(RowSet{}) == 0);
  RowSet rows;
  rows.add(first, {0, 9});
  CHECK(pinnquad::sample_period_s(rows) == 0.01);
  rows.add(alike, {0, 9});
  CHECK(pinnquad::sample_period_s(rows) == 0.01);
  rows.add(other, {0, 9});
  CHECK(pinnquad::sample_period_s(rows) == 0);
  for (const double period_s : {0.05, 0.004, 0.001}) {  // seconds since 1970, in a double 0.24 us apart
    CAPTURE(period_s);
    const Flight unix_time = recorded(period_s, 4, 1.7e9, 2000);
    RowSet of_unix_time;
    of_unix_time.add(unix_time, {0, 2000});
    CHECK(pinnquad::sample_period_s(of_unix_time) == period_s);
  }
}
