// SPDX-License-Identifier: MIT
// Replays a model's golden vectors: at boot, before the first command goes to a motor.
#pragma once

#include "pinnquad/inference/inverse_dynamics.hpp"

namespace pinnquad {

/// Where a self test failed, or how far it was from failing.
template <class Scalar>
struct SelfTestReport {
  Status cause{Status::ok};  ///< `self_test_failed`: off by more than golden_tolerance; `output_not_finite`;
                             ///< `outside_envelope`: the golden vector is not one that predict() would answer
  int vector{-1};  ///< the first golden vector that failed, in a sound model the one furthest off; -1 if it has none
  int rotor{-1};   ///< its command furthest off, -1 if none is off at all
  Scalar largest_difference{0};  ///< |command - golden command| there; not finite if the command is not
};

inline namespace PINNQUAD_INSTRUCTION_SET {

/// Ok if the network by itself, whatever the guard, reproduces every golden command within golden_tolerance, and every golden
/// vector lies in the envelope. Else `self_test_failed`: a wrong kernel, compiler flag or bit in flash, or no golden vector.
/// Every NaN is found. A wrong bit of a weight is found if it moves a golden command by more than the tolerance: a bit that
/// matters less than rounding is for a checksum to find.
template <class Model, class Guard>
Status self_test(const InverseDynamics<Model, Guard>& inverse,
                 SelfTestReport<typename Model::Scalar>& report) noexcept {
  using Scalar = typename Model::Scalar;
  report = {};
  const Model& model = inverse.model();
  const int vectors = static_cast<int>(model.golden_features.size());
  if (vectors == 0) {
    report.cause = Status::self_test_failed;
    return Status::self_test_failed;
  }
  for (int vector = 0; vector < vectors; ++vector) {
    const auto index = static_cast<std::size_t>(vector);
    const auto& golden_features = model.golden_features[index];
    const auto& golden_commands = model.golden_commands[index];
    Scalar x[Model::Features::size];
    for (std::size_t i = 0; i < static_cast<std::size_t>(Model::Features::size); ++i) x[i] = golden_features[i];
    Scalar commands[rotor_count];
    inverse.evaluate(x, commands);
    SelfTestReport<Scalar> found{inverse.inside_envelope(x) ? Status::ok : Status::outside_envelope, vector};
    for (int rotor = 0; rotor < rotor_count; ++rotor) {
      const Scalar difference = commands[rotor] - golden_commands[static_cast<std::size_t>(rotor)];
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
      return Status::self_test_failed;
    }
    if (vector == 0 || found.largest_difference > report.largest_difference) report = found;
  }
  return Status::ok;
}

template <class Model, class Guard>
Status self_test(const InverseDynamics<Model, Guard>& inverse) noexcept {
  SelfTestReport<typename Model::Scalar> report;
  return self_test(inverse, report);
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
