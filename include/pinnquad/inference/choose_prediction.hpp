// SPDX-License-Identifier: MIT
// Takes the object that runs on this processor among those compiled for several (inference/compiled_prediction.hpp).
// Once, when the program starts; compile the caller for the oldest machine. Not part of flight code.
#pragma once

#include <cstddef>

#include "pinnquad/core/processor.hpp"
#include "pinnquad/inference/compiled_prediction.hpp"

namespace pinnquad {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// The first of `candidates` (the fastest first) that runs here, or null. Call its self_test() before it flies.
template <class Scalar, std::size_t Count>
const CompiledPrediction<Scalar>* choose_prediction(
    const CompiledPrediction<Scalar>* const (&candidates)[Count]) noexcept {
  for (const CompiledPrediction<Scalar>* candidate : candidates) {
    if (runs_on_this_processor(candidate->instruction_set)) return candidate;
  }
  return nullptr;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
