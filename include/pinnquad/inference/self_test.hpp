// SPDX-License-Identifier: MIT
// Replays a model's golden vectors: at boot, before the first command goes to a motor.
#pragma once

#include <cstddef>

#include "pinnquad/inference/inverse_dynamics.hpp"

namespace pinnquad {

inline namespace PINNQUAD_INSTRUCTION_SET {

/// Where a self test failed, or how far it was from failing.
template <class Scalar>
struct SelfTestReport {
  Status cause{Status::ok};  ///< `self_test_failed`: off by more than golden_tolerance; `output_not_finite`;
                             ///< `outside_envelope`: the golden vector is not one that predict() would answer;
                             ///< `not_finite`: all were reproduced, but a number of the model is NaN or infinite
  int vector{-1};  ///< the first golden vector that failed, in a sound model the one furthest off; -1 if it has none
  int rotor{-1};   ///< its command furthest off, -1 if none is off at all
  Scalar largest_difference{0};  ///< |command - golden command| there; not finite if the command is not
  int weight{-1};  ///< the first weight that is NaN or infinite, as the network lays them out; -1 if none is
};

}  // namespace PINNQUAD_INSTRUCTION_SET

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

/// The model's first weight that is NaN or infinite, -1 if it has none or shows none.
template <class Model>
int first_broken_weight(const Model& model) noexcept {
  if constexpr (model_kind<Model> != ModelKind::function) {
    const typename Model::Scalar* weights = row_major_weights(model);
    for (int i = 0; weights != nullptr && i < Model::Network::parameter_count; ++i) {
      if (!is_finite(weights[i])) return i;
    }
  }
  return -1;
}

/// True if no scaler, no border of the envelope and no weight as the vector unit reads it is NaN or infinite.
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
Status self_test(const InverseDynamics<Model, Guard>& inverse,
                 SelfTestReport<typename Model::Scalar>& report) noexcept {
  using Scalar = typename Model::Scalar;
  report = {};
  const Model& model = inverse.model();
  const int broken_weight = detail::first_broken_weight(model);
  const int vectors = detail::row_count(model.golden_features);
  if (vectors == 0) {
    report.cause = Status::self_test_failed;
    report.weight = broken_weight;
    return Status::self_test_failed;
  }
  for (int vector = 0; vector < vectors; ++vector) {
    const auto index = static_cast<std::size_t>(vector);
    Scalar x[Model::Features::size], golden[rotor_count], commands[rotor_count];
    detail::copy_row(model.golden_features, index, x);
    detail::copy_row(model.golden_commands, index, golden);
    inverse.evaluate(x, commands);
    SelfTestReport<Scalar> found{inverse.inside_envelope(x) ? Status::ok : Status::outside_envelope, vector};
    for (int rotor = 0; rotor < rotor_count; ++rotor) {
      const Scalar difference = commands[rotor] - golden[rotor];
      const Scalar magnitude = difference < Scalar(0) ? -difference : difference;
      // what is not finite outdoes every number; asked on the bits, for -ffast-math has no NaN
      const bool worse = !is_finite(magnitude) || magnitude > found.largest_difference;
      if (is_finite(found.largest_difference) && worse) {
        found.largest_difference = magnitude;
        found.rotor = rotor;
      }
    }
    if (!is_finite(found.largest_difference)) {
      found.cause = Status::output_not_finite;
    } else if (!(found.largest_difference <= Scalar(golden_tolerance))) {
      found.cause = Status::self_test_failed;
    }
    if (found.cause != Status::ok) {
      report = found;
      report.weight = broken_weight;
      return Status::self_test_failed;
    }
    if (vector == 0 || found.largest_difference > report.largest_difference) report = found;
  }
  if (broken_weight >= 0 || !detail::numbers_finite(model)) {
    report.cause = Status::not_finite;
    report.weight = broken_weight;
    return Status::self_test_failed;
  }
  return Status::ok;
}

/// The same without the report.
template <class Model, class Guard>
Status self_test(const InverseDynamics<Model, Guard>& inverse) noexcept {
  SelfTestReport<typename Model::Scalar> report;
  return self_test(inverse, report);
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
