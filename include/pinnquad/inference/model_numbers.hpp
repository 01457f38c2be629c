// SPDX-License-Identifier: MIT
// Where a model's weights, scalers and envelope are: constants of the compiler for an exported header, else read through the
// instance.
// Plain pointers (core/first_of.hpp).
#pragma once

#include <type_traits>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/first_of.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/inference/pipeline.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// True if all of them are static members; a data member's address is a pointer to member.
template <class Model, class = void>
struct HasConstantArrays : std::false_type {};
template <class Model>
struct HasConstantArrays<Model, std::void_t<decltype(&Model::envelope_lower), decltype(&Model::envelope_upper),
                                            decltype(&Model::input), decltype(&Model::output)>>
    : std::bool_constant<std::is_pointer_v<decltype(&Model::envelope_lower)> &&
                         std::is_pointer_v<decltype(&Model::envelope_upper)> &&
                         std::is_pointer_v<decltype(&Model::input)> && std::is_pointer_v<decltype(&Model::output)>> {};

template <class Model, class = void>
struct HasOwnForward : std::false_type {};
template <class Model>
struct HasOwnForward<
    Model, std::void_t<decltype(std::declval<const Model&>().forward(
               static_cast<const typename Model::Scalar*>(nullptr), static_cast<typename Model::Scalar*>(nullptr)))>>
    : std::true_type {};

template <class Model, class = void>
struct HasParametersInBlock : std::false_type {};
template <class Model>
struct HasParametersInBlock<Model,
                            std::enable_if_t<std::is_pointer_v<decltype(std::declval<const Model&>().parameters())>>>
    : std::true_type {};

template <class Model, class = void>
struct HasConstantParameters : std::false_type {};
template <class Model>
struct HasConstantParameters<Model, std::enable_if_t<std::is_pointer_v<decltype(&Model::parameters)>>>
    : std::bool_constant<!HasParametersInBlock<Model>::value> {};

/// Models that keep neither parameters nor parameters(): with a forward() alone.
template <class Model, class = void>
struct ShowsWeights : HasParametersInBlock<Model> {};
template <class Model>
struct ShowsWeights<Model, std::enable_if_t<std::is_object_v<decltype(Model::parameters)>>> : std::true_type {};

/// The weights as the network lays them out: in flash, in a block or in the instance. Null for a view of no block.
template <class Model>
PINNQUAD_ALWAYS_INLINE const typename Model::Scalar* row_major_weights(const Model& model) noexcept {
  static_assert(ShowsWeights<Model>::value,
                "pinnquad: this model shows no weights; it needs an array `parameters` or a function `parameters()`");
  if constexpr (HasParametersInBlock<Model>::value) {
    return model.parameters();
  } else if constexpr (HasConstantParameters<Model>::value) {
    constexpr const typename Model::Scalar* first = Model::parameters.data();
    return first;
  } else {
    return first_of<typename Model::Scalar>(model.parameters);
  }
}

/// Read through the instance.
template <class Model, bool Constant = HasConstantArrays<Model>::value>
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
struct ModelNumbers<Model, true> {
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
