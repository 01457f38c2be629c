// SPDX-License-Identifier: MIT
// A model's weights, scalers and envelope as plain pointers (core/first_of.hpp): constants of the compiler for an exported
// header, else read through the instance.
#pragma once

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/first_of.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/exported/model.hpp"
#include "pinnquad/inference/pipeline.hpp"

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

/// Read through the instance.
template <class Model, ModelKind = model_kind<Model>>
struct ModelNumbers {
  using Scalar = typename Model::Scalar;
  using Pointer = const Scalar*;
  static PINNQUAD_ALWAYS_INLINE Pointer lower(const Model& model) noexcept {
    return first_of<Scalar>(model.envelope_lower);
  }
  static PINNQUAD_ALWAYS_INLINE Pointer upper(const Model& model) noexcept {
    return first_of<Scalar>(model.envelope_upper);
  }
  static PINNQUAD_ALWAYS_INLINE Scales<Scalar> scales(const Model& model) noexcept {
    return {first_of<Scalar>(model.input.mean), first_of<Scalar>(model.input.standard_deviation),
            first_of<Scalar>(model.output.mean), first_of<Scalar>(model.output.standard_deviation)};
  }
};

/// Constants: a local constexpr pointer is worked out by the compiler, at -O0 too.
template <class Model>
struct ModelNumbers<Model, ModelKind::header> {
  using Pointer = const typename Model::Scalar*;
  static PINNQUAD_ALWAYS_INLINE Pointer lower(const Model&) noexcept {
    constexpr Pointer first = Model::envelope_lower.data();
    return first;
  }
  static PINNQUAD_ALWAYS_INLINE Pointer upper(const Model&) noexcept {
    constexpr Pointer first = Model::envelope_upper.data();
    return first;
  }
  static PINNQUAD_ALWAYS_INLINE Scales<typename Model::Scalar> scales(const Model&) noexcept {
    constexpr Pointer input_mean = Model::input.mean.data(), input_spread = Model::input.standard_deviation.data();
    constexpr Pointer output_mean = Model::output.mean.data(), output_spread = Model::output.standard_deviation.data();
    return {input_mean, input_spread, output_mean, output_spread};
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
