// SPDX-License-Identifier: MIT
// Scalers that a mirror leaves as they are: what SymmetricPredictor (model/symmetrised.hpp) is standardised by.
#pragma once

#include "pinnquad/model/symmetrised.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"

namespace pinnquad {

/// The context with a mean of 0 for each feature and each signed sum that a mirror turns: what the mean of rows and their
/// mirror images is.
template <class ContextType>
ContextType context_of_mirror_images(ContextType context) {
  static_assert(is_signed_sums<typename ContextType::Outputs>,
                "pinnquad: a symmetric model answers signed sums: Context<Features, Vehicle, AxisCommandOutputs>");
  for (int i = 0; i < ContextType::Features::size; ++i) {
    if (is_odd<typename ContextType::Features>(i)) context.input.mean[static_cast<std::size_t>(i)] = 0;
  }
  context.output.mean[1] = context.output.mean[3] = 0;
  return context;
}

}  // namespace pinnquad
