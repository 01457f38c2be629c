// SPDX-License-Identifier: MIT
// Rows of a training beside their mirror images, or under other headings (data/mirrored_flight.hpp): a loss then asks for
// the symmetry without being told.
//   const SymmetricRows rows(training, airframe, {true, true}, engine);
//   fit_monotone<Residual>(context, rows.rows(), validation, ...);
#pragma once

#include <memory>
#include <vector>

#include "pinnquad/data/mirrored_flight.hpp"
#include "pinnquad/data/row_set.hpp"

namespace pinnquad {

struct Symmetries {
  bool mirrored = true;  ///< each row once more as its mirror image
  bool turned = false;   ///< each of these once more under a heading drawn at random
};

/// Owns the copies; what it was made of must outlive it. The rows come first, in their order.
class SymmetricRows {
 public:
  /// Throws what mirrored() and turned_at_random() throw.
  template <class Scalar, class Engine>
  SymmetricRows(const RowSet& rows, const Airframe<Scalar>& airframe, const Symmetries& which, Engine& engine)
      : rows_(rows) {
    if (which.mirrored) add(rows, [&](const Flight& flight) { return pinnquad::mirrored(flight, airframe); });
    if (which.turned) add(RowSet(rows_), [&](const Flight& flight) { return turned_at_random(flight, engine); });
  }

  const RowSet& rows() const noexcept { return rows_; }

 private:
  template <class Change>
  void add(const RowSet& rows, const Change& change) {
    for (const FlightRows& piece : rows.pieces()) {
      copies_.push_back(std::make_unique<Flight>(change(*piece.flight)));
      rows_.add(*copies_.back(), piece.rows);
    }
  }

  RowSet rows_;
  std::vector<std::unique_ptr<Flight>> copies_;
};

}  // namespace pinnquad
