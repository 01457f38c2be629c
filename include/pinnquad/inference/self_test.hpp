// SPDX-License-Identifier: MIT
// Replays a model's golden vectors: at boot, before the first command goes to a motor.
#pragma once

#include <cstddef>

#include "pinnquad/inference/inverse_dynamics.hpp"

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

template <class Scalar, std::size_t Columns, std::size_t Rows>
PINNQUAD_ALWAYS_INLINE int row_count(const std::array<std::array<Scalar, Columns>, Rows>&) noexcept {
  return static_cast<int>(Rows);
}
template <class AnyRows>
PINNQUAD_ALWAYS_INLINE int row_count(const AnyRows& rows) noexcept {
  return static_cast<int>(rows.size());
}

/// A golden vector, from the rows of a header or of a block.
template <class Scalar, std::size_t Columns, std::size_t Rows, std::size_t Size>
PINNQUAD_ALWAYS_INLINE void copy_row(const std::array<std::array<Scalar, Columns>, Rows>& rows, std::size_t row,
                                     Scalar (&to)[Size]) noexcept {
  static_assert(Columns == Size);
  if constexpr (Rows > 0) {
    const Scalar* from = first_of<Scalar>(rows) + row * Columns;
    for (std::size_t i = 0; i < Size; ++i) to[i] = from[i];
  }
}
template <class AnyRows, class Scalar, std::size_t Size>
PINNQUAD_ALWAYS_INLINE void copy_row(const AnyRows& rows, std::size_t row, Scalar (&to)[Size]) noexcept {
  const auto kept = rows[row];
  const Scalar* from = first_of<Scalar>(kept);
  for (std::size_t i = 0; i < Size; ++i) to[i] = from[i];
}

/// True if no scaler, no border of the envelope and no weight, as it is shown or as the vector unit reads it, is NaN or
/// infinite.
template <class Model>
bool numbers_finite(const Model& model) noexcept {
  constexpr int size = Model::Features::size;
  const Scales<typename Model::Scalar> scales = scales_of(model);
  bool finite = all_finite(scales.lower, size) && all_finite(scales.upper, size);
  finite &= all_finite(scales.input_mean, size) && all_finite(scales.input_deviation, size);
  finite &= all_finite(scales.output_mean, Model::Network::outputs);
  finite &= all_finite(scales.output_deviation, Model::Network::outputs);
  if constexpr (may_be_packed<Model>) {
    const auto* const packed = packed_weights(model);
    finite &= packed == nullptr || packed->finite();
  }
  if constexpr (model_kind<Model> != ModelKind::function) {
    const typename Model::Scalar* weights = row_major_weights(model);
    finite &= weights == nullptr || all_finite(weights, Model::Network::parameter_count);
  }
  return finite;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// Ok if the network by itself, whatever the guard, reproduces every golden command within golden_tolerance, every
/// golden vector lies in the envelope, and every weight, scaler and border of the envelope is a number. Else
/// `self_test_failed`: a wrong kernel, compiler flag or bit in flash, or no golden vector. Every NaN and infinity is
/// found, under -ffast-math too, where a prediction may lose it. A wrong bit of a weight is found if it moves a golden
/// command by more than the tolerance; smaller ones are for a checksum to find.
template <class Model, class Guard>
Status self_test(const InverseDynamics<Model, Guard>& inverse) noexcept {
  using Scalar = typename Model::Scalar;
  const Model& model = inverse.model();
  const int vectors = detail::row_count(model.golden_features);
  bool sound = vectors > 0;
  for (int vector = 0; vector < vectors; ++vector) {
    const auto index = static_cast<std::size_t>(vector);
    Scalar x[Model::Features::size], golden[rotor_count], commands[rotor_count];
    detail::copy_row(model.golden_features, index, x);
    detail::copy_row(model.golden_commands, index, golden);
    inverse.evaluate(x, commands);
    sound &= inverse.inside_envelope(x);
    for (int rotor = 0; rotor < rotor_count; ++rotor) {
      const Scalar difference = commands[rotor] - golden[rotor];
      const Scalar magnitude = difference < Scalar(0) ? -difference : difference;
      // asked on the bits: -ffast-math has no NaN
      sound &= is_finite(magnitude) && magnitude <= Scalar(golden_tolerance);
    }
  }
  return sound && detail::numbers_finite(model) ? Status::ok : Status::self_test_failed;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
