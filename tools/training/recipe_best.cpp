// SPDX-License-Identifier: MIT
// The recipe `best`: the network without batch norm and the training that did best in the study's search
// (training/best_recipe.hpp).
#include "training/best_parts.hpp"
#include "training/paper_network.hpp"

namespace programs {

Recipe best_recipe() {
  using Network = PaperNetwork<pinnquad::PaperFeatures>;
  constexpr const char* hidden = "10 x 25 ReLU";
  return {"best", network_in_words<Network>(hidden), best::settings(hidden),
          network_kinds<best::Parts<Network>>(
              {"best_vanilla", "best_physics_informed", "best_constant_weight", "best_pearson"})};
}

}  // namespace programs
