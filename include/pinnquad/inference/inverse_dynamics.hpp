// SPDX-License-Identifier: MIT
// What the control loop calls: predict() = check -> features -> envelope -> scale -> forward -> check.
// No state, no heap, bounded time; weights stay where the exported header put them.
#pragma once

#include "pinnquad/core/finite.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/inference/model.hpp"
#include "pinnquad/nn/packed_network.hpp"

namespace pinnquad {

namespace detail {
/// The model's weights as the vector unit wants them, packed by the compiler.
template <class Model>
inline constexpr PackedNetwork<typename Model::Network> packed_model{Model::parameters};
}  // namespace detail

/// An exported network as an inverse-dynamics model: motion wanted -> commands.
template <class ModelType>
class InverseDynamics {
  static_assert(require_model<ModelType>());

 public:
  using Model = ModelType;
  using Scalar = typename Model::Scalar;
  using Features = typename Model::Features;
  using Inputs = typename Features::template Inputs<Scalar>;
  using Network = typename Model::Network;

  /// Commands that make the motion asked for; not clipped to 0..1 (the rotor clips).
  /// `not_finite`, `not_unit_quaternion`: a bad input. `outside_envelope`: a feature beyond the training data.
  /// `output_not_finite`: the network's weights are broken. `commands` are untouched unless the Status is ok.
  Status predict(const Inputs& inputs, Commands<Scalar>& commands) const noexcept {
    const Status checked = Features::check(inputs);
    if (checked != Status::ok) return checked;
    Scalar x[Features::size];
    Features::extract(inputs, x);
    return predict_features(x, commands);
  }

  /// The same from a feature vector X, physical units.
  Status predict_features(const Scalar* x, Commands<Scalar>& commands) const noexcept {
    if (!inside_envelope(x)) return Status::outside_envelope;
    Scalar standardised[Features::size];
    Scalar outputs[rotor_count];
    Model::input.standardise(x, standardised);
    forward(standardised, outputs);
    Model::output.restore(outputs, outputs);
    constexpr Airframe<Scalar> airframe = airframe_value<typename Model::Vehicle, Scalar>();
    for (Scalar& v : outputs) v = Model::Outputs::command(v, airframe);
    if (!all_finite(outputs, rotor_count)) return Status::output_not_finite;
    for (std::size_t i = 0; i < rotor_count; ++i) commands[i] = outputs[i];
    return Status::ok;
  }

  /// True if every feature lies in what the model was trained on, margin included; false for NaN.
  static bool inside_envelope(const Scalar* x) noexcept {
    bool inside = true;
    for (std::size_t i = 0; i < static_cast<std::size_t>(Features::size); ++i) {
      inside &= x[i] >= Model::envelope_lower[i] && x[i] <= Model::envelope_upper[i];
    }
    return inside;
  }

  /// The bare network, standardised in and out: the vector unit's kernel where there is one, else the portable one.
  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* standardised, Scalar* outputs) noexcept {
    if constexpr (has_vector_unit<Scalar>) {
      detail::packed_model<Model>.forward(standardised, outputs);
    } else {
      Network::forward(Model::parameters.data(), standardised, outputs);
    }
  }
};

}  // namespace pinnquad
