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
#include "pinnquad/control/onboard/onboard_settings.hpp"
#include "pinnquad/control/onboard/triangle.hpp"
#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/finite.hpp"

namespace pinnquad {

namespace detail {
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

/// Least squares of all sums at all lags, row by row.
template <class Scalar>
class SumRegression {
 public:
  SumRegression(const typename OnboardSettings<Scalar>::Regression& settings, std::uint32_t period_us) noexcept
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
    thrust_.clear();
    for (auto& turn : turns_) turn.clear();
    rows_ = means_of_torque_ = rows_of_drag_ = Scalar(0);
    drag_ = {};
    begin_mean();
  }

  /// A row: the motion, the thrusts that the rotors of each lag would have followed, and the specific force, FRD.
  void teach(std::uint64_t now_us, const SumMotion<Scalar>& motion, const LagBank<Scalar>& bank,
             const Vector3<Scalar>& force_m_s2) noexcept {
    // rows of one mean follow each other
    if (now_us / period_us_ - row_us_ / period_us_ > 1) begin_mean();
    row_us_ = now_us;
    ++mean_.rows;
    teach_thrust(motion, bank);
    for (std::size_t k = 1; k < 4; ++k) teach_torque(k, motion, bank);
    rows_ = keep() * rows_ + Scalar(1);
    if (mean_.rows == settings_.rows_of_torque) {
      means_of_torque_ = root_keep_torque_ * root_keep_torque_ * means_of_torque_ + Scalar(1);
      begin_mean();
    }
    teach_drag(motion.velocity_m_s, force_m_s2);
  }

  /// Share of the rows before that is kept.
  Scalar keep() const noexcept { return root_keep_ * root_keep_; }
  /// Rows of a sum that are remembered.
  Scalar rows(std::size_t k) const noexcept {
    return k == 0 ? rows_ : means_of_torque_ * Scalar(settings_.rows_of_torque);
  }

