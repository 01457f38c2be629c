// SPDX-License-Identifier: MIT
// The recipe `small`: a network of a quarter of the weights, for a microcontroller, trained as `best`.
#include "training/best_parts.hpp"

namespace programs {

Recipe small_recipe() {
  using Network = pinnquad::Mlp<float, pinnquad::InputSize<pinnquad::PaperFeatures::size>, pinnquad::Hidden<2, 32>,
                                pinnquad::OutputSize<pinnquad::rotor_count>, pinnquad::Relu>;
  constexpr const char* hidden = "2 x 32 ReLU";
  return {"small", network_in_words<Network>(hidden), best::settings(hidden),
          network_kinds<best::Parts<Network>>(
              {"small_vanilla", "small_physics_informed", "small_constant_weight", "small_pearson"})};
}

}  // namespace programs
