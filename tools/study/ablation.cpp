// SPDX-License-Identifier: MIT
// The ablation: what of the recipe decides the outcome. A variant differs from the recipe in what its name says; the
// network is that of models 2 to 4. Vanilla has as many variants of its training as the physics-informed network.
#include "study/ablation.hpp"

#include <string>
#include <utility>
#include <vector>

#include "command_line/listed.hpp"
#include "pinnquad/loss/local_monotonicity.hpp"
#include "pinnquad/training/adam.hpp"
#include "study/contender.hpp"
#include "training/network_kinds.hpp"

namespace study {

namespace {

/// Batches in recorded order: consecutive pairs of a batch are consecutive in time.
struct TimeOrderedBatches {
  template <class Engine>
  void arrange(std::vector<int>&, Engine&) const {}
};

/// A variant with the recipe's batch order and no batch norm, or others.
template <class Order = pinnquad::ShuffledBatches, class BatchNorm = Without, class Loss, class OptimizerType>
void add_variant(std::vector<Contender>& all, const std::string& id, const std::string& differs, const Loss& loss,
                 const OptimizerType& optimizer_used) {
  using Network = PaperNetwork<D1::Features, BatchNorm>;
  all.push_back(trained_contender<D1, Network, Order>(id, {{"differs", differs}}, loss, optimizer_used));
  all.back().more_flights = true;
}

auto adam_w(double decay) {
  pinnquad::Scheduled<pinnquad::AdamW, pinnquad::CosineDecay> result;
  result.optimizer.learning_rate = learning_rate;
  result.optimizer.weight_decay = decay;
  return result;
}

/// A loss whose recipe has this weight decay, under other optimisers, another batch order, and with batch norm.
template <class Loss>
void add_trainings(std::vector<Contender>& all, const std::string& id, const Loss& loss, double own_decay) {
  add_variant(all, id, "nothing", loss, optimizer(own_decay));
  add_variant(all, id + "_1e-3_constant", "learning rate", loss, adam(own_decay, 1e-3));
  add_variant(all, id + "_3e-3_constant", "learning rate", loss, adam(own_decay, 3e-3));
  add_variant(all, id + "_1e-3_cosine", "learning rate", loss, optimizer(own_decay, 1e-3));
  add_variant(all, id + "_6e-3_cosine", "learning rate", loss, optimizer(own_decay, 6e-3));
  for (const auto& [name, decay] : {std::pair<const char*, double>{"0", 0},
                                    {"1e-5", 1e-5},
                                    {"3e-5", 3e-5},
                                    {"1e-4", 1e-4},
                                    {"3e-4", 3e-4},
                                    {"1e-3", 1e-3}}) {
    if (decay != own_decay) add_variant(all, id + "_decay_" + name, "weight decay", loss, optimizer(decay));
    using Shuffled = pinnquad::ShuffledBatches;
    add_variant<Shuffled, With>(all, id + "_batch_norm_decay_" + name, "batch norm", loss, optimizer(decay));
  }
  add_variant(all, id + "_adamw_0.01", "decoupled weight decay", loss, adam_w(0.01));
  add_variant<TimeOrderedBatches>(all, id + "_time_ordered", "batch order", loss, optimizer(own_decay));
}

std::vector<Contender> ablation() {
  std::vector<Contender> all;
  add_trainings(all, "vanilla", pinnquad::Mse{}, vanilla_decay);
  // as many more as the physics terms are given below
  for (const auto& [name, rate] : {std::pair<const char*, double>{"2e-3", 2e-3}, {"4e-3", 4e-3}, {"1e-2", 1e-2}}) {
    add_variant(all, std::string("vanilla_") + name + "_cosine", "learning rate", pinnquad::Mse{},
                optimizer(vanilla_decay, rate));
  }
  add_variant(all, "vanilla_adamw_0.001", "decoupled weight decay", pinnquad::Mse{}, adam_w(0.001));
  add_variant(all, "vanilla_adamw_0.1", "decoupled weight decay", pinnquad::Mse{}, adam_w(0.1));

  const Optimizer informed = optimizer(informed_decay);
  add_trainings(all, "informed", physics_loss(annealed_weight()), informed_decay);
  for (const auto& [name, gain] : {std::pair<const char*, double>{"1", 1}, {"10", 10}}) {
    add_variant(all, std::string("informed_gain_") + name, "gain", physics_loss(annealed_weight(), gain), informed);
  }
  for (const auto& [name, lambda] : {std::pair<const char*, double>{"0.03", 0.03}, {"0.3", 0.3}}) {
    add_variant(all, std::string("informed_lambda_") + name, "lambda", physics_loss(annealed_weight(lambda)), informed);
  }
  add_variant(all, "informed_constant", "lambda without annealing", physics_loss(constant_weight()), informed);

  // other forms of the physics terms, each with the gain that is its own (loss/local_monotonicity.hpp)
  add_variant(all, "literal_constant", "form as Algorithm 1 prints it, lambda without annealing",
              with_schedule(pinnquad::PaperLoss<pinnquad::Constant, pinnquad::Literal>{}, constant_weight()), informed);
  add_variant(all, "literal", "form as Algorithm 1 prints it",
              with_schedule(pinnquad::PaperLoss<pinnquad::CyclicalAnnealing, pinnquad::Literal>{}, annealed_weight()),
              informed);
  add_variant(all, "match", "form that asks for equal steps",
              with_schedule(pinnquad::PaperLoss<pinnquad::CyclicalAnnealing, pinnquad::Match>{}, annealed_weight()),
              informed);
  add_variant(all, "pearson", "Pearson's correlation instead of local monotonicity",
              with_schedule(programs::PearsonLoss{}, annealed_weight()), informed);
  return all;
}

}  // namespace

std::vector<Contender> chosen_variants(const std::vector<std::string>& names) {
  return programs::chosen_by_name(
      ablation(), names, [](const Contender& contender) { return contender.id; }, "--variants", "variant");
}

}  // namespace study
