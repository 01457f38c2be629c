// SPDX-License-Identifier: MIT
// A residual wrench that was learnt (study/wrench_fit.hpp): a small network from the air's velocity, body rates and
// rotor state to force / mass and angular acceleration. An ordinary exported model: features as below, and as outputs
// what the rotors would have to make against it (AccelerationOutputs), so that its block and header are as any other's.
#pragma once

#include <cstddef>

#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/inference/pipeline.hpp"
#include "pinnquad/nn/kernel/portable.hpp"
#include "pinnquad/nn/network.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "pinnquad/outputs/wrench_outputs.hpp"
#include "study/wrench_inverse.hpp"

namespace study {

using namespace pinnquad;

/// The commands of a rotor behind its lag, in the order of the commands.
struct RotorState1 {
  static constexpr const char* name = "rotor_1";
  static constexpr const char* unit = "1";
};
/// The same of another rotor.
struct RotorState2 {
  static constexpr const char* name = "rotor_2";
  static constexpr const char* unit = "1";
};
/// The same of another rotor.
struct RotorState3 {
  static constexpr const char* name = "rotor_3";
  static constexpr const char* unit = "1";
};
/// The same of another rotor.
struct RotorState4 {
  static constexpr const char* name = "rotor_4";
  static constexpr const char* unit = "1";
};

/// X of a wrench network: velocity through the air, body rates, rotors.
using WrenchFeatures = WithColumns<Joined<BodyVelocity, BodyRates>, RotorState1, RotorState2, RotorState3, RotorState4>;

/// Two layers of 32 are enough, and a smooth activation has a smooth Jacobian.
using WrenchNet =
    Mlp<float, InputSize<WrenchFeatures::size>, Hidden<2, 32>, OutputSize<AccelerationOutputs::size>, Tanh>;

/// A residual wrench (study/wrench_inverse.hpp) by a model's numbers, which must stay where they are. Inputs are
/// moved into the envelope of the training rows.
template <class Network>
class WrenchNetwork {
  using Number = typename Network::Scalar;
  static constexpr int inputs = Network::inputs, outputs = Network::outputs;
  static_assert(inputs == WrenchFeatures::size && outputs == AccelerationOutputs::size,
                "pinnquad: a wrench network has the inputs of WrenchFeatures and the outputs of AccelerationOutputs");

 public:
  WrenchNetwork(const pinnquad::detail::Scales<Number>& scales, const Number* parameters) noexcept
      : scales_(scales), parameters_(parameters) {}

  template <class Scalar>
  Accelerations<Scalar> operator()(const WrenchInputs<Scalar>& in) const noexcept {
    Number x[static_cast<std::size_t>(inputs)], y[static_cast<std::size_t>(outputs)];
    standardise(in, x);
    Network::forward(parameters_, static_cast<const Number*>(x), static_cast<Number*>(y));
    Accelerations<Scalar> result;
    for (int i = 0; i < 3; ++i) {
      result.linear_m_s2[i] = -restored<Scalar>(y, i);
      result.angular_rad_s2[i] = -restored<Scalar>(y, 3 + i);
    }
    return result;
  }

  /// The force / mass, and how it changes with the air's velocity, both body; flat beyond the envelope.
  template <class Scalar>
  Vector3<Scalar> force_and_slope(const WrenchInputs<Scalar>& in, Matrix<Scalar, 3, 3>& by_velocity) const noexcept {
    Number x[static_cast<std::size_t>(inputs)];
    const unsigned moved = standardise(in, static_cast<Number*>(x));
    Carried values[2][Network::widest] = {};
    for (int i = 0; i < inputs; ++i) {
      values[0][i].of[0] = x[i];
      if (i < 3) values[0][i].of[1 + i] = Number(1);
    }
    const Carried* const made = carry<0>(static_cast<Carried*>(values[0]), static_cast<Carried*>(values[1]));
    Vector3<Scalar> force;
    for (int i = 0; i < 3; ++i) {
      force[i] = -Scalar(made[i].of[0] * scales_.output_deviation[i] + scales_.output_mean[i]);
      for (int k = 0; k < 3; ++k) {
        const Number slope = -made[i].of[1 + k] * scales_.output_deviation[i] / scales_.input_deviation[k];
        by_velocity(i, k) = (moved >> static_cast<unsigned>(k) & 1u) != 0 ? Scalar(0) : Scalar(slope);
      }
    }
    return force;
  }

 private:
  /// A value, and its derivatives by three inputs: forward through the network they cost four passes of its sums and
  /// one of its activations.
  struct Carried {
    Number of[4];
  };
  template <int Index>
  const Carried* carry(Carried* from, Carried* to) const noexcept {
    using Layer = typename Network::template Layer<Index>;
    if constexpr (is_elementwise<Layer>) {
      for (int i = 0; i < Layer::outputs; ++i) {
        const Number value = from[i].of[0], made = Layer::activate(value);
        const Number slope = pinnquad::detail::slope_at<Layer>(slopes_from_input<Layer> ? value : made);
        to[i] = {{made, slope * from[i].of[1], slope * from[i].of[2], slope * from[i].of[3]}};
      }
    } else {
      static_assert(pinnquad::detail::is_dense_with_bias<Layer>,
                    "pinnquad: a wrench network has dense layers and activations alone");
      const Number* const weights = parameters_ + Network::Sizes::offset(Index);
      const Number* const biases = weights + Layer::inputs * Layer::outputs;
      for (int row = 0; row < Layer::outputs; ++row) {
        Number value = biases[row], by_x(0), by_y(0), by_z(0);  // apart, so that they stay in registers
        for (int column = 0; column < Layer::inputs; ++column) {
          const Number weight = weights[row * Layer::inputs + column];
          const Carried& before = from[column];
          value = multiply_add(weight, before.of[0], value);
          by_x = multiply_add(weight, before.of[1], by_x);
          by_y = multiply_add(weight, before.of[2], by_y);
          by_z = multiply_add(weight, before.of[3], by_z);
        }
        to[row] = {{value, by_x, by_y, by_z}};
      }
    }
    if constexpr (Index + 1 < Network::layer_count) {
      return carry<Index + 1>(to, from);
    } else {
      return to;
    }
  }

  /// Bit i of the result: input i was moved.
  template <class Scalar>
  unsigned standardise(const WrenchInputs<Scalar>& in, Number* x) const noexcept {
    for (int i = 0; i < 3; ++i) {
      x[i] = Number(in.air_velocity_m_s[i]);
      x[3 + i] = Number(in.body_rates_rad_s[i]);
    }
    for (int i = 0; i < rotor_count; ++i) x[6 + i] = Number(in.rotors[static_cast<std::size_t>(i)]);
    unsigned moved = 0;
    for (int i = 0; i < inputs; ++i) {
      const Number asked = (x[i] - scales_.input_mean[i]) / scales_.input_deviation[i];
      x[i] = pinnquad::detail::saturated(scales_, i, asked);
      if (x[i] < asked || asked < x[i]) moved |= 1u << static_cast<unsigned>(i);
    }
    return moved;
  }
  template <class Scalar>
  Scalar restored(const Number* y, int i) const noexcept {
    return Scalar(y[i] * scales_.output_deviation[i] + scales_.output_mean[i]);
  }

  pinnquad::detail::Scales<Number> scales_;
  const Number* parameters_;
};

}  // namespace study
