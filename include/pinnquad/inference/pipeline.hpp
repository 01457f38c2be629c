// SPDX-License-Identifier: MIT
// From features to commands, written once for whoever asks: a prediction, a batch, the Jacobian, the trainer's model.
//   features x -> (x - mean) / spread -> network -> y = spread z + mean -> the schema's g(x, y) = commands
// Physical units outside, standardised ones around the network. `Lanes` samples side by side: entry k of sample s at
// [k * Lanes + s].
#pragma once

#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/inference/output_schema.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Where the scalers' numbers are.
template <class Scalar>
struct Scales {
  const Scalar* input_mean;
  const Scalar* input_spread;
  const Scalar* output_mean;
  const Scalar* output_spread;
};

template <int Size, int Lanes, class Scalar>
PINNQUAD_ALWAYS_INLINE void standardise(const Scalar* mean, const Scalar* spread, const Scalar* values,
                                        Scalar* standardised) noexcept {
  for (int i = 0; i < Size; ++i) {
    const Scalar middle = mean[i], scale = spread[i];
    for (int s = 0; s < Lanes; ++s) standardised[i * Lanes + s] = (values[i * Lanes + s] - middle) / scale;
  }
}

template <int Size, int Lanes, class Scalar>
PINNQUAD_ALWAYS_INLINE void restore(const Scalar* mean, const Scalar* spread, const Scalar* standardised,
                                    Scalar* values) noexcept {
  for (int i = 0; i < Size; ++i) {
    const Scalar middle = mean[i], scale = spread[i];
    for (int s = 0; s < Lanes; ++s) values[i * Lanes + s] = standardised[i * Lanes + s] * scale + middle;
  }
}

/// The line above for models with these features, outputs and airframe. `forward(standardised, outputs)` is the network.
template <class Features, class Outputs, class Vehicle>
struct Pipeline {
  using Map = OutputMap<Outputs>;

  /// Outputs in physical units.
  template <int Lanes, class Scalar, class Forward>
  static PINNQUAD_ALWAYS_INLINE void answer(const Scales<Scalar>& scales, const Scalar* x, Scalar* outputs,
                                            const Forward& forward) noexcept {
    alignas(Lanes > 1 ? 64 : alignof(Scalar)) Scalar standardised[Features::size * Lanes];
    standardise<Features::size, Lanes>(scales.input_mean, scales.input_spread, x, standardised);
    forward(static_cast<const Scalar*>(standardised), outputs);
    restore<Map::size, Lanes>(scales.output_mean, scales.output_spread, outputs, outputs);
  }

  /// The same, and the commands that they mean.
  template <int Lanes, class Scalar, class Forward>
  static PINNQUAD_ALWAYS_INLINE void run(const Scales<Scalar>& scales, const Scalar* x, Scalar* outputs,
                                         Scalar* commands, const Forward& forward) noexcept {
    answer<Lanes>(scales, x, outputs, forward);
    command<Lanes>(x, outputs, commands);
  }

  /// The schema's share.
  template <int Lanes, class Scalar>
  static PINNQUAD_ALWAYS_INLINE void command(const Scalar* x, const Scalar* outputs, Scalar* commands) noexcept {
    constexpr auto setting = Map::setting(airframe_value<Vehicle, Scalar>());
    if constexpr (Lanes == 1) {
      Map::commands(x, outputs, setting, commands);
    } else if constexpr (Map::slope_count == Map::size) {  // each command is of one output
      for (int i = 0; i < rotor_count; ++i) {
        for (int s = 0; s < Lanes; ++s) commands[i * Lanes + s] = Map::command(outputs[i * Lanes + s], setting);
      }
    } else {
      for (int s = 0; s < Lanes; ++s) {
        Scalar features[Features::size], sample[Map::size], made[rotor_count];
        if constexpr (Map::takes_features) {
          for (int k = 0; k < Features::size; ++k) features[k] = x[k * Lanes + s];
        }
        for (int k = 0; k < Map::size; ++k) sample[k] = outputs[k * Lanes + s];
        Map::commands(Map::takes_features ? static_cast<const Scalar*>(features) : nullptr,
                      static_cast<const Scalar*>(sample), setting, made);
        for (int i = 0; i < rotor_count; ++i) commands[i * Lanes + s] = made[i];
      }
    }
  }

  /// jacobian = du/dx in physical units from `slopes`, the network's derivatives between standardised values (Map::size x
  /// Features::size), at features and outputs in physical units.
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void chain(const Scales<Scalar>& scales, const Scalar* x, const Scalar* outputs,
                                           const Scalar* slopes, Scalar* jacobian) noexcept {
    constexpr int size = Features::size;
    constexpr auto setting = Map::setting(airframe_value<Vehicle, Scalar>());
    Scalar by_outputs[Map::slope_count];
    Map::slopes(x, outputs, setting, by_outputs);
    for (int i = 0; i < rotor_count * size; ++i) jacobian[i] = Scalar(0);
    if constexpr (Map::has_feature_slopes) Map::template feature_slopes<size>(x, outputs, setting, jacobian);
    for (int i = 0; i < rotor_count; ++i) {
      for (int j = Map::first_output(i); j < Map::last_output(i); ++j) {
        const Scalar slope = by_outputs[Map::slope_index(i, j)] * scales.output_spread[j];
        for (int k = 0; k < size; ++k)
          jacobian[i * size + k] += slopes[j * size + k] * (slope / scales.input_spread[k]);
      }
    }
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
