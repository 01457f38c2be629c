// SPDX-License-Identifier: MIT
// Least squares that runs along a flight, in square-root form: the triangle R and right-hand side z of R x = z, turned
// by Givens rotations, one row at a time. Its numbers grow with the square root of the rows: float is enough where the
// sums of products would need double.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace pinnquad {

/// A priori, each unknown is `mean`, give or take `deviation`.
template <class Scalar, std::size_t unknowns>
struct TrianglePrior {
  std::array<Scalar, unknowns> mean{};
  std::array<Scalar, unknowns> deviation{};
};

/// Solution of a Triangle, and what is known of its last unknown.
template <class Scalar, std::size_t unknowns>
struct TriangleSolution {
  std::array<Scalar, unknowns> values{};
  Scalar residual{0};        ///< standard deviation of what the regressors leave of a row
  Scalar last_error{0};      ///< standard error of the last unknown, residuals taken for white
  Scalar last_deviation{0};  ///< standard deviation of the last regressor beside what the others say of it
  Scalar last_share{0};      ///< of what the others leave of the output, as a sum of squares, it explains so much
};

/// min sum_i keep^(n - i) (y_i - x_i . theta)^2 + prior. The rows are behind a forgetting, the prior is not: it is
/// added to a copy where the triangle is solved, so that an unknown of which nothing is said any more goes back to it.
/// Golub and Van Loan, Matrix Computations, 5.1 and 6.5 (rotations, updating).
template <class Scalar, std::size_t unknowns>
class Triangle {
 public:
  using Row = std::array<Scalar, unknowns + 1>;  ///< regressors, then the output that they explain

  /// Rows so far, each as often as it is still remembered.
  Scalar rows() const noexcept { return rows_; }

  /// root_keep: square root of the share that is kept of all rows before.
  void add(const Row& row, Scalar root_keep) noexcept {
    for (Scalar& entry : entries_) entry *= root_keep;
    const Scalar keep = root_keep * root_keep;
    Row left = row;
    turn_in(entries_, left, 0);
    left_square_ = keep * left_square_ + left[unknowns] * left[unknowns];
    rows_ = keep * rows_ + Scalar(1);
  }

  /// Mean square of what the regressors leave, without the prior.
  Scalar residual_square() const noexcept { return rows_ > Scalar(0) ? left_square_ / rows_ : Scalar(0); }

  /// `repeats`: so many rows say the same; the prior weighs against the rows as one of their number.
  TriangleSolution<Scalar, unknowns> solve(const TrianglePrior<Scalar, unknowns>& prior,
                                           Scalar repeats) const noexcept {
    using std::sqrt;
    TriangleSolution<Scalar, unknowns> result;
    result.residual = sqrt(residual_square());
    std::array<Scalar, size> entries = entries_;
    constexpr std::size_t corner = size - 2;  // the last unknown's own entry, and its right-hand side
    result.last_deviation = rows_ > Scalar(0) ? magnitude(entries_[corner]) / sqrt(rows_) : Scalar(0);
    const Scalar explained = entries_[corner + 1] * entries_[corner + 1];
    result.last_share = explained > Scalar(0) ? explained / (explained + left_square_) : Scalar(0);
    const Scalar weight = sqrt(repeats) * (result.residual > least_residual ? result.residual : least_residual);
    for (std::size_t i = 0; i < unknowns; ++i) {
      Row row{};
      row[i] = weight / prior.deviation[i];
      row[unknowns] = row[i] * prior.mean[i];
      turn_in(entries, row, i);
    }
    for (std::size_t i = unknowns; i-- > 0;) {
      const std::size_t first = start_of_row(i);
      Scalar right = entries[first + unknowns - i];
      for (std::size_t j = i + 1; j < unknowns; ++j) right -= entries[first + j - i] * result.values[j];
      result.values[i] = right / entries[first];
    }
    result.last_error = weight / magnitude(entries[corner]);
    return result;
  }

 private:
  static constexpr std::size_t size = unknowns * (unknowns + 3) / 2;
  static constexpr Scalar least_residual = Scalar(1e-6);

  static constexpr std::size_t start_of_row(std::size_t i) noexcept { return i * (2 * unknowns + 3 - i) / 2; }
  static constexpr Scalar magnitude(Scalar value) noexcept { return value < Scalar(0) ? -value : value; }

  /// Rotations of one row after the other with the given one, from row `first` on; the output's rest stays in `row`.
  static void turn_in(std::array<Scalar, size>& entries, Row& row, std::size_t first) noexcept {
    using std::sqrt;
    Scalar* entry = entries.data() + start_of_row(first);
    for (std::size_t i = first; i < unknowns; ++i) {
      const Scalar square = entry[0] * entry[0] + row[i] * row[i];
      if (square > Scalar(0)) {
        const Scalar inverse = Scalar(1) / sqrt(square);
        const Scalar along = entry[0] * inverse, beside = row[i] * inverse;
        for (std::size_t j = i; j <= unknowns; ++j) {
          const Scalar before = entry[j - i];
          entry[j - i] = along * before + beside * row[j];
          row[j] = along * row[j] - beside * before;
        }
      }
      entry += unknowns + 1 - i;
    }
  }

  std::array<Scalar, size> entries_{};  ///< row by row, each from its diagonal to its right-hand side
  Scalar left_square_{0};
  Scalar rows_{0};
};

}  // namespace pinnquad
