// SPDX-License-Identifier: MIT
// How the study trains all models of Table 2, and `train --models best_vanilla`, `small_vanilla`: the numbers are said
// here and nowhere else.
//
// They were chosen by the mean absolute error on the validation rows of flights d1 of the seeds 1000 and 1001, five
// trainings of 300 epochs each, network without batch norm; 20 configurations for vanilla, 20 for physics-informed. The
// study flies other seeds, and this file was committed before they were flown. Error in 1e-3 of the command range,
// deviation over the ten trainings in parentheses; decay 1e-5 where none is named:
//
//                                        vanilla        physics-informed
//   Adam 1e-3                            24.5 (3.2)     21.3 (0.9)
//   3e-3                                 21.3 (1.7)     20.3 (1.6)
//   1e-3 cosine                          27.9 (4.3)     24.1 (1.5)
//   3e-3 cosine                          21.1 (2.4)     19.5 (1.8)
//   6e-3 cosine                          22.0 (1.6)     19.8 (1.0)
//   3e-3 cosine, AdamW 0.01              22.6 (1.8)     20.7 (2.1)
//   3e-3 cosine, batches in time order   31.9 (2.5)     29.7 (1.9)
//   3e-3 cosine, decay 3e-5              20.6 (2.5)     19.6 (1.7)
//   3e-3 cosine, decay 1e-4              19.0 (1.0) *   18.8 (1.1)
//   3e-3 cosine, decay 3e-4              20.3 (1.3)     17.1 (0.8) *
//   3e-3 cosine, decay 1e-3              21.5 (0.9)     17.7 (0.6)
//   vanilla besides: at decay 1e-4, 2e-3 cosine 19.4, 4e-3 cosine 19.8, 6e-3 cosine 21.6, 3e-3 constant 21.3; at 1e-5,
//     2e-3 cosine 22.5, 4e-3 cosine 21.1; at 3e-3 cosine, decay 0 22.6, 1e-6 23.4, AdamW 0.1 23.0
//   physics-informed besides, at 3e-3 cosine: at decay 1e-5 gain 1 20.5, gain 10 19.3, lambda 0.03 19.9, lambda 0.3
//     22.4, constant lambda 20.7; at 1e-4 gain 10 18.0, lambda 0.03 17.8; at 3e-4, three seeds, gain 10 17.3, lambda
//     0.03 17.3
//
// Ellipse angles had no say. They fall apart for vanilla where the decay grows (roll on these flights' test rows: 3.8
// degrees at 1e-5, 8.6 at 3e-5, 27 at 1e-4, 45 at 3e-4), and stay for physics-informed (4.7, -, 4.3, 4.3).
//
// So each kind has the decay that suits it best (*), and the paper's lambda, cycles and hold stay. With batch norm the
// decay matters little (three seeds, 1e-5 to 1e-3: vanilla 33.0 to 35.2, physics-informed 31.4 to 32.7): the same is
// used.
#pragma once

#include <tuple>

#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/adam.hpp"
#include "pinnquad/training/optimizer.hpp"

namespace programs {
inline constexpr int batch_size = 64;  ///< of every recipe
}

namespace programs::best {

using programs::batch_size;

// Local monotonicity about roll, pitch and yaw: the paper's lambda and cycles; series in units of their spread, and a
// gain that separates their steps.
inline constexpr double lambda_max = 0.1;
inline constexpr double step_gain = 3.0;
inline constexpr int annealing_cycles = 5;
inline constexpr double annealing_hold = 0.5;

/// Adam with coupled weight decay, the learning rate falling along a cosine. Each loss has the decay that suits it.
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
  std::apply([&](auto&... term) { ((term.loss.gain = gain), ...); }, loss.terms);
  return loss;
}

inline pinnquad::Constant constant_weight(double lambda = lambda_max) { return {lambda}; }
inline pinnquad::CyclicalAnnealing annealed_weight(double lambda = lambda_max) {
  return {lambda, annealing_cycles, annealing_hold};
}

}  // namespace programs::best
