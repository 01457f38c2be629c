// SPDX-License-Identifier: MIT
// One program for several processors: the same source, compiled once per instruction set into objects of its own, each
// with a table of its functions; choose_prediction() takes the one that runs here.
//   // quad_prediction.hpp
//   extern const pinnquad::CompiledPrediction<float> quad_baseline, quad_avx2, quad_avx512;
//   // quad_prediction.cpp, compiled with -march=x86-64-v3 -DQUAD=quad_avx2, and so on
//   using namespace pinnquad;
//   const CompiledPrediction<float> QUAD = compiled_prediction<InverseDynamics<MyQuad>>();
#pragma once

#include "pinnquad/inference/batched_inverse.hpp"
#include "pinnquad/inference/command_jacobian.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"
#include "pinnquad/inference/self_test.hpp"

namespace pinnquad {

/// Functions of one object. Features and commands are in physical units, as the functions of the same names want them.
template <class Scalar>
struct CompiledPrediction {
  Status (*predict_features)(const Scalar* x, Scalar* commands) noexcept;
  void (*predict_batch)(const Scalar* x, Scalar* commands, Status* statuses, int samples) noexcept;
  Status (*predict_with_jacobian)(const Scalar* x, Scalar* commands, Scalar* jacobian) noexcept;
  Status (*self_test)() noexcept;
  /// Name of the object's instruction set (core/instruction_set.hpp), ends with a 0.
  const char* instruction_set;
};

inline namespace PINNQUAD_INSTRUCTION_SET {

/// The table of an exported model, an InverseDynamics without values of its own, as compiled here.
template <class Inverse>
constexpr CompiledPrediction<typename Inverse::Scalar> compiled_prediction() noexcept {
  using Scalar = typename Inverse::Scalar;
  return {[](const Scalar* x, Scalar* commands) noexcept { return Inverse{}.predict_features(x, commands); },
          [](const Scalar* x, Scalar* commands, Status* statuses, int samples) noexcept {
            predict_batch(Inverse{}, x, commands, statuses, samples);
          },
          [](const Scalar* x, Scalar* commands, Scalar* jacobian) noexcept {
            return predict_with_jacobian(Inverse{}, x, commands, jacobian);
          },
          []() noexcept { return self_test(Inverse{}); }, detail::instruction_set.data()};
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
