// SPDX-License-Identifier: MIT
// From features to commands, written once for whoever asks: a prediction, a batch, the Jacobian, the trainer's model.
//   features x -> (x - mean) / spread -> network -> y = spread z + mean -> the schema's g(x, y) = commands
// Physical units outside, standardised ones around the network. Of several samples, entry k of sample s stands at
// [k * stride + s]; the network takes `Lanes` of them side by side.
#pragma once

#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/outputs/output_schema.hpp"

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

/// `count` samples, 1 to `Lanes`; padding repeats the last one. Its loop starts at 0: of one from a constant `count` g++ 12
/// warns that its index overflows.
template <int Size, int Lanes, class Scalar>
PINNQUAD_ALWAYS_INLINE void standardise(const Scalar* mean, const Scalar* spread, const Scalar* values, int stride,
                                        int count, Scalar* standardised) noexcept {
  for (int i = 0; i < Size; ++i) {
    const Scalar middle = mean[i], scale = spread[i];
    const Scalar* from = values + i * stride;
    Scalar* to = standardised + i * Lanes;
    for (int s = 0; s < count; ++s) to[s] = (from[s] - middle) / scale;
    for (int s = 0; s < Lanes - count; ++s) to[count + s] = to[count - 1];
  }
}

/// The line above for models with these features, outputs and airframe. `forward(standardised, outputs)` is the network.
template <class Features, class Outputs, class Vehicle>
struct Pipeline {
  using Map = OutputMap<Outputs>;

  /// Of one sample: outputs in physical units, and the commands that they mean.
  template <class Scalar, class Forward>
  static PINNQUAD_ALWAYS_INLINE void run(const Scales<Scalar>& scales, const Scalar* x, Scalar* outputs,
                                         Scalar* commands, const Forward& forward) noexcept {
    ask<1>(scales, x, 1, 1, outputs, forward);
    command(scales, x, 1, static_cast<const Scalar*>(outputs), 1, outputs, commands);
  }

  /// The commands of features that the caller has done with: standardised where they stand, if the schema does not want them too.
  /// The network answers where the commands will be. Less of the stack.
  template <class Scalar, class Forward>
  static PINNQUAD_ALWAYS_INLINE void run_over(const Scales<Scalar>& scales, Scalar* x, Scalar* commands,
                                              const Forward& forward) noexcept {
    if constexpr (Map::takes_features || Map::size > rotor_count) {
      Scalar outputs[Map::size] = {};
      run(scales, static_cast<const Scalar*>(x), static_cast<Scalar*>(outputs), commands, forward);
    } else {
      const Scalar* const seen = x;
      standardise<Features::size, 1>(scales.input_mean, scales.input_spread, seen, 1, 1, x);
      forward(seen, commands);
      if constexpr (Map::rotor_by_rotor) {
        command(scales, seen, 1, static_cast<const Scalar*>(commands), 1, commands, commands);
      } else {
        Scalar outputs[Map::size];
        command(scales, seen, 1, static_cast<const Scalar*>(commands), 1, static_cast<Scalar*>(outputs), commands);
      }
    }
  }

  /// The network's share: `Lanes` samples' outputs, standardised, of `count` samples' features.
  template <int Lanes, class Scalar, class Forward>
  static PINNQUAD_ALWAYS_INLINE void ask(const Scales<Scalar>& scales, const Scalar* x, int x_stride, int count,
                                         Scalar* answers, const Forward& forward) noexcept {
    alignas(Lanes > 1 ? 64 : alignof(Scalar)) Scalar standardised[Features::size * Lanes];
    standardise<Features::size, Lanes>(scales.input_mean, scales.input_spread, x, x_stride, count, standardised);
    forward(static_cast<const Scalar*>(standardised), answers);
  }

  /// The schema's share, of one sample: its outputs in physical units, which may overwrite its answers, and its commands.
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void command(const Scales<Scalar>& scales, const Scalar* x, int x_stride,
                                             const Scalar* answers, int stride, Scalar* outputs,
                                             Scalar* commands) noexcept {
    static constexpr auto setting = Map::setting(airframe_value<Vehicle, Scalar>());  // static: no copy on the stack
    if constexpr (Map::rotor_by_rotor) {  // one loop for both is less code in flash
      for (int i = 0; i < rotor_count; ++i) {
        outputs[i] = answers[i * stride] * scales.output_spread[i] + scales.output_mean[i];
        commands[i] = Map::command(outputs[i], setting, i);
      }
    } else {
      for (int i = 0; i < Map::size; ++i)
        outputs[i] = answers[i * stride] * scales.output_spread[i] + scales.output_mean[i];
      Scalar features[Features::size];
      if (x_stride != 1) {
        for (int k = 0; k < Features::size; ++k) features[k] = x[k * x_stride];
      }
      Map::commands(x_stride != 1 ? static_cast<const Scalar*>(features) : x, static_cast<const Scalar*>(outputs),
                    setting, commands);
    }
  }

  /// jacobian = du/dx in physical units from `slopes`, the network's derivatives between standardised values (Map::size x
  /// Features::size), at features and outputs in physical units.
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void chain(const Scales<Scalar>& scales, const Scalar* x, const Scalar* outputs,
                                           const Scalar* slopes, Scalar* jacobian) noexcept {
    constexpr int size = Features::size;
    static constexpr auto setting = Map::setting(airframe_value<Vehicle, Scalar>());  // static: no copy on the stack
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
