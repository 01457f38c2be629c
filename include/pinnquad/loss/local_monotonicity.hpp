// SPDX-License-Identifier: MIT
// Losses between an angular acceleration and the matching signed sum of motor commands: local monotonicity (Algorithm
// 1: where one rises, the other should rise too), and Pearson's correlation for the comparison (Sec. 4.2 argues against
// it).
#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/schedule/settings.hpp"

namespace pinnquad {

namespace detail {

/// Both series over the samples of a batch, and how the first depends on the predictions. No heap.
template <class Axis, class Context, class Batch>
struct SignedCommandSum {
  static_assert(
      Context::Features::angular_acceleration >= 0,
      "pinnquad: LocalMonotonicity and PearsonCorrelation need a feature set that holds the angular accelerations");
  using Scalar = typename Batch::Scalar;
  using Array = Eigen::Array<Scalar, Eigen::Dynamic, 1, int(Eigen::ColMajor) | int(Eigen::DontAlign), Batch::max_size>;
  using Map = OutputMap<typename Context::Outputs>;
  using Slope = Eigen::Array<Scalar, Map::size, Eigen::Dynamic, int(Eigen::RowMajor) | int(Eigen::DontAlign), Map::size,
                             Batch::max_size>;

  Array commands;              ///< m: sum of sign_i u_i with the allocation's signs, divided by `divisor`
  Slope slope;                 ///< d m / d standardised prediction
  Array angular_acceleration;  ///< n: standardised, as the network is given it

  SignedCommandSum(const Context& context, const Batch& batch, Scalar divisor)
      : commands(batch.prediction.cols()), slope(Map::size, batch.prediction.cols()) {
    std::array<Scalar, rotor_count> signs = context.template signs<Axis, Scalar>();
    for (Scalar& sign : signs) sign /= divisor;
    Scalar scale[Map::size], mean[Map::size];
    for (std::size_t k = 0; k < std::size_t(Map::size); ++k) {
      scale[k] = Scalar(context.output.standard_deviation[k]);
      mean[k] = Scalar(context.output.mean[k]);
    }
    const auto setting = context.template output_setting<typename Context::Outputs, Scalar>();
    for (Eigen::Index sample = 0; sample < commands.size(); ++sample) {
      Scalar x[Context::Features::size], outputs[Map::size], u[rotor_count], by_outputs[Map::slope_count];
      if constexpr (Map::takes_features) {
        for (int k = 0; k < Context::Features::size; ++k) {
          const auto feature = static_cast<std::size_t>(k);
          x[k] = batch.features(k, sample) * Scalar(context.input.standard_deviation[feature]) +
                 Scalar(context.input.mean[feature]);
        }
      }
      for (int k = 0; k < Map::size; ++k) outputs[k] = batch.prediction(k, sample) * scale[k] + mean[k];
      const Scalar* features = Map::takes_features ? static_cast<const Scalar*>(x) : nullptr;
      Map::commands(features, static_cast<const Scalar*>(outputs), setting, u);
      Map::slopes(features, static_cast<const Scalar*>(outputs), setting, by_outputs);
      Scalar sum(0), by_prediction[Map::size] = {};
      for (int i = 0; i < rotor_count; ++i) {
        const Scalar sign = signs[static_cast<std::size_t>(i)];
        sum += sign * u[i];
        for (int k = Map::first_output(i); k < Map::last_output(i); ++k) {
          by_prediction[k] += sign * scale[k] * by_outputs[Map::slope_index(i, k)];
        }
      }
      commands[sample] = sum;
      for (int k = 0; k < Map::size; ++k) slope(k, sample) = by_prediction[k];
    }
    angular_acceleration = batch.features.row(Context::Features::angular_acceleration + Axis::axis).transpose().array();
  }

  /// The value of `compare(m, n, dL/dm)`; adds dL/d prediction to `gradient`.
  template <class Compare, class Gradient>
  Scalar evaluate(const Compare& compare, Gradient& gradient) const {
    Array by_commands = Array::Zero(commands.size());
    const Scalar value = compare(commands, angular_acceleration, by_commands);
    gradient.array() += slope.rowwise() * by_commands.transpose();
    return value;
  }
};

}  // namespace detail

namespace detail {
/// The steps of both series from sample to sample: tanh(gain x) of each difference x, a sign that has a slope. What is
/// stepped is aligned and as long as the series, with a difference of 0 at the end: Eigen would do the lanes around
/// whole packs one by one.
template <class Array>
struct StepPairs {
  using Scalar = typename Array::Scalar;
  Scalar gain;
  Eigen::Index count;
  Array m, n;

