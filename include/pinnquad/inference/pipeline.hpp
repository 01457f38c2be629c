// SPDX-License-Identifier: MIT
// From features to commands, written once: for a prediction, a batch, the Jacobian, the trainer's judgement.
//   features x -> (x - mean) / deviation -> network -> y = deviation z + mean -> the schema's g(x, y) = commands
// Physical units outside, standardised ones around the network. Of several samples, entry k of sample s stands at
// [k * stride + s]; the network takes `Lanes` of them side by side.
#pragma once

#include "pinnquad/core/first_of.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/exported/model.hpp"
#include "pinnquad/features/extra_columns.hpp"
#include "pinnquad/model/predictor.hpp"
#include "pinnquad/outputs/output_schema.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// The weights as the network lays them out: in flash, in a block or in the instance. Null for a view of no block.
template <class Model>
PINNQUAD_ALWAYS_INLINE const typename Model::Scalar* row_major_weights(const Model& model) noexcept {
  static_assert(model_kind<Model> != ModelKind::function,
                "pinnquad: this model shows no weights; its kind is ModelKind::function (exported/model.hpp)");
  if constexpr (model_kind<Model> >= ModelKind::view) {
    return model.parameters();
  } else if constexpr (model_kind<Model> == ModelKind::header) {
    constexpr const typename Model::Scalar* first = Model::parameters.data();
    return first;
  } else {
    return first_of<typename Model::Scalar>(model.parameters);
  }
}

/// Scalers and envelope. A header's are constants of the compiler, at -O0 too; others are read through the instance.
template <class Model>
PINNQUAD_ALWAYS_INLINE Scales<typename Model::Scalar> scales_of([[maybe_unused]] const Model& model) noexcept {
  using Scalar = typename Model::Scalar;
  if constexpr (model_kind<Model> == ModelKind::header) {
    constexpr Scales<Scalar> constants = scales_in_header<Model>();
    return constants;
  } else {
    return {first_of<Scalar>(model.input.mean),     first_of<Scalar>(model.input.standard_deviation),
            first_of<Scalar>(model.output.mean),    first_of<Scalar>(model.output.standard_deviation),
            first_of<Scalar>(model.envelope_lower), first_of<Scalar>(model.envelope_upper)};
  }
}

/// `count` samples, 1 to `Lanes`; padding repeats the last one. Its loop starts at 0: of one from a constant `count`
/// g++ 12 warns that its index overflows.
template <int Size, int Lanes, class Scalar>
PINNQUAD_ALWAYS_INLINE void standardise(const Scalar* mean, const Scalar* deviation, const Scalar* values, int stride,
                                        int count, Scalar* standardised) noexcept {
  for (int i = 0; i < Size; ++i) {
    const Scalar middle = mean[i], scale = deviation[i];
    const Scalar* from = values + i * stride;
    Scalar* to = standardised + i * Lanes;
    for (int s = 0; s < count; ++s) to[s] = (from[s] - middle) / scale;
    for (int s = 0; s < Lanes - count; ++s) to[count + s] = to[count - 1];
  }
}

/// Standardised columns outside their range of the training rows are moved to its edge: a battery's voltage changes
/// slowly and asks for no motion, so that the commands at the edge are the best that the model knows.
template <class Features, int Lanes, class Scalar>
PINNQUAD_ALWAYS_INLINE void saturate_columns([[maybe_unused]] const Scales<Scalar>& scales,
                                             [[maybe_unused]] Scalar* standardised) noexcept {
  if constexpr (extra_column_names<Features>.size() > 0) {
    for (int i = 0; i < Features::size; ++i) {
      if (!is_column<Features>(i)) continue;
      for (Scalar* value = standardised + i * Lanes; value < standardised + (i + 1) * Lanes; ++value) {
        *value = saturated(scales, i, *value);
      }
    }
  }
}

/// That line for models with these features, outputs and airframe. `forward(standardised, outputs)` is the network.
template <class Features, class Outputs, class Vehicle>
struct Pipeline {
  using Map = OutputMap<Outputs>;
  /// The schema's argument `setting`, where the compiler knows the airframe; static: no copy on the stack.
  template <class Scalar>
  static constexpr auto own_setting = Map::setting(airframe_value<Vehicle, Scalar>());
  template <class Scalar>
  using Setting = decltype(Map::setting(std::declval<const Airframe<Scalar>&>()));

