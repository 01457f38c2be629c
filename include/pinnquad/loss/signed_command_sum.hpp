// SPDX-License-Identifier: MIT
// The two series of a batch that Sec. 4.2 compares about one axis: the signed sum of predicted commands, a row of Eq. (2), and
// the angular acceleration.
#pragma once

#include "pinnquad/loss/loss.hpp"

namespace pinnquad {

/// Both series over the samples of a batch, and how the first depends on the predictions. No heap.
template <class Axis, class Context, class Batch>
struct SignedCommandSum {
  static_assert(
      Context::Features::angular_acceleration >= 0,
      "pinnquad: LocalMonotonicity and PearsonCorrelation need a feature set that holds the angular accelerations");
  using Scalar = typename Batch::Scalar;
  using Array = Eigen::Array<Scalar, Eigen::Dynamic, 1, int(Eigen::ColMajor) | int(Eigen::DontAlign), Batch::max_size>;
  using Slope = Eigen::Array<Scalar, rotor_count, Eigen::Dynamic, int(Eigen::ColMajor) | int(Eigen::DontAlign),
                             rotor_count, Batch::max_size>;

  Array commands;              ///< m: sum of sign_i u_i with the allocation's signs, divided by `spread`
  Slope slope;                 ///< d m / d standardised prediction
  Array angular_acceleration;  ///< n: standardised, as the network is given it

  SignedCommandSum(const Context& context, const Batch& batch, Scalar spread)
      : commands(Array::Zero(batch.prediction.cols())), slope(rotor_count, batch.prediction.cols()) {
    constexpr Airframe<Scalar> airframe = airframe_value<typename Context::Vehicle, Scalar>();
    constexpr std::array<Scalar, rotor_count> signs = allocation_signs(airframe, Axis::axis);
    for (Eigen::Index sample = 0; sample < commands.size(); ++sample) {
      for (std::size_t i = 0; i < rotor_count; ++i) {
        const Scalar scale = Scalar(context.output.spread[i]);
        const Scalar output =
            batch.prediction(static_cast<Eigen::Index>(i), sample) * scale + Scalar(context.output.mean[i]);
        const Scalar sign = signs[i] / spread;
        commands[sample] += sign * Context::Outputs::command(output, airframe);
        slope(static_cast<Eigen::Index>(i), sample) = sign * scale * Context::Outputs::command_slope(output, airframe);
      }
    }
    angular_acceleration = batch.features.row(Context::Features::angular_acceleration + Axis::axis).transpose().array();
  }

  /// Adds dL/d prediction, given dL/dm.
  template <class Gradient>
  void add_gradient(const Array& by_commands, Gradient& gradient) const {
    gradient.array() += slope.rowwise() * by_commands.transpose();
  }
};

}  // namespace pinnquad
