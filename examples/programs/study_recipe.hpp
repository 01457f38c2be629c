// SPDX-License-Identifier: MIT
// How the study trains: one recipe for all models of Table 2, said here and nowhere else.
#pragma once

#include <cstdint>
#include <tuple>

#include <nlohmann/json.hpp>

#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/schedule/constant.hpp"
#include "pinnquad/schedule/cosine_decay.hpp"
#include "pinnquad/schedule/cyclical_annealing.hpp"
#include "pinnquad/training/adam.hpp"
#include "pinnquad/training/scheduled.hpp"

namespace study {

// Local monotonicity about roll, pitch and yaw: the paper's lambda and cycles; series in units of their spread, and a gain
// that separates their steps.
inline constexpr double lambda_max = 0.1;
inline constexpr double step_gain = 3.0;
inline constexpr int annealing_cycles = 5;
inline constexpr double annealing_hold = 0.5;

inline constexpr int batch_size = 64;
inline constexpr std::uint64_t first_seed = 1;

/// Adam with coupled weight decay, the learning rate falling along a cosine. Each loss has the decay that suits it best.
using Optimizer = pinnquad::Scheduled<pinnquad::Adam, pinnquad::CosineDecay>;
inline constexpr const char* optimizer_name = "Adam, coupled weight decay";
inline constexpr const char* learning_rate_schedule_name = "cosine decay to 0";
inline constexpr double learning_rate = 3e-3;
inline constexpr double vanilla_decay = 1e-4;
inline constexpr double informed_decay = 3e-4;

inline pinnquad::Adam adam(double decay, double rate = learning_rate) {
  pinnquad::Adam adam;
  adam.learning_rate = rate;
  adam.weight_decay = decay;
  return adam;
}
inline Optimizer optimizer(double decay, double rate = learning_rate) { return {adam(decay, rate), {}}; }

/// Any physics-informed loss with terms about the three axes, all under one schedule.
template <class Loss, class Schedule>
Loss with_schedule(Loss loss, const Schedule& schedule) {
  std::apply([&](auto&... term) { ((term.schedule = schedule), ...); }, loss.terms);
  return loss;
}

/// The study's physics-informed loss.
template <class Schedule>
pinnquad::PaperLoss<Schedule> physics_loss(const Schedule& schedule, double gain = step_gain) {
  auto loss = with_schedule(pinnquad::PaperLoss<Schedule>{}, schedule);
  std::apply([&](auto&... term) { ((term.loss.step.gain = gain), ...); }, loss.terms);
  return loss;
}

inline pinnquad::Constant constant_weight(double lambda = lambda_max) { return {lambda}; }
inline pinnquad::CyclicalAnnealing annealed_weight(double lambda = lambda_max) {
  return {lambda, annealing_cycles, annealing_hold};
}

inline nlohmann::json recipe_description() {
  const pinnquad::Adam used = adam(vanilla_decay);
  return {{"batch", batch_size},
          {"batch_order", "shuffled"},
          {"optimizer", optimizer_name},
          {"learning_rate", used.learning_rate},
          {"learning_rate_schedule", learning_rate_schedule_name},
          {"beta_1", used.beta_1},
          {"beta_2", used.beta_2},
          {"weight_decay", {{"vanilla", vanilla_decay}, {"physics-informed", informed_decay}}},
          {"lambda_max", lambda_max},
          {"cycles", annealing_cycles},
          {"hold", annealing_hold},
          {"step", "tanh"},
          {"step_gain", step_gain},
          {"series", "standardised by their spread in the training rows"},
          {"inputs_and_outputs", "z-scored by the training rows"},
          {"initialisation", "Xavier uniform"}};
}

}  // namespace study
