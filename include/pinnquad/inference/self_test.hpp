// SPDX-License-Identifier: MIT
// Replays a model's golden vectors: at boot, before the first command goes to a motor.
#pragma once

#include "pinnquad/inference/inverse_dynamics.hpp"

namespace pinnquad {

/// Ok if every golden command is reproduced within golden_tolerance, else `self_test_failed`: a wrong kernel, compiler flag
/// or bit in flash.
template <class Model>
Status self_test(const InverseDynamics<Model>& inverse) noexcept {
  using Scalar = typename Model::Scalar;
  for (std::size_t i = 0; i < Model::golden_features.size(); ++i) {
    Commands<Scalar> commands{};
    if (inverse.predict_features(Model::golden_features[i].data(), commands) != Status::ok) {
      return Status::self_test_failed;
    }
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
      const Scalar difference = commands[rotor] - Model::golden_commands[i][rotor];
      const Scalar magnitude = difference < Scalar(0) ? -difference : difference;
      if (!(magnitude <= Scalar(golden_tolerance))) return Status::self_test_failed;
    }
  }
  return Status::ok;
}

}  // namespace pinnquad
