// SPDX-License-Identifier: MIT
// Bodies of split.hpp.
#pragma once

#include "pinnquad/data/split.hpp"

namespace pinnquad {
namespace detail {

/// Throws std::invalid_argument, in one line, for shares that are no shares.
PINNQUAD_BODY void require_shares(const detail::Split<double>& shares) {
  constexpr double sum_tolerance = 1e-9;  // decimal shares such as 0.7 + 0.2 + 0.1 miss 1 by a few ulp
  const auto is_share = [](double share) { return share >= 0 && share <= 1; };
  if (!is_share(shares.train) || !is_share(shares.validation) || !is_share(shares.test) ||
      std::abs(shares.train + shares.validation + shares.test - 1) > sum_tolerance) {
    throw std::invalid_argument("split: expected three shares in 0..1 with the sum 1, found " +
                                std::to_string(shares.train) + ", " + std::to_string(shares.validation) + ", " +
                                std::to_string(shares.test));
  }
}

}  // namespace detail

PINNQUAD_BODY detail::Split<IndexRange> split_contiguous(std::size_t rows, const detail::Split<double>& shares) {
  detail::require_shares(shares);
  const auto border = [rows](double share) {
    const double exact = static_cast<double>(rows) * share;
    const auto rounded = static_cast<std::size_t>(std::floor(exact + 0.5));
    return rounded < rows ? rounded : rows;
  };
  detail::Split<IndexRange> split;
  split.train = {0, border(shares.train)};
  split.validation = {split.train.end, shares.test > 0 ? border(shares.train + shares.validation) : rows};
  split.test = {split.validation.end, rows};

  const auto require = [rows](const IndexRange& block, double share, const char* name) {
    if (share > 0 && block.size() < minimum_block_rows) {
      throw std::invalid_argument("split: expected at least " + std::to_string(minimum_block_rows) + " rows for the " +
                                  name + " block, found " + std::to_string(block.size()) + " of " +
                                  std::to_string(rows) + " rows in all");
    }
  };
  require(split.train, shares.train, "training");
  require(split.validation, shares.validation, "validation");
  require(split.test, shares.test, "test");
  return split;
}

PINNQUAD_BODY RowSplit split_each_flight(const Dataset& dataset, const detail::Split<double>& shares) {
  RowSplit split;
  for (const Flight& flight : dataset.flights()) {
    const detail::Split<IndexRange> blocks = split_contiguous(flight.size(), shares);
    split.train.add(flight, blocks.train);
    split.validation.add(flight, blocks.validation);
    split.test.add(flight, blocks.test);
  }
  return split;
}

namespace detail {

/// Groups of flights that are not empty, each group whole: the first ones train, the next validate, the last test. The
/// borders are where the shares of the rows are met best, so that each block with a share above 0 has a group.
PINNQUAD_BODY RowSplit split_groups(const Dataset& dataset, bool by_trajectory, const detail::Split<double>& shares) {
  require_shares(shares);
  std::vector<std::vector<const Flight*>> groups;
  for (const Flight& flight : dataset.flights()) {
    if (flight.empty()) continue;
    auto group = std::find_if(groups.begin(), groups.end(), [&](const std::vector<const Flight*>& other) {
      return by_trajectory && !flight.trajectory.empty() && other.front()->trajectory == flight.trajectory;
    });
    if (group == groups.end()) group = groups.emplace(group);
    group->push_back(&flight);
  }
  std::vector<std::size_t> rows_before = {0};  // [i]: rows of the first i groups
  for (const auto& group : groups) {
    std::size_t rows = rows_before.back();
    for (const Flight* flight : group) rows += flight->size();
    rows_before.push_back(rows);
  }
  const std::size_t validates = shares.validation > 0 ? 1 : 0, tests = shares.test > 0 ? 1 : 0;
  const std::size_t trains = shares.train > 0 ? 1 : 0;
  if (groups.size() < trains + validates + tests) {
    throw std::invalid_argument("split: expected at least " + std::to_string(trains + validates + tests) +
                                (by_trajectory ? " trajectories" : " flights") +
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

PINNQUAD_BODY RowSplit split_by_flight(const Dataset& dataset, const detail::Split<double>& shares) {
  return detail::split_groups(dataset, false, shares);
}

PINNQUAD_BODY RowSplit split_by_trajectory(const Dataset& dataset, const detail::Split<double>& shares) {
  return detail::split_groups(dataset, true, shares);
}

PINNQUAD_BODY RowSplit split_for_training(const Dataset& dataset) {
  return dataset.size() == 1 ? split_each_flight(dataset) : split_by_flight(dataset);
}

}  // namespace pinnquad