  /// The lag that leaves least of the angular accelerations, between those of the bank by the parabola of logarithms
  /// through the best one and its neighbours: where two of the bank are as good, it lies in their middle either way.
  /// Yaw counts a third. `start_s`: a prior, which decides where noise leaves it open.
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
        const Scalar root = turns_[axis].left(lag);
        left[lag][axis] = root * root + Scalar(1e-12);
        sum[lag] += weights[axis] * log(left[lag][axis]);
      }
      sum[lag] += apart(lag);
      if (sum[lag] < sum[best]) best = lag;
    }
    if (best + 1 == lag_count) return lag_place(lag_bank_s<Scalar>[best]);
    if (best == 0) best = 1;
    const Scalar at = lag_bank_s<Scalar>[best];
    const Scalar low = lag_bank_s<Scalar>[best - 1] - at, high = lag_bank_s<Scalar>[best + 1] - at;
    Scalar by_low = (apart(best - 1) - apart(best)) / low, by_high = (apart(best + 1) - apart(best)) / high;
    // of quotients: a float has no digits left of logarithms' differences
    for (std::size_t axis = 0; axis < 3; ++axis) {
      by_low += weights[axis] * log(left[best - 1][axis] / left[best][axis]) / low;
      by_high += weights[axis] * log(left[best + 1][axis] / left[best][axis]) / high;
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
      return solved(k == 0 ? thrust_.of(place) : turns_[k - 1].of(place), k == 0 ? rows_ : means_of_torque_,
                    start.theta, deviations, settings_.repeats);
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

  static constexpr std::size_t thrust_terms = lag_terms(0), turn_terms = lag_terms(1);

  template <std::size_t shared_terms>
  struct SumRow {
    typename SumTriangles<Scalar, shared_terms>::Row shared{};
    typename SumTriangles<Scalar, shared_terms>::Owns owns{};
  };
  template <std::size_t shared_terms>
  static SumRow<shared_terms> row_of(std::size_t k, const SumMotion<Scalar>& motion,
                                     const LagBank<Scalar>& bank) noexcept {
    SumRow<shared_terms> row;
    const Terms<Scalar> x = terms_of(k, motion, Scalar(0), {});
    for (std::size_t i = 0; i < shared_terms; ++i) row.shared[i] = x[i];
    row.shared[shared_terms] = motion.accelerations[k];
    for (std::size_t lag = 0; lag < lag_count; ++lag) {
      const Followed<Scalar> own = bank.at(k, lag);
      if constexpr (shared_terms == thrust_terms) {
        row.owns[lag] = {own.rise_1_s, own.sum};
      } else {
        row.owns[lag] = {bank.at(0, lag).sum, own.rise_1_s, own.sum};
      }
    }
    return row;
  }
  void begin_mean() noexcept {  // row by row: a temporary of all three would be on the stack
    for (SumRow<turn_terms>& row : mean_.of) row = {};
    mean_.rows = 0;
  }
  /// Out of line, as teach_torque(): a row is on the stack once.
  PINNQUAD_NOINLINE void teach_thrust(const SumMotion<Scalar>& motion, const LagBank<Scalar>& bank) noexcept {
    SumRow<thrust_terms> row = row_of<thrust_terms>(0, motion, bank);
    put_beside(row, running_thrust_, 0);
    thrust_.turn_in(row.shared, row.owns, root_keep_);
  }
  PINNQUAD_NOINLINE void teach_torque(std::size_t k, const SumMotion<Scalar>& motion,
                                      const LagBank<Scalar>& bank) noexcept {
    SumRow<turn_terms> row = row_of<turn_terms>(k, motion, bank);
    if (k < 3) put_beside(row, running_[k - 1], k);
    const Scalar share = Scalar(1) / Scalar(settings_.rows_of_torque);
    SumRow<turn_terms>& mean = mean_.of[k - 1];
    for (std::size_t i = 0; i < row.shared.size(); ++i) mean.shared[i] += share * row.shared[i];
    for (std::size_t lag = 0; lag < lag_count; ++lag) {
      for (std::size_t j = 0; j < row.owns[lag].size(); ++j) mean.owns[lag][j] += share * row.owns[lag][j];
    }
    if (mean_.rows == settings_.rows_of_torque) turns_[k - 1].turn_in(mean.shared, mean.owns, root_keep_torque_);
  }
  /// A row beside its running mean, which follows it.
  template <std::size_t shared_terms>
  void put_beside(SumRow<shared_terms>& row, SumRow<shared_terms>& running, std::size_t k) const noexcept {
    if (!(rows_ > Scalar(0))) running = row;
    const auto beside = [follows = follows_[k], share = settings_.wind_share](Scalar& value, Scalar& mean) noexcept {
      mean += follows * (value - mean);
      value -= share * mean;
    };
    for (std::size_t i = 0; i < row.shared.size(); ++i) beside(row.shared[i], running.shared[i]);
    for (std::size_t lag = 0; lag < lag_count; ++lag) {
      for (std::size_t i = 0; i < row.owns[lag].size(); ++i) beside(row.owns[lag][i], running.owns[lag][i]);
    }
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

  typename OnboardSettings<Scalar>::Regression settings_;
  std::uint32_t period_us_;
  Scalar root_keep_{0}, root_keep_torque_{0}, root_keep_drag_{0};
  std::array<Scalar, 3> follows_{};
  std::uint64_t row_us_ = 0;
  SumTriangles<Scalar, thrust_terms> thrust_{};
  std::array<SumTriangles<Scalar, turn_terms>, 3> turns_{};
  Scalar rows_{0}, means_of_torque_{0}, rows_of_drag_{0};  ///< each as often as it is still remembered
  struct {
    std::array<SumRow<turn_terms>, 3> of{};
    std::uint32_t rows = 0;
  } mean_{};  ///< of roll, pitch and yaw, until it is whole
  SumRow<thrust_terms> running_thrust_{};
  std::array<SumRow<turn_terms>, 2> running_{};  ///< means, of roll and pitch
  Triangle<Scalar, 3> drag_{};
};
}  // namespace detail

}  // namespace pinnquad
