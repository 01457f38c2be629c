// SPDX-License-Identifier: MIT
// The ablation: what of the recipe decides the outcome. Each variant differs from the recipe in what its name says; the
// network is that of models 2 to 4.
#pragma once

#include <vector>

#include "study_contender.hpp"

namespace study {

namespace detail {

using AblationNetwork = PaperNetwork<D1::Features, Without>::type;

/// A variant with the recipe's batch order, or another.
template <class Order = pinnquad::ShuffledBatches, class Loss, class OptimizerOf>
Contender variant(const std::string& id, const std::string& differs, const Loss& loss, const OptimizerOf& optimizer_of) {
  Contender result = trained_contender<D1, AblationNetwork, Order>(id, {{"differs", differs}}, loss, optimizer_of);
  result.more_flights = true;
  return result;
}

}  // namespace detail

inline std::vector<Contender> ablation() {
  using detail::variant;
  const auto informed = [](double lambda, double gain) { return physics_loss(annealed_weight(lambda), gain); };
  std::vector<Contender> all = {
      variant("vanilla", "no physics terms", pinnquad::Mse{}, optimizer),
      variant("informed", "nothing", informed(lambda_max, step_gain), optimizer),
      variant("constant", "constant lambda", physics_loss(constant_weight()), optimizer),
  };
  for (const auto& [name, gain] : {std::pair<const char*, double>{"gain_1", 1}, {"gain_10", 10}, {"gain_30", 30}}) {
    all.push_back(variant(name, "gain of the step", informed(lambda_max, gain), optimizer));
  }
  for (const auto& [name, lambda] :
       {std::pair<const char*, double>{"lambda_0.01", 0.01}, {"lambda_0.03", 0.03}, {"lambda_0.3", 0.3}, {"lambda_1", 1}}) {
    all.push_back(variant(name, "lambda", informed(lambda, step_gain), optimizer));
  }
  using pinnquad::TimeOrderedBatches;
  all.push_back(variant<TimeOrderedBatches>("vanilla_time_ordered", "batch order, no physics terms", pinnquad::Mse{}, optimizer));
  all.push_back(variant<TimeOrderedBatches>("informed_time_ordered", "batch order", informed(lambda_max, step_gain), optimizer));
  return all;
}

}  // namespace study
