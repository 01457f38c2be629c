// SPDX-License-Identifier: MIT
// Rows of a flight -> the forward model of each signed sum: a triangle for each sum and lag, the lag that leaves least,
// and the drag across the thrust.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "pinnquad/control/onboard/forward_model.hpp"
#include "pinnquad/control/onboard/lag_bank.hpp"
#include "pinnquad/control/onboard/triangle.hpp"
#include "pinnquad/core/finite.hpp"

namespace pinnquad {

/// Settings of a SumRegression.
template <class Scalar>
struct RegressionSettings {
  Scalar forget_s = Scalar(20), forget_drag_s = Scalar(30);
  Scalar repeats = Scalar(3);  ///< rows that say the same, as two of them share a period
  /// Feedback answers wind with the commands that a row is of, and least squares take one for the other. Rows are
  /// beside this share of their running means, so long, which the wind is in too; not of yaw.
  std::array<Scalar, 3> wind_s{Scalar(0.15), Scalar(0.3), Scalar(0.3)};
  Scalar wind_share = Scalar(0.9);
  /// So many are one row of roll, pitch or yaw, their mean. Gyro noise, which feedback answers, cancels in rows that
  /// follow each other.
  std::uint32_t rows_of_torque = 5;
  Scalar lag_spread = Scalar(0.7);  ///< standard deviation of log(lag / the start's)
};

/// Drag across the thrust over the mass: a = -(linear + quadratic |v|) v of the two axes across, FRD.
template <class Scalar>
struct LateralDrag {
  Scalar linear_1_s{0}, quadratic_1_m{0};

  /// At a body velocity, m/s^2, FRD.
  Vector3<Scalar> of(const Vector3<Scalar>& velocity_m_s) const noexcept {
    using std::sqrt;
    const Scalar by = -(linear_1_s + quadratic_1_m * sqrt(dot<Scalar>(velocity_m_s, velocity_m_s)));
    return {by * velocity_m_s[0], by * velocity_m_s[1], Scalar(0)};
  }
};

namespace detail {
/// Least squares of all sums at all lags, row by row.
template <class Scalar>
class SumRegression {
 public:
  SumRegression(const RegressionSettings<Scalar>& settings, std::uint32_t period_us) noexcept
      : settings_(settings), period_us_(period_us) {
    using std::exp;
    const Scalar period_s = Scalar(1e-6) * static_cast<Scalar>(period_us);
    root_keep_ = exp(-period_s / (Scalar(2) * settings.forget_s));
    root_keep_torque_ = exp(-Scalar(settings.rows_of_torque) * period_s / (Scalar(2) * settings.forget_s));
    for (std::size_t k = 0; k < 3; ++k) follows_[k] = period_s / (period_s + settings.wind_s[k]);
    root_keep_drag_ = exp(-period_s / (Scalar(4) * settings.forget_drag_s));  // two rows a period
  }

  /// Forgets all rows: they are of no flight.
  void forget() noexcept {
    triangles_ = {};
    rows_ = means_of_torque_ = rows_of_drag_ = Scalar(0);
    drag_ = {};
    mean_ = {};
  }

  /// A row: the motion, the thrusts that the rotors of each lag would have followed, and the specific force, FRD.
  void teach(std::uint64_t now_us, const SumMotion<Scalar>& motion, const LagBank<Scalar>& bank,
             const Vector3<Scalar>& force_m_s2) noexcept {
    // rows of one mean follow each other
    if (now_us / period_us_ - row_us_ / period_us_ > 1) mean_ = {};
    row_us_ = now_us;
    ++mean_.rows;
    for (std::size_t k = 0; k < 4; ++k) {
      SumRow row = row_of(k, motion, bank);
      if (k < 3) {
        if (!(rows_ > Scalar(0))) running_[k] = row;
        put_beside(row, running_[k], follows_[k], settings_.wind_share);
      }
      if (k == 0) {
        triangles_[0].turn_in(row.shared, row.owns, root_keep_);
      } else {
        teach_torque(k, row);
      }
    }
    rows_ = keep() * rows_ + Scalar(1);
    if (mean_.rows == settings_.rows_of_torque) {
      means_of_torque_ = root_keep_torque_ * root_keep_torque_ * means_of_torque_ + Scalar(1);
      mean_ = {};
    }
    teach_drag(motion.velocity_m_s, force_m_s2);
  }

