// SPDX-License-Identifier: MIT
// Contiguous split of a flight into training, validation and test rows (Figs. 5 and 6).
// Blocks, not a random draw: neighbouring rows are alike, and a draw would leak training rows into the test.
#pragma once

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace pinnquad {

/// Rows [begin, end) of a flight.
struct IndexRange {
  std::size_t begin = 0;
  std::size_t end = 0;
  constexpr std::size_t size() const noexcept { return end - begin; }
  constexpr bool empty() const noexcept { return begin == end; }
};

/// Shares of the rows, each in 0..1, their sum 1. Default: the split of Sec. 5. A share of 0 leaves that block out.
struct SplitShares {
  double train = 0.6;
  double validation = 0.2;
  double test = 0.2;
};

/// Three adjoining blocks, in time order, that cover every row once.
struct DatasetSplit {
  IndexRange train;
  IndexRange validation;
  IndexRange test;
};

/// Rows that a block with a share above 0 needs at least: local monotonicity looks at pairs.
inline constexpr std::size_t minimum_block_rows = 2;

namespace detail {
/// Throws std::invalid_argument, in one line, for shares that are no shares.
inline void require_shares(const SplitShares& shares) {
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

/// Splits `rows` rows into contiguous blocks. Both inner borders are rounded to the nearest row, halves up:
///   train = [0, round(rows train)), validation = [.., round(rows (train + validation))), test = [.., rows)
/// so that 15000 rows give 9000 / 3000 / 3000 by default. Each block is within one row of its exact share.
/// Throws std::invalid_argument, in one line: shares that are no shares; too few rows for `minimum_block_rows`.
inline DatasetSplit split_contiguous(std::size_t rows, const SplitShares& shares = {}) {
  detail::require_shares(shares);
  const auto border = [rows](double share) {
    const double exact = static_cast<double>(rows) * share;
    const auto rounded = static_cast<std::size_t>(std::floor(exact + 0.5));
    return rounded < rows ? rounded : rows;
  };
  DatasetSplit split;
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

}  // namespace pinnquad
