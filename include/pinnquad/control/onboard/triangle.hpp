// SPDX-License-Identifier: MIT
// Least squares that runs along a flight, in square-root form: the triangle R of M = Q R, turned by Givens rotations,
// one row of M at a time. Its numbers grow with the square root of the rows: float is enough where sums of products,
// R^T R, would need double.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace pinnquad {

/// R of all rows so far, each as often as it is still remembered: R^T R = sum keep^(n - i) m_i m_i^T. What is regressed
/// on what is decided when it is solved: a column is regressed on those before it.
/// Golub and Van Loan, Matrix Computations, 5.1 and 6.5 (rotations, updating).
template <class Scalar, std::size_t columns>
class Triangle {
 public:
  using Row = std::array<Scalar, columns>;

  /// Rows so far, each as often as it is still remembered.
  Scalar rows() const noexcept { return rows_; }
  /// An entry, row <= column.
  Scalar at(std::size_t row, std::size_t column) const noexcept { return entries_[start_of_row(row) + column - row]; }

  /// root_keep: square root of the share that is kept of all rows before.
  void add(const Row& row, Scalar root_keep) noexcept {
    for (Scalar& entry : entries_) entry *= root_keep;
    rows_ = root_keep * root_keep * rows_ + Scalar(1);
    turn_in(row, 0);
  }

  /// A row whose first entries, before `first`, are 0; it is not counted.
  void turn_in(Row row, std::size_t first) noexcept {
    using std::sqrt;
    Scalar* entry = entries_.data() + start_of_row(first);
    for (std::size_t i = first; i < columns; ++i) {
      const Scalar square = entry[0] * entry[0] + row[i] * row[i];
      if (square > Scalar(0)) {
        const Scalar inverse = Scalar(1) / sqrt(square);
        const Scalar along = entry[0] * inverse, beside = row[i] * inverse;
        for (std::size_t j = i; j < columns; ++j) {
          const Scalar before = entry[j - i];
          entry[j - i] = along * before + beside * row[j];
          row[j] = along * row[j] - beside * before;
        }
      }
      entry += columns - i;
    }
  }

 private:
  static constexpr std::size_t start_of_row(std::size_t i) noexcept { return i * (2 * columns + 1 - i) / 2; }

  std::array<Scalar, columns*(columns + 1) / 2> entries_{};  ///< row by row, each from its diagonal on
  Scalar rows_{0};
};

}  // namespace pinnquad
