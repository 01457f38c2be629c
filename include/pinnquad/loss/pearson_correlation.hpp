// SPDX-License-Identifier: MIT
// Pearson's correlation as a loss. Sec. 4.2 argues against it; it is here for the comparison.
#pragma once

#include <cmath>

#include "pinnquad/loss/local_monotonicity.hpp"

namespace pinnquad {

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
    using Scalar = typename Batch::Scalar;
    using Series = detail::SignedCommandSum<Axis, Context, Batch>;
    const Series series(context, batch, Scalar(1));
    typename Series::Array by_commands = Series::Array::Zero(series.commands.size());
    const Scalar value = pearson_loss(series.commands, series.angular_acceleration, weight, by_commands);
    series.add_gradient(by_commands, gradient);
    return value;
  }
};

}  // namespace pinnquad
