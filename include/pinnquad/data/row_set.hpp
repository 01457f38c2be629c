// SPDX-License-Identifier: MIT
// Rows out of one flight or of many, as one set to train on or to judge by. A view: the flights must outlive it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/data/dataset.hpp"

namespace pinnquad {

/// Rows [begin, end) of a flight.
struct IndexRange {
  std::size_t begin = 0;
  std::size_t end = 0;
  constexpr std::size_t size() const noexcept { return end - begin; }
  constexpr bool empty() const noexcept { return begin == end; }
};

/// Rows of one flight that follow each other in time.
struct FlightRows {
  const Flight* flight = nullptr;
  IndexRange rows;
};

/// Pieces of flights in the order in which they were added. Rows of two pieces are no neighbours in time, whatever
/// their stamps say.
class RowSet {
 public:
  RowSet() = default;
  RowSet(const Flight& flight, const IndexRange& rows) { add(flight, rows); }
  RowSet(const Flight&&, const IndexRange&) = delete;  // the flight would be gone

  /// Rows of a flight, none of them a part of the set yet; no rows add nothing. Throws std::invalid_argument for rows
  /// that the flight does not have.
  void add(const Flight& flight, const IndexRange& rows) {
    if (rows.begin > rows.end || rows.end > flight.size()) {
      throw std::invalid_argument("row set: expected rows of a flight of " + std::to_string(flight.size()) +
                                  ", found " + std::to_string(rows.begin) + " to " + std::to_string(rows.end));
    }
    if (rows.empty()) return;
    pieces_.push_back({&flight, rows});
    ends_.push_back(size() + rows.size());
  }

  void add(const Flight&&, const IndexRange&) = delete;

  const std::vector<FlightRows>& pieces() const noexcept { return pieces_; }
  std::size_t size() const noexcept { return ends_.empty() ? 0 : ends_.back(); }
  bool empty() const noexcept { return ends_.empty(); }

  /// The row, counted through all pieces; a binary search over them.
  const Sample& operator[](std::size_t row) const {
    const auto piece = static_cast<std::size_t>(std::upper_bound(ends_.begin(), ends_.end(), row) - ends_.begin());
    const FlightRows& of = pieces_[piece];
    return (*of.flight)[of.rows.end - (ends_[piece] - row)];
  }

 private:
  std::vector<FlightRows> pieces_;
  std::vector<std::size_t> ends_;  ///< per piece: rows up to and including it
};

/// Every row of the flights of a container.
template <class Flights>
RowSet all_rows(const Flights& flights) {
  RowSet rows;
  for (const Flight& flight : flights) rows.add(flight, {0, flight.size()});
  return rows;
}
template <class Flights>
RowSet all_rows(const Flights&&) = delete;  // the flights would be gone

/// Median time between a row and the next of the same piece, s; the mean of the steps within 0.5 us of it, as seconds
/// since 1970 are rounded to 0.24 us. 0 where no piece has two rows, or where the medians of two pieces differ by more
/// than a hundredth of the first: then there is no one period. To the nanosecond, as a block holds it: times are sums
/// of steps.
double sample_period_s(const RowSet& rows);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/data/impl/row_set.hpp"
#endif
