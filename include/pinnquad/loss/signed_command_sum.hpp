// SPDX-License-Identifier: MIT
// The two series of a batch that Sec. 4.2 compares about one axis: the signed sum of predicted commands, a row of Eq.
// (2), and the angular acceleration.
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
  using Map = OutputMap<typename Context::Outputs>;
  using Slope = Eigen::Array<Scalar, Map::size, Eigen::Dynamic, int(Eigen::ColMajor) | int(Eigen::DontAlign), Map::size,
                             Batch::max_size>;

  Array commands;              ///< m: sum of sign_i u_i with the allocation's signs, divided by `divisor`
  Slope slope;                 ///< d m / d standardised prediction
  Array angular_acceleration;  ///< n: standardised, as the network is given it

  SignedCommandSum(const Context& context, const Batch& batch, Scalar divisor)
      : commands(Array::Zero(batch.prediction.cols())), slope(Slope::Zero(Map::size, batch.prediction.cols())) {
    const std::array<Scalar, rotor_count> signs = context.template signs<Axis, Scalar>();
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
      for (int k = 0; k < Map::size; ++k)
        outputs[k] = batch.prediction(k, sample) * scale(context, k) + mean(context, k);
      const Scalar* features = Map::takes_features ? static_cast<const Scalar*>(x) : nullptr;
      Map::commands(features, static_cast<const Scalar*>(outputs), setting, u);
      Map::slopes(features, static_cast<const Scalar*>(outputs), setting, by_outputs);
      for (int i = 0; i < rotor_count; ++i) {
        const Scalar sign = signs[static_cast<std::size_t>(i)] / divisor;
        commands[sample] += sign * u[i];
        for (int k = Map::first_output(i); k < Map::last_output(i); ++k) {
          slope(k, sample) += sign * scale(context, k) * by_outputs[Map::slope_index(i, k)];
        }
      }
    }
    angular_acceleration = batch.features.row(Context::Features::angular_acceleration + Axis::axis).transpose().array();
  }

  /// Adds dL/d prediction, given dL/dm.
  template <class Gradient>
  void add_gradient(const Array& by_commands, Gradient& gradient) const {
    gradient.array() += slope.rowwise() * by_commands.transpose();
  }

 private:
  static Scalar scale(const Context& context, int output) {
    return Scalar(context.output.standard_deviation[static_cast<std::size_t>(output)]);
  }
  static Scalar mean(const Context& context, int output) {
    return Scalar(context.output.mean[static_cast<std::size_t>(output)]);
  }
};

}  // namespace pinnquad
