// SPDX-License-Identifier: MIT
#include "pinnquad/data/split.hpp"

#include <doctest/doctest.h>

#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "recorded_flight.hpp"

using namespace pinnquad;
using pinnquad_test::random_flight;

namespace {

/// Flights "0", "1", ... of these many rows.
Dataset dataset_of(const std::vector<std::size_t>& rows, const std::vector<std::string>& trajectories = {}) {
  Dataset dataset;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Flight flight = random_flight(rows[i], static_cast<unsigned>(i));
    flight.name = std::to_string(i);
    if (!trajectories.empty()) flight.trajectory = trajectories[i];
    dataset.add(std::move(flight));
  }
  return dataset;
}

std::string names(const RowSet& rows) {
  std::string result;
  for (const auto& piece : rows.pieces()) result += piece.flight->name;
  return result;
}

std::string names(const Dataset& dataset, RowSet RowSplit::*block,
                  const pinnquad::detail::Split<double>& shares = pinnquad::usual_shares) {
  return names(split_by_flight(dataset, shares).*block);
}

/// Whether the rows of such a dataset, or such a flight, may be looked at.
template <class Looked, class = void>
struct SplitsFlights : std::false_type {};
template <class Looked>
struct SplitsFlights<Looked, std::void_t<decltype(split_each_flight(std::declval<Looked>()))>> : std::true_type {};
template <class Looked, class = void>
struct TakesRows : std::false_type {};
template <class Looked>
struct TakesRows<Looked, std::void_t<decltype(std::declval<RowSet&>().add(std::declval<Looked>(), {}))>>
    : std::true_type {};
static_assert(SplitsFlights<const Dataset&>::value && !SplitsFlights<Dataset>::value, "a view of a temporary");
static_assert(TakesRows<const Flight&>::value && !TakesRows<Flight>::value, "a view of a temporary");

/// Every row of the dataset is in one block, once.
void check_covers(const Dataset& dataset, const RowSplit& split) {
  std::map<const pinnquad::Sample*, int> seen;
  for (const RowSet* block : {&split.train, &split.validation, &split.test}) {
    for (std::size_t i = 0; i < block->size(); ++i) ++seen[&(*block)[i]];
  }
  std::size_t rows = 0;
  for (const Flight& flight : dataset.flights()) {
    for (const auto& sample : flight) CHECK(seen[&sample] == 1);
    rows += flight.size();
  }
  CHECK(seen.size() == rows);
}

}  // namespace

TEST_CASE("a dataset of one flight is split as the flight") {
  const Dataset dataset(random_flight(101, 5));
  const RowSplit split = split_each_flight(dataset);
  const auto blocks = pinnquad::split_contiguous(101);
  check_covers(dataset, split);
  CHECK(&split.train[0] == &dataset[0][blocks.train.begin]);
  CHECK(&split.validation[0] == &dataset[0][blocks.validation.begin]);
  CHECK(&split.test[0] == &dataset[0][blocks.test.begin]);
  CHECK(split.train.size() == blocks.train.size());
}

TEST_CASE("each flight by itself: three blocks of each") {
  const Dataset dataset = dataset_of({40, 100, 55});
  const RowSplit split = split_each_flight(dataset);
  check_covers(dataset, split);
  CHECK(names(split.train) == "012");
  CHECK(names(split.test) == "012");
  CHECK(split.train.size() == 24 + 60 + 33);
}

TEST_CASE("by flight: whole flights in order, borders where the shares are met best") {
  CHECK(names(dataset_of({10, 10, 10, 10, 10}), &RowSplit::train) == "012");
  CHECK(names(dataset_of({10, 10, 10, 10, 10}), &RowSplit::validation) == "3");
  CHECK(names(dataset_of({10, 10, 10, 10, 10}), &RowSplit::test) == "4");
  CHECK(names(dataset_of({80, 10, 10}), &RowSplit::train) == "0");
  CHECK(names(dataset_of({10, 10, 80}), &RowSplit::test) == "2");
  CHECK(names(dataset_of({10, 10, 80}), &RowSplit::train) == "0");
  CHECK(names(dataset_of({30, 10, 30, 10, 20}), &RowSplit::validation) == "3");
  CHECK(names(dataset_of({10, 20}), &RowSplit::test, {0.5, 0, 0.5}) == "1");
  CHECK(names(dataset_of({10, 20, 10}), &RowSplit::train, {1, 0, 0}) == "012");
  CHECK(names(dataset_of({10, 20, 10}), &RowSplit::test, {0, 0, 1}) == "012");
  CHECK(names(dataset_of({10, 20}), &RowSplit::validation, {0.5, 0, 0.5}).empty());
  // any sizes: nothing is lost, nothing is parted, no block is empty
  std::mt19937_64 engine(4);
  for (int draw = 0; draw < 50; ++draw) {
    std::vector<std::size_t> rows(3 + engine() % 6);
    for (std::size_t& count : rows) count = 1 + engine() % 40;
    const Dataset dataset = dataset_of(rows);
    const RowSplit split = split_by_flight(dataset);
    check_covers(dataset, split);
    for (const RowSet* block : {&split.train, &split.validation, &split.test}) {
      CHECK_FALSE(block->empty());
      for (const auto& piece : block->pieces()) CHECK(piece.rows.size() == piece.flight->size());
    }
  }
}

TEST_CASE("by trajectory: what is tested was never flown in training") {
  const std::vector<std::string> flown = {"eight", "circle", "eight", "", "line", "circle", ""};
  const Dataset dataset = dataset_of({10, 10, 10, 10, 10, 10, 10}, flown);
  const RowSplit split = split_by_trajectory(dataset);
  check_covers(dataset, split);
  std::map<std::string, std::set<const RowSet*>> blocks_of;
  for (const RowSet* block : {&split.train, &split.validation, &split.test}) {
    for (const auto& piece : block->pieces()) {
      if (!piece.flight->trajectory.empty()) blocks_of[piece.flight->trajectory].insert(block);
    }
  }
  for (const auto& entry : blocks_of) CHECK(entry.second.size() == 1);
  CHECK(names(split.train) == "0215");
  CHECK(names(split.validation) == "34");
  CHECK(names(split.test) == "6");
}

TEST_CASE("a flight without rows fills no block") {
  CHECK(names(dataset_of({10, 10, 10, 0}), &RowSplit::test) == "2");
  CHECK(names(dataset_of({0, 10, 10, 10}), &RowSplit::train) == "1");
  const Dataset dataset = dataset_of({10, 10, 10, 0}, {"a", "b", "c", "d"});
  CHECK(names(split_by_trajectory(dataset).test) == "2");
  const Dataset two = dataset_of({10, 10, 0});
  CHECK_THROWS_AS(split_by_flight(two), std::invalid_argument);
}

TEST_CASE("too few flights for three blocks are refused in one line") {
  const Dataset two = dataset_of({10, 10}), three = dataset_of({10, 10, 10}, {"a", "a", "b"});
  CHECK_THROWS_WITH_AS(split_by_flight(two), "split: expected at least 3 flights, one for each block of rows, found 2",
                       std::invalid_argument);
  CHECK_THROWS_WITH_AS(split_by_trajectory(three),
                       "split: expected at least 3 trajectories, one for each block of rows, found 2",
                       std::invalid_argument);
  CHECK_THROWS_AS(split_by_flight(three, {0.6, 0.6, 0.2}), std::invalid_argument);
}
