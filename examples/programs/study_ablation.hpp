// SPDX-License-Identifier: MIT
// The ablation: what of the recipe decides the outcome. A variant differs from the recipe in what its name says; the network
// is that of models 2 to 4. Vanilla is given as many variants of its training as the physics-informed network.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "pinnquad/training/adam_w.hpp"
#include "study_contender.hpp"

namespace study {

namespace detail {

/// A variant with the recipe's batch order, or another.
template <class Order = pinnquad::ShuffledBatches, class Loss, class OptimizerType>
void add_variant(std::vector<Contender>& all, const std::string& id, const std::string& differs, const Loss& loss,
                 const OptimizerType& optimizer_used) {
  using Network = PaperNetwork<D1::Features, Without>;
  all.push_back(trained_contender<D1, Network, Order>(id, {{"differs", differs}}, loss, optimizer_used));
  all.back().more_flights = true;
}

/// A loss under other optimisers and another batch order; alike for vanilla and physics-informed.
template <class Loss>
void add_optimizers(std::vector<Contender>& all, const std::string& id, const Loss& loss) {
  add_variant(all, id, "nothing", loss, optimizer());
  add_variant(all, id + "_1e-3_constant", "learning rate", loss, adam(1e-3));
  add_variant(all, id + "_3e-3_constant", "learning rate", loss, adam(3e-3));
  add_variant(all, id + "_1e-3_cosine", "learning rate", loss, optimizer(1e-3));
  add_variant(all, id + "_6e-3_cosine", "learning rate", loss, optimizer(6e-3));
  pinnquad::Scheduled<pinnquad::AdamW, pinnquad::CosineDecay> adam_w;
  adam_w.optimizer.learning_rate = learning_rate;
  add_variant(all, id + "_adamw", "decoupled weight decay 0.01", loss, adam_w);
  add_variant<pinnquad::TimeOrderedBatches>(all, id + "_time_ordered", "batch order", loss, optimizer());
}

}  // namespace detail

inline std::vector<Contender> ablation() {
  using detail::add_variant;
  std::vector<Contender> all;
  detail::add_optimizers(all, "vanilla", pinnquad::Mse{});
  // the budget that goes into the physics terms below
  for (const auto& [name, decay] : {std::pair<const char*, double>{"0", 0}, {"1e-6", 1e-6}, {"1e-4", 1e-4}}) {
    add_variant(all, std::string("vanilla_decay_") + name, "weight decay", pinnquad::Mse{}, optimizer(learning_rate, decay));
  }
  add_variant(all, "vanilla_2e-3_cosine", "learning rate", pinnquad::Mse{}, optimizer(2e-3));
  add_variant(all, "vanilla_4e-3_cosine", "learning rate", pinnquad::Mse{}, optimizer(4e-3));

  detail::add_optimizers(all, "informed", physics_loss(annealed_weight()));
  for (const auto& [name, gain] : {std::pair<const char*, double>{"1", 1}, {"10", 10}}) {
    add_variant(all, std::string("informed_gain_") + name, "gain", physics_loss(annealed_weight(), gain), optimizer());
  }
  for (const auto& [name, lambda] : {std::pair<const char*, double>{"0.03", 0.03}, {"0.3", 0.3}}) {
    add_variant(all, std::string("informed_lambda_") + name, "lambda", physics_loss(annealed_weight(lambda)), optimizer());
  }
  add_variant(all, "informed_constant", "lambda without annealing", physics_loss(constant_weight()), optimizer());
  return all;
}

}  // namespace study
