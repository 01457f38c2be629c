// SPDX-License-Identifier: MIT
// Training, validation and test rows: of one flight in contiguous blocks (Figs. 5 and 6), of a dataset by whole
// flights, by whole trajectories, or by a contiguous part of each flight. No row is in two blocks.
// Blocks, not a random draw: neighbouring rows are alike, and a draw would leak training rows into the test.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/data/row_set.hpp"

namespace pinnquad {

namespace detail {
/// One part to train on, one to validate on, one to test on: rows, or their shares.
template <class Part>
struct Split {
  Part train{};
  Part validation{};
  Part test{};
};
}  // namespace detail

/// Three sets that cover every row of a dataset once; views, the dataset must outlive them.
using RowSplit = detail::Split<RowSet>;

/// Shares of the rows in Sec. 5. Each is in 0..1, their sum is 1; a share of 0 leaves that block out.
inline constexpr detail::Split<double> usual_shares = {0.6, 0.2, 0.2};

/// Rows that a block with a share above 0 needs at least: local monotonicity looks at pairs.
inline constexpr std::size_t minimum_block_rows = 2;

/// Splits `rows` rows into contiguous blocks. Both inner borders are rounded to the nearest row, halves up:
///   train = [0, round(rows train)), validation = [.., round(rows (train + validation))), test = [.., rows)
/// so that 15000 rows give 9000 / 3000 / 3000 by default. Each block is within one row of its exact share.
/// Throws std::invalid_argument, in one line: shares that are no shares; too few rows for `minimum_block_rows`.
detail::Split<IndexRange> split_contiguous(std::size_t rows, const detail::Split<double>& shares = usual_shares);

/// Each flight into three contiguous blocks, as split_contiguous() does it: the end of every flight is tested. A
/// dataset of one flight is split as that flight. Throws what split_contiguous() throws.
RowSplit split_each_flight(const Dataset& dataset, const detail::Split<double>& shares = usual_shares);
RowSplit split_each_flight(const Dataset&&,
                           const detail::Split<double>& = usual_shares) = delete;  // its rows would be gone

/// Whole flights, in the dataset's order: the first ones train, then come those that validate, and the last ones test.
/// Each block takes as many flights as come closest to its share of the rows, and one at least; a flight without rows
/// is in none. Throws std::invalid_argument, one line: shares that are no shares; fewer flights than blocks.
RowSplit split_by_flight(const Dataset& dataset, const detail::Split<double>& shares = usual_shares);
RowSplit split_by_flight(const Dataset&&, const detail::Split<double>& = usual_shares) = delete;

/// The same with whole trajectories, in the order in which the dataset names them first: what is tested was never flown
/// in training. A flight that names no trajectory is one of its own.
RowSplit split_by_trajectory(const Dataset& dataset, const detail::Split<double>& shares = usual_shares);
RowSplit split_by_trajectory(const Dataset&&, const detail::Split<double>& = usual_shares) = delete;

/// The split of `pinnquad train`: one flight in contiguous blocks, several as whole flights.
RowSplit split_for_training(const Dataset& dataset);
RowSplit split_for_training(const Dataset&&) = delete;

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/data/impl/split.hpp"
#endif
