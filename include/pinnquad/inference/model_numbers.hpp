// SPDX-License-Identifier: MIT
// Where a model's scalers and envelope are: constants of the compiler for an exported header, else read through the instance.
// Plain pointers: std::array::operator[] is emitted out of line in an unoptimised build, where the linker could pick a copy
// compiled for another instruction set.
#pragma once

#include <type_traits>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/instruction_set.hpp"

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

/// Read through the instance.
template <class Model, bool Constant = HasConstantArrays<Model>::value>
struct ModelNumbers {
  using Pointer = const typename Model::Scalar*;
  static PINNQUAD_ALWAYS_INLINE Pointer lower(const Model& model) noexcept { return &model.envelope_lower[0]; }
  static PINNQUAD_ALWAYS_INLINE Pointer upper(const Model& model) noexcept { return &model.envelope_upper[0]; }
  static PINNQUAD_ALWAYS_INLINE Pointer input_mean(const Model& model) noexcept { return &model.input.mean[0]; }
  static PINNQUAD_ALWAYS_INLINE Pointer input_spread(const Model& model) noexcept { return &model.input.spread[0]; }
  static PINNQUAD_ALWAYS_INLINE Pointer output_mean(const Model& model) noexcept { return &model.output.mean[0]; }
  static PINNQUAD_ALWAYS_INLINE Pointer output_spread(const Model& model) noexcept { return &model.output.spread[0]; }
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
  static PINNQUAD_ALWAYS_INLINE Pointer input_mean(const Model&) noexcept {
    constexpr Pointer first = Model::input.mean.data();
    return first;
  }
  static PINNQUAD_ALWAYS_INLINE Pointer input_spread(const Model&) noexcept {
    constexpr Pointer first = Model::input.spread.data();
    return first;
  }
  static PINNQUAD_ALWAYS_INLINE Pointer output_mean(const Model&) noexcept {
    constexpr Pointer first = Model::output.mean.data();
    return first;
  }
  static PINNQUAD_ALWAYS_INLINE Pointer output_spread(const Model&) noexcept {
    constexpr Pointer first = Model::output.spread.data();
    return first;
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