  /// Runs one sample: outputs in physical units, and the commands that they mean.
  template <class Scalar, class Forward>
  static PINNQUAD_ALWAYS_INLINE void run(const Scales<Scalar>& scales, const Scalar* x, Scalar* outputs,
                                         Scalar* commands, const Forward& forward,
                                         const Setting<Scalar>& setting = own_setting<Scalar>) noexcept {
    ask<1>(scales, x, 1, 1, outputs, forward);
    command(scales, x, 1, static_cast<const Scalar*>(outputs), 1, outputs, commands, setting);
  }

  /// The commands of features that the caller has done with: they are standardised where they stand, unless the schema
  /// reads them too. The network answers where the commands will be. Takes less of the stack.
  template <class Scalar, class Forward>
  static PINNQUAD_ALWAYS_INLINE void run_over(const Scales<Scalar>& scales, Scalar* x, Scalar* commands,
                                              const Forward& forward) noexcept {
    if constexpr (Map::takes_features || Map::size > rotor_count) {
      Scalar outputs[Map::size] = {};
      run(scales, static_cast<const Scalar*>(x), static_cast<Scalar*>(outputs), commands, forward);
    } else {
      const Scalar* const seen = x;
      standardise<Features::size, 1>(scales.input_mean, scales.input_deviation, seen, 1, 1, x);
      saturate_columns<Features, 1>(scales, x);
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
    standardise<Features::size, Lanes>(scales.input_mean, scales.input_deviation, x, x_stride, count, standardised);
    saturate_columns<Features, Lanes>(scales, static_cast<Scalar*>(standardised));
    forward(static_cast<const Scalar*>(standardised), answers);
  }

  /// The schema's share, of one sample: its outputs in physical units, which may overwrite its answers, and commands.
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void command(const Scales<Scalar>& scales, const Scalar* x, int x_stride,
                                             const Scalar* answers, int stride, Scalar* outputs, Scalar* commands,
                                             const Setting<Scalar>& setting = own_setting<Scalar>) noexcept {
    if constexpr (Map::rotor_by_rotor) {  // one loop for both is less code in flash
      for (int i = 0; i < rotor_count; ++i) {
        outputs[i] = answers[i * stride] * scales.output_deviation[i] + scales.output_mean[i];
        commands[i] = Map::command(outputs[i], setting, static_cast<std::size_t>(i));
      }
    } else {
      for (int i = 0; i < Map::size; ++i)
        outputs[i] = answers[i * stride] * scales.output_deviation[i] + scales.output_mean[i];
      Scalar features[Features::size];
      if (x_stride != 1) {
        for (int k = 0; k < Features::size; ++k) features[k] = x[k * x_stride];
      }
      Map::commands(x_stride != 1 ? static_cast<const Scalar*>(features) : x, static_cast<const Scalar*>(outputs),
                    setting, commands);
    }
  }

  /// jacobian = du/dx in physical units from `slopes`, the network's derivatives between standardised values
  /// (Map::size x Features::size), at features and outputs in physical units.
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void chain(const Scales<Scalar>& scales, const Scalar* x, const Scalar* outputs,
                                           const Scalar* slopes, Scalar* jacobian) noexcept {
    constexpr int size = Features::size;
    constexpr const Setting<Scalar>& setting = own_setting<Scalar>;
    Scalar by_outputs[Map::slope_count];
    Map::slopes(x, outputs, setting, by_outputs);
    for (int i = 0; i < rotor_count * size; ++i) jacobian[i] = Scalar(0);
    if constexpr (Map::has_feature_slopes) Map::template feature_slopes<size>(x, outputs, setting, jacobian);
    for (int i = 0; i < rotor_count; ++i) {
      for (int j = Map::first_output(i); j < Map::last_output(i); ++j) {
        const Scalar slope = by_outputs[Map::slope_index(i, j)] * scales.output_deviation[j];
        for (int k = 0; k < size; ++k)
          jacobian[i * size + k] += slopes[j * size + k] * (slope / scales.input_deviation[k]);
      }
    }
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
