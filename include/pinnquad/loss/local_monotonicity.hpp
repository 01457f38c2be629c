// SPDX-License-Identifier: MIT
// Algorithm 1: where an angular acceleration rises, the matching signed sum of motor commands should rise too.
#pragma once

#include <cmath>

#include "pinnquad/loss/loss.hpp"

namespace pinnquad {

/// Step function tanh(gain x): differentiable sign. A gain of 3 on series standardised by their spread trains well; the
/// paper prints gain 1 on raw series.
struct TanhStep {
  double gain = 3.0;

  /// Step of a whole array of differences.
  template <class Array>
  void apply(Array& differences) const {
    differences = (typename Array::Scalar(gain) * differences).tanh();
  }
  /// d step / d difference, from the step's value.
  template <class Array>
  Array slope(const Array& steps) const {
    using Scalar = typename Array::Scalar;
    return Scalar(gain) * (Scalar(1) - steps * steps);
  }
};

/// The sign itself, for evaluation: its slope is zero, so it can't train.
struct SignStep {
  template <class Array>
  void apply(Array& differences) const {
    differences = differences.sign();
  }
  template <class Array>
  Array slope(const Array& steps) const {
    return Array::Zero(steps.size());
  }
};

/// mean over the N - 1 consecutive pairs of 1 - step(m_{i+1} - m_i) step(n_{i+1} - n_i); N = 1 gives 0.
/// 0: the series rise and fall together; 1: unrelated; 2: always opposed. Adds weight * d/dm to `gradient`.
/// Algorithm 1 prints 1 / N_b over N_b - 1 terms; the mean over the pairs gives footnote 2's values (NOTES #8).
template <class Step, class Array>
typename Array::Scalar local_monotonicity(const Step& step, const Array& m, const Array& n,
                                          typename Array::Scalar weight, Array& gradient) {
  using Scalar = typename Array::Scalar;
  const Eigen::Index pairs = m.size() - 1;
  if (pairs < 1) return Scalar(0);
  Array step_m = m.tail(pairs) - m.head(pairs);
  Array step_n = n.tail(pairs) - n.head(pairs);
  step.apply(step_m);
  step.apply(step_n);
  const Array slope = (-weight / Scalar(pairs)) * step_n * step.slope(step_m);
  gradient.tail(pairs) += slope;
  gradient.head(pairs) -= slope;
  return (Scalar(1) - step_m * step_n).sum() / Scalar(pairs);
}

/// Local monotonicity about one axis (Roll, Pitch or Yaw): m = signed sum of predicted commands with the signs of the airframe's
/// allocation, n = angular acceleration, each divided by its spread in the training set (NOTES #9).
template <class Axis, class Step = TanhStep>
struct LocalMonotonicity {
  Step step{};

  template <class Context, class Batch, class Gradient>
  typename Batch::Scalar evaluate(const Context& context, const Batch& batch, typename Batch::Scalar weight,
                                  Gradient& gradient) const {
    static_assert(Context::Features::angular_acceleration >= 0,
                  "pinnquad: LocalMonotonicity needs a feature set that holds the angular accelerations");
    using Scalar = typename Batch::Scalar;
    using Array = Eigen::Array<Scalar, Eigen::Dynamic, 1, int(Eigen::ColMajor) | int(Eigen::DontAlign), Batch::max_size>;
    constexpr Airframe<Scalar> airframe = airframe_value<typename Context::Vehicle, Scalar>();
    constexpr std::array<Scalar, rotor_count> signs = allocation_signs(airframe, Axis::axis);
    const Scalar spread = Scalar(context.signed_sum_spread[static_cast<std::size_t>(Axis::axis)]);
    const Eigen::Index size = batch.prediction.cols();

    Array m = Array::Zero(size);
    Eigen::Array<Scalar, rotor_count, Eigen::Dynamic, int(Eigen::ColMajor) | int(Eigen::DontAlign), rotor_count,
                 Batch::max_size>
        slope(rotor_count, size);  // d m / d standardised prediction
    for (Eigen::Index sample = 0; sample < size; ++sample) {
      for (std::size_t i = 0; i < rotor_count; ++i) {
        const Scalar scale = Scalar(context.output.spread[i]);
        const Scalar output =
            batch.prediction(static_cast<Eigen::Index>(i), sample) * scale + Scalar(context.output.mean[i]);
        const Scalar sign = signs[i] / spread;
        m[sample] += sign * Context::Outputs::command(output, airframe);
        slope(static_cast<Eigen::Index>(i), sample) =
            sign * scale * Context::Outputs::command_slope(output, airframe);
      }
    }
    const Array n = batch.features.row(Context::Features::angular_acceleration + Axis::axis).transpose().array();
    Array by_sum = Array::Zero(size);
    const Scalar value = local_monotonicity(step, m, n, weight, by_sum);
    gradient.array() += slope.rowwise() * by_sum.transpose();
    return value;
  }
};

}  // namespace pinnquad
