// SPDX-License-Identifier: MIT
// Least squares that runs along a flight, in square-root form: the triangle R of M = Q R, turned by Givens rotations,
// one row of M at a time. Its numbers grow with the square root of the rows: float is enough where sums of products,
// R^T R, would need double.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace pinnquad::detail {

/// The rotation that turns an entry of a row into the diagonal of a triangle, which is kept by a share at once.
template <class Scalar>
struct Turn {
  Scalar along, beside, kept_along, kept_beside;

  void operator()(Scalar& entry, Scalar& of_row) const noexcept {
    const Scalar before = entry;
    entry = kept_along * before + beside * of_row;
    of_row = along * of_row - kept_beside * before;
  }
};

/// R of all rows so far, each as often as it is still remembered: R^T R = sum keep^(n - i) m_i m_i^T. What is regressed
/// on what is decided when it is solved: a column is regressed on those before it.
/// Golub and Van Loan, Matrix Computations, 5.1 and 6.5 (rotations, updating).
template <class Scalar, std::size_t columns>
class Triangle {
 public:
  using Row = std::array<Scalar, columns>;

  /// An entry, row <= column.
  Scalar at(std::size_t row, std::size_t column) const noexcept { return entries_[start_of_row(row) + column - row]; }
  Scalar& at(std::size_t row, std::size_t column) noexcept { return entries_[start_of_row(row) + column - row]; }

  /// A row whose first entries, before `first`, are 0; root_keep: square root of the share that is kept of all before.
  void turn_in(Row row, Scalar root_keep, std::size_t first = 0) noexcept {
    turn_in(row, root_keep, first, columns, [](std::size_t, const Turn<Scalar>&) noexcept {});
  }
  /// The same up to the diagonal before `end`; `row` is what is left. `also(i, turn)` turns what lies beside row i.
  template <class Also>
  void turn_in(Row& row, Scalar root_keep, std::size_t first, std::size_t end, const Also& also) noexcept {
    using std::sqrt;
    Scalar* entry = entries_.data() + start_of_row(first);
    for (std::size_t i = first; i < end; ++i) {
      const Scalar kept = root_keep * entry[0];
      const Scalar square = kept * kept + row[i] * row[i];
      if (square > Scalar(0)) {
        const Scalar inverse = Scalar(1) / sqrt(square);
        const Scalar along = kept * inverse, beside = row[i] * inverse;
        const Turn<Scalar> turn{along, beside, root_keep * along, root_keep * beside};
        entry[0] = square * inverse;
        for (std::size_t j = i + 1; j < columns; ++j) turn(entry[j - i], row[j]);
        also(i, turn);
      }
      entry += columns - i;
    }
  }

 private:
  static constexpr std::size_t start_of_row(std::size_t i) noexcept { return i * (2 * columns + 1 - i) / 2; }

  std::array<Scalar, columns*(columns + 1) / 2> entries_{};  ///< row by row, each from its diagonal on
};

/// R of M_v = [A, B_v, y] for each v of `variants`: rows and rotations of A, `shared` columns, are of all of them.
template <class Scalar, std::size_t shared, std::size_t own, std::size_t variants>
class SharedTriangle {
 public:
  using Row = std::array<Scalar, shared + 1>;  ///< of A, and y
  using Owns = std::array<std::array<Scalar, own>, variants>;

  /// Forgets all rows, part by part: a triangle of its own for it would be on the stack.
  void clear() noexcept {
    head_ = {};
    for (Owns& beside : beside_) beside = {};
    for (Triangle<Scalar, own + 1>& tail : tails_) tail = {};
  }

  /// A row; nothing of it is left.
  void turn_in(Row& row, Owns& owns, Scalar root_keep) noexcept {
    head_.turn_in(row, root_keep, 0, shared, [&](std::size_t i, const Turn<Scalar>& turn) noexcept {
      for (std::size_t v = 0; v < variants; ++v) {
        for (std::size_t j = 0; j < own; ++j) turn(beside_[i][v][j], owns[v][j]);
      }
    });
    for (std::size_t v = 0; v < variants; ++v) {
      typename Triangle<Scalar, own + 1>::Row rest{};
      for (std::size_t j = 0; j < own; ++j) rest[j] = owns[v][j];
      rest[own] = row[shared];
      tails_[v].turn_in(rest, root_keep);
    }
  }

  /// R of [A, B_v, y].
  Triangle<Scalar, shared + own + 1> of(std::size_t v) const noexcept {
    Triangle<Scalar, shared + own + 1> whole;
    for (std::size_t i = 0; i < shared; ++i) {
      for (std::size_t j = i; j < shared; ++j) whole.at(i, j) = head_.at(i, j);
      for (std::size_t j = 0; j < own; ++j) whole.at(i, shared + j) = beside_[i][v][j];
      whole.at(i, shared + own) = head_.at(i, shared);
    }
    for (std::size_t i = 0; i <= own; ++i) {
      for (std::size_t j = i; j <= own; ++j) whole.at(shared + i, shared + j) = tails_[v].at(i, j);
    }
    return whole;
  }
  /// Root of the sum of squares that A and B_v leave of y.
  Scalar left(std::size_t v) const noexcept { return tails_[v].at(own, own); }

 private:
  Triangle<Scalar, shared + 1> head_;  ///< without its last diagonal
  std::array<Owns, shared> beside_{};
  std::array<Triangle<Scalar, own + 1>, variants> tails_{};
};

}  // namespace pinnquad::detail