  StepPairs(double gain_, const Array& series_m, const Array& series_n)
      : gain(Scalar(gain_)),
        count(series_m.size() > 0 ? series_m.size() - 1 : 0),
        m(steps(series_m)),
        n(steps(series_n)) {}

  /// Adds dL/d series_m, given dL/d step_m.
  template <class Derivative>
  void add_gradient(const Eigen::ArrayBase<Derivative>& by_step, Array& gradient) const {
    const Array slope = by_step.derived() * (gain * (Scalar(1) - m * m));
    gradient.tail(count) += slope.head(count);
    gradient.head(count) -= slope.head(count);
  }

 private:
  Array steps(const Array& series) const {
    constexpr int most = Array::MaxSizeAtCompileTime;
    Array result(series.size());
    if constexpr (most == Eigen::Dynamic) {
      take(series, result);
    } else {
      alignas(64) Scalar values[std::size_t(most)];
      Eigen::Map<Array, Eigen::Aligned64> aligned(values, series.size());
      take(series, aligned);
      result = aligned;
    }
    return result;
  }
  template <class Differences>
  void take(const Array& series, Differences& differences) const {
    differences.setZero();
    differences.head(count) = series.tail(count) - series.head(count);
    differences = (gain * differences).tanh();
  }
};
}  // namespace detail

/// mean over the N - 1 consecutive pairs of 1 - step(m_{i+1} - m_i) step(n_{i+1} - n_i), step(x) = tanh(gain x); N = 1
/// gives 0.
/// 0: the series rise and fall together; 1: unrelated; 2: always opposed. Adds weight * d/dm to `gradient`.
/// Algorithm 1 prints 1 / N_b over N_b - 1 terms; the mean over the pairs gives footnote 2's values (docs/paper.md,
/// deviation 8).
template <class Array>
typename Array::Scalar local_monotonicity(double gain, const Array& m, const Array& n, typename Array::Scalar weight,
                                          Array& gradient) {
  using Scalar = typename Array::Scalar;
  const detail::StepPairs<Array> steps(gain, m, n);
  if (steps.count < 1) return Scalar(0);
  const auto pairs = static_cast<Scalar>(steps.count);
  steps.add_gradient((-weight / pairs) * steps.n, gradient);
  return (Scalar(1) - steps.m * steps.n).head(steps.count).sum() / pairs;
}

/// Form of the loss, default: both series divided by their standard deviations in the training set, mean over the pairs
/// (docs/paper.md, deviations 8 and 9).
struct Standardised {
  static constexpr double gain = 3.0;  ///< of the step where none is set: it trains well
  static constexpr bool physical_units = false;
  template <class Array>
  static typename Array::Scalar compare(double steepness, const Array& m, const Array& n, typename Array::Scalar weight,
                                        Array& gradient) {
    return local_monotonicity(steepness, m, n, weight, gradient);
  }
};

/// Form of the loss as Algorithm 1 prints it: tanh of the differences as they are (commands; rad/s^2), the N_b - 1
/// terms divided by N_b.
struct Literal {
  static constexpr double gain = 1.0;
  static constexpr bool physical_units = true;
  template <class Array>
  static typename Array::Scalar compare(double steepness, const Array& m, const Array& n, typename Array::Scalar weight,
                                        Array& gradient) {
    using Scalar = typename Array::Scalar;
    const Scalar share = m.size() > 0 ? Scalar(m.size() - 1) / Scalar(m.size()) : Scalar(0);
    return share * local_monotonicity(steepness, m, n, share * weight, gradient);
  }
};

/// Form of the loss for equal steps, not only equal signs, on standardised series (not in the paper): mean over the
/// pairs of (step(m_{i+1} - m_i) - step(n_{i+1} - n_i))^2; N = 1 gives 0.
struct Match {
  static constexpr double gain = 3.0;
  static constexpr bool physical_units = false;
  template <class Array>
  static typename Array::Scalar compare(double steepness, const Array& m, const Array& n, typename Array::Scalar weight,
                                        Array& gradient) {
    using Scalar = typename Array::Scalar;
    const detail::StepPairs<Array> steps(steepness, m, n);
    if (steps.count < 1) return Scalar(0);
    const auto pairs = static_cast<Scalar>(steps.count);
    steps.add_gradient((Scalar(2) * weight / pairs) * (steps.m - steps.n), gradient);
    return (steps.m - steps.n).square().head(steps.count).sum() / pairs;
  }
};

namespace detail {
using ProbeArray = Eigen::Array<double, Eigen::Dynamic, 1, int(Eigen::ColMajor) | int(Eigen::DontAlign), 8>;
template <class T>
using FormOf = std::void_t<decltype(T::gain), decltype(T::physical_units),
                           decltype(T::compare(1.0, std::declval<const ProbeArray&>(),
                                               std::declval<const ProbeArray&>(), 1.0, std::declval<ProbeArray&>()))>;
}  // namespace detail

/// Local monotonicity about one axis (Roll, Pitch or Yaw): m = signed sum of predicted commands with the signs of the
/// airframe's allocation, n = angular acceleration, compared as the form says.
template <class Axis, class Form = Standardised>
struct LocalMonotonicity {
  static_assert(
      is_detected<detail::FormOf, Form>,
      "pinnquad: LocalMonotonicity's second argument is not a form; it needs gain, physical_units and compare(), as "
      "Standardised has");
  double gain = Form::gain;