  /// Share of the rows before that is kept.
  Scalar keep() const noexcept { return root_keep_ * root_keep_; }
  /// Rows of a sum that are remembered.
  Scalar rows(std::size_t k) const noexcept {
    return k == 0 ? rows_ : means_of_torque_ * Scalar(settings_.rows_of_torque);
  }

  /// The lag that leaves least of the angular accelerations, between those of the bank by the parabola through the best
  /// one and its neighbours; yaw counts a third. `start_s`: a prior, which decides where noise leaves it open.
  LagPlace<Scalar> best_lag(Scalar start_s) const noexcept {
    using std::log;
    const Scalar weight = settings_.repeats / (means_of_torque_ + Scalar(1));
    const auto apart = [this, weight, start_s](std::size_t lag) noexcept {
      const Scalar deviations = log(lag_bank_s<Scalar>[lag] / start_s) / settings_.lag_spread;
      return weight * deviations * deviations;
    };
    std::array<std::array<Scalar, 3>, lag_count> left{};
    std::array<Scalar, lag_count> sum{};
    std::size_t best = 0;
    for (std::size_t lag = 0; lag < lag_count; ++lag) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Scalar root = triangles_[axis + 1].left(lag);
        left[lag][axis] = root * root + Scalar(1e-12);
        sum[lag] += weights[axis] * log(left[lag][axis]);
      }
      sum[lag] += apart(lag);
      if (sum[lag] < sum[best]) best = lag;
    }
    const Scalar at = lag_bank_s<Scalar>[best];
    if (best == 0 || best + 1 == lag_count) return lag_place(at);
    const Scalar low = lag_bank_s<Scalar>[best - 1] - at, high = lag_bank_s<Scalar>[best + 1] - at;
    Scalar by_low = (apart(best - 1) - apart(best)) / low, by_high = (apart(best + 1) - apart(best)) / high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      by_low += weights[axis] * (left[best - 1][axis] / left[best][axis] - Scalar(1)) / low;
      by_high += weights[axis] * (left[best + 1][axis] / left[best][axis] - Scalar(1)) / high;
    }
    const Scalar curvature = (by_high - by_low) / (high - low);
    const Scalar beside = curvature > Scalar(0) ? (curvature * low - by_low) / (Scalar(2) * curvature) : Scalar(0);
    return lag_place(at + beside);
  }

  /// Solution of a sum at a lag, between those of the two beside it. `start`: its prior.
  SumSolution<Scalar> solution(std::size_t k, const LagPlace<Scalar>& lag,
                               const ForwardSum<Scalar>& start) const noexcept {
    const Terms<Scalar> deviations = prior_deviations(k, start);
    const auto at = [&](std::size_t place) noexcept {
      return solved(triangles_[k].of(place), k == 0 ? rows_ : means_of_torque_, start.theta, deviations,
                    settings_.repeats);
    };
    SumSolution<Scalar> result = at(lag.lower);
    const SumSolution<Scalar> next = at(lag.lower + 1u);
    for (std::size_t i = 0; i < term_count; ++i) result.theta[i] = lag.of(result.theta[i], next.theta[i]);
    result.standard_error = lag.of(result.standard_error, next.standard_error);
    result.left_square = lag.of(result.left_square, next.left_square);
    return result;
  }

  /// The drag, each number from 0 to as much as a vehicle has; a prior of 0.2 /s and 0.05 /m around none.
  LateralDrag<Scalar> drag() const noexcept {
    using std::sqrt;
    if (!(rows_of_drag_ > Scalar(0))) return {};
    Triangle<Scalar, 3> triangle = drag_;
    const Scalar left = triangle.at(2, 2) * triangle.at(2, 2) / rows_of_drag_;
    const Scalar weight = sqrt(settings_.repeats * left + Scalar(1e-12));
    triangle.turn_in({weight / Scalar(0.2), Scalar(0), Scalar(0)}, Scalar(1));
    triangle.turn_in({Scalar(0), weight / Scalar(0.05), Scalar(0)}, Scalar(1), 1);
    const Scalar quadratic = triangle.at(1, 2) / triangle.at(1, 1);
    const Scalar linear = (triangle.at(0, 2) - triangle.at(0, 1) * quadratic) / triangle.at(0, 0);
    const auto within = [](Scalar value, Scalar most) noexcept {
      return value > Scalar(0) ? (value < most ? value : most) : Scalar(0);  // NaN: none
    };
    return {within(linear, Scalar(2)), within(quadratic, Scalar(0.5))};
  }

 private:
  static constexpr std::array<Scalar, 3> weights{Scalar(1), Scalar(1), Scalar(0.3)};

  struct SumRow {
    typename SumTriangles<Scalar>::Row shared{};
    typename SumTriangles<Scalar>::Owns owns{};
  };
  static SumRow row_of(std::size_t k, const SumMotion<Scalar>& motion, const LagBank<Scalar>& bank) noexcept {
    SumRow row;
    const Terms<Scalar> x = terms_of(k, motion, Scalar(0), {});
    for (std::size_t i = 0; i < lag_terms; ++i) row.shared[i] = x[i];
    row.shared[lag_terms] = motion.accelerations[k];
    for (std::size_t lag = 0; lag < lag_count; ++lag) {
      const Followed<Scalar> own = bank.at(k, lag);
      row.owns[lag] = {k == 0 ? x[lag_terms] : bank.at(0, lag).sum, own.rise_1_s, own.sum};
    }
    return row;
  }
  static void put_beside(SumRow& row, SumRow& means, Scalar follows, Scalar share) noexcept {
    const auto beside = [=](Scalar& value, Scalar& mean) noexcept {
      mean += follows * (value - mean);
      value -= share * mean;
    };
    for (std::size_t i = 0; i < row.shared.size(); ++i) beside(row.shared[i], means.shared[i]);
    for (std::size_t lag = 0; lag < lag_count; ++lag) {
      for (std::size_t i = 0; i < row.owns[lag].size(); ++i) beside(row.owns[lag][i], means.owns[lag][i]);
    }
  }
  void teach_torque(std::size_t k, const SumRow& row) noexcept {
    const Scalar share = Scalar(1) / Scalar(settings_.rows_of_torque);
    SumRow& mean = mean_.of[k - 1];
    for (std::size_t i = 0; i < row.shared.size(); ++i) mean.shared[i] += share * row.shared[i];
    for (std::size_t lag = 0; lag < lag_count; ++lag) {
      for (std::size_t j = 0; j < row.owns[lag].size(); ++j) mean.owns[lag][j] += share * row.owns[lag][j];
    }
    if (mean_.rows == settings_.rows_of_torque) triangles_[k].turn_in(mean.shared, mean.owns, root_keep_torque_);
  }
  void teach_drag(const Vector3<Scalar>& velocity_m_s, const Vector3<Scalar>& force_m_s2) noexcept {
    using std::sqrt;
    const Scalar speed = sqrt(dot<Scalar>(velocity_m_s, velocity_m_s));
    for (int axis = 0; axis < 2; ++axis) {
      const Scalar v = velocity_m_s[axis];
      drag_.turn_in({-v, -speed * v, force_m_s2[axis]}, root_keep_drag_);
      rows_of_drag_ = root_keep_drag_ * root_keep_drag_ * rows_of_drag_ + Scalar(1);
    }
  }

  RegressionSettings<Scalar> settings_;
  std::uint32_t period_us_;
  Scalar root_keep_{0}, root_keep_torque_{0}, root_keep_drag_{0};
  std::array<Scalar, 3> follows_{};
  std::uint64_t row_us_ = 0;
  std::array<SumTriangles<Scalar>, 4> triangles_{};
  Scalar rows_{0}, means_of_torque_{0}, rows_of_drag_{0};  ///< each as often as it is still remembered
  struct {
    std::array<SumRow, 3> of{};
    std::uint32_t rows = 0;
  } mean_{};                         ///< of roll, pitch and yaw, until it is whole
  std::array<SumRow, 3> running_{};  ///< means, of thrust, roll and pitch
  Triangle<Scalar, 3> drag_{};
};
}  // namespace detail

}  // namespace pinnquad
