// SPDX-License-Identifier: MIT
// One program for several processors: the same source, compiled once per instruction set into objects of its own, each with a
// table of its functions; choose_prediction() (inference/choose_prediction.hpp) takes the one that runs here.
//   // quad_prediction.hpp
//   extern const pinnquad::CompiledPrediction<float> quad_baseline, quad_avx2, quad_avx512;
//   // quad_prediction.cpp, compiled with -march=x86-64-v3 -DQUAD=quad_avx2, and so on
//   const pinnquad::CompiledPrediction<float> QUAD = pinnquad::compiled_prediction<pinnquad::InverseDynamics<MyQuad>>();
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
  /// What the object was compiled for (core/instruction_set.hpp), ends with a 0.
  const char* instruction_set;
};

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

template <class Inverse>
struct Compiled {
  using Scalar = typename Inverse::Scalar;
  static Status features(const Scalar* x, Scalar* commands) noexcept {
    const Inverse inverse{};
    return inverse.predict_features(x, commands);
  }
  static void batch(const Scalar* x, Scalar* commands, Status* statuses, int samples) noexcept {
    const Inverse inverse{};
    predict_batch(inverse, x, commands, statuses, samples);
  }
  static Status jacobian(const Scalar* x, Scalar* commands, Scalar* by_feature) noexcept {
    const Inverse inverse{};
    return predict_with_jacobian(inverse, x, commands, by_feature);
  }
  static Status test() noexcept {
    const Inverse inverse{};
    return self_test(inverse);
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// The table of an exported model, an InverseDynamics without values of its own, as compiled here.
template <class Inverse>
constexpr CompiledPrediction<typename Inverse::Scalar> compiled_prediction() noexcept {
  using Compiled = detail::Compiled<Inverse>;
  return {Compiled::features, Compiled::batch, Compiled::jacobian, Compiled::test, detail::instruction_set.data()};
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
