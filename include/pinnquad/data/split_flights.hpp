// SPDX-License-Identifier: MIT
// A dataset of many flights into training, validation and test rows: whole flights, whole trajectories, or a contiguous part of
// each flight. No row is in two blocks, and no block has rows of a flight next to another block's, but where it says so.
#pragma once

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/data/row_set.hpp"

namespace pinnquad {

/// Three sets that cover every row of a dataset once; views, the dataset must outlive them.
struct RowSplit {
  RowSet train;
  RowSet validation;
  RowSet test;
};

/// Each flight into three contiguous blocks, as split_contiguous() does it: the end of every flight is tested. A dataset of one
/// flight is split as that flight. Throws what split_contiguous() throws.
inline RowSplit split_each_flight(const Dataset& dataset, const SplitShares& shares = {}) {
  RowSplit split;
  for (const Flight& flight : dataset.flights()) {
    const DatasetSplit blocks = split_contiguous(flight.size(), shares);
    split.train.add(flight, blocks.train);
    split.validation.add(flight, blocks.validation);
    split.test.add(flight, blocks.test);
  }
  return split;
}
RowSplit split_each_flight(const Dataset&&, const SplitShares& = {}) = delete;  // its rows would be gone

namespace detail {

/// Groups of flights, each group whole, in order of `groups`: the first ones train, the next validate, the last test. The
/// borders are where the shares of the rows are met best, so that each block with a share above 0 has a group.
inline RowSplit split_groups(const std::vector<std::vector<const Flight*>>& groups, const SplitShares& shares,
                             const char* what) {
  require_shares(shares);
  std::vector<std::size_t> rows_before = {0};  // [i]: rows of the first i groups
  for (const auto& group : groups) {
    std::size_t rows = rows_before.back();
    for (const Flight* flight : group) rows += flight->size();
    rows_before.push_back(rows);
  }
  const std::size_t validates = shares.validation > 0 ? 1 : 0, tests = shares.test > 0 ? 1 : 0;
  const std::size_t trains = shares.train > 0 ? 1 : 0;
  if (groups.size() < trains + validates + tests) {
    throw std::invalid_argument("split: expected at least " + std::to_string(trains + validates + tests) + " " + what +
                                ", one for each block of rows, found " + std::to_string(groups.size()));
  }
  const double all_rows = static_cast<double>(rows_before.back());
  // the number of groups in [least, most] whose rows come closest to a share; of two the smaller
  const auto border = [&](double share, std::size_t least, std::size_t most) {
    std::size_t best = least;
    const auto miss = [&](std::size_t count) {
      return std::abs(static_cast<double>(rows_before[count]) - share * all_rows);
    };
    for (std::size_t count = least; count <= most; ++count) {
      if (miss(count) < miss(best)) best = count;
    }
    return best;
  };
  const std::size_t count = groups.size();
  const std::size_t trained =
      trains == 0 ? 0 : (validates + tests == 0 ? count : border(shares.train, trains, count - validates - tests));
  const std::size_t validated =
      tests == 0
          ? count
          : (validates == 0 ? trained : border(shares.train + shares.validation, trained + validates, count - tests));
  RowSplit split;
  for (std::size_t group = 0; group < count; ++group) {
    RowSet& block = group < trained ? split.train : group < validated ? split.validation : split.test;
    for (const Flight* flight : groups[group]) block.add(*flight, {0, flight->size()});
  }
  return split;
}

}  // namespace detail

/// Whole flights, in the dataset's order: the first ones train, then come those that validate, and the last ones test. Each block
/// takes as many flights as come closest to its share of the rows, and one at least; a flight without rows is in none.
/// Throws std::invalid_argument, one line: shares that are no shares; fewer flights than blocks.
inline RowSplit split_by_flight(const Dataset& dataset, const SplitShares& shares = {}) {
  std::vector<std::vector<const Flight*>> groups;
  for (const Flight& flight : dataset.flights()) {
    if (!flight.empty()) groups.push_back({&flight});
  }
  return detail::split_groups(groups, shares, "flights");
}
RowSplit split_by_flight(const Dataset&&, const SplitShares& = {}) = delete;

/// The same with whole trajectories, in the order in which the dataset names them first: what is tested was never flown in
/// training. A flight that names no trajectory is one of its own.
inline RowSplit split_by_trajectory(const Dataset& dataset, const SplitShares& shares = {}) {
  std::vector<std::vector<const Flight*>> groups;
  for (const Flight& flight : dataset.flights()) {
    if (flight.empty()) continue;
    std::vector<const Flight*>* group = nullptr;
    for (auto& other : groups) {
      if (!flight.trajectory.empty() && other.front()->trajectory == flight.trajectory) group = &other;
    }
    if (group != nullptr) {
      group->push_back(&flight);
    } else {
      groups.push_back({&flight});
    }
  }
  return detail::split_groups(groups, shares, "trajectories");
}
RowSplit split_by_trajectory(const Dataset&&, const SplitShares& = {}) = delete;

/// The split of `pinnquad train`: one flight in contiguous blocks, several as whole flights.
inline RowSplit split_for_training(const Dataset& dataset) {
  return dataset.size() == 1 ? split_each_flight(dataset) : split_by_flight(dataset);
}
RowSplit split_for_training(const Dataset&&) = delete;

}  // namespace pinnquad