  /// Throws std::invalid_argument unless the gain is a finite number from 0.
  constexpr void check() const { detail::expect_from_zero("LocalMonotonicity::gain", gain); }

  template <class Context, class Batch, class Gradient>
  typename Batch::Scalar evaluate(const Context& context, const Batch& batch, typename Batch::Scalar weight,
                                  Gradient& gradient) const {
    using Scalar = typename Batch::Scalar;
    using Series = detail::SignedCommandSum<Axis, Context, Batch>;
    constexpr auto axis = static_cast<std::size_t>(Axis::axis);
    Series series(context, batch, Form::physical_units ? Scalar(1) : Scalar(context.signed_sum_deviation[axis]));
    if constexpr (Form::physical_units) {
      constexpr auto feature = static_cast<std::size_t>(Context::Features::angular_acceleration) + axis;
      series.angular_acceleration *=
          Scalar(context.input.standard_deviation[feature]);  // differences: the mean drops out
    }
    return series.evaluate(
        [&](const auto& m, const auto& n, auto& by_m) { return Form::compare(gain, m, n, weight, by_m); }, gradient);
  }
};

/// 1 - r(m, n), r = sum (m - mean m)(n - mean n) / (|m - mean m| |n - mean n|): 0 correlated, 1 unrelated, 2 opposed.
/// Adds weight * d/dm to `gradient`. A series that stands still has no correlation: 1, no gradient; a single sample
/// gives 0.
template <class Array>
typename Array::Scalar pearson_loss(const Array& m, const Array& n, typename Array::Scalar weight, Array& gradient) {
  using Scalar = typename Array::Scalar;
  using std::sqrt;
  if (m.size() < 2) return Scalar(0);
  const Array a = m - m.mean();
  const Array b = n - n.mean();
  const Scalar a_squared = a.square().sum();
  const Scalar lengths = sqrt(a_squared * b.square().sum());
  if (!(lengths > Scalar(0))) return Scalar(1);
  const Scalar correlation = (a * b).sum() / lengths;
  // dr/dm = b / (|a| |b|) - r a / |a|^2: the means drop out, both have sum 0
  gradient -= weight * (b / lengths - (correlation / a_squared) * a);
  return Scalar(1) - correlation;
}

/// The same between the signed sum of predicted commands and the angular acceleration about one axis; units drop out.
template <class Axis>
struct PearsonCorrelation {
  template <class Context, class Batch, class Gradient>
  typename Batch::Scalar evaluate(const Context& context, const Batch& batch, typename Batch::Scalar weight,
                                  Gradient& gradient) const {
    const detail::SignedCommandSum<Axis, Context, Batch> series(context, batch, typename Batch::Scalar(1));
    return series.evaluate([&](const auto& m, const auto& n, auto& by_m) { return pearson_loss(m, n, weight, by_m); },
                           gradient);
  }
};

}  // namespace pinnquad
