// SPDX-License-Identifier: MIT
// How the study trains: one recipe for all models of Table 2, said here and nowhere else.
#pragma once

#include <cstdint>

#include <nlohmann/json.hpp>

#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/schedule/constant.hpp"
#include "pinnquad/schedule/cyclical_annealing.hpp"
#include "pinnquad/training/adam.hpp"

namespace study {

/// Loss terms about roll, pitch and yaw, the paper's lambda with the gain that trains on standardised series.
inline constexpr double lambda_max = 0.1;
inline constexpr double step_gain = 3.0;
inline constexpr int annealing_cycles = 5;
inline constexpr double annealing_hold = 0.5;

inline constexpr int batch_size = 64;
inline constexpr std::uint64_t first_seed = 1;

using Optimizer = pinnquad::Adam;

inline Optimizer optimizer(int /*epochs*/) { return {}; }
inline constexpr const char* optimizer_name = "Adam";
inline constexpr const char* learning_rate_schedule_name = "constant";

/// A physics-informed loss with one schedule for the three axes.
template <class Schedule>
pinnquad::PaperLoss<Schedule> physics_loss(const Schedule& schedule, double gain = step_gain) {
  pinnquad::PaperLoss<Schedule> loss;
  std::apply(
      [&](auto&... term) {
        ((term.loss.step.gain = gain), ...);
        ((term.schedule = schedule), ...);
      },
      loss.terms);
  return loss;
}

inline pinnquad::Constant constant_weight(double lambda = lambda_max) { return {lambda}; }
inline pinnquad::CyclicalAnnealing annealed_weight(double lambda = lambda_max) {
  return {lambda, annealing_cycles, annealing_hold};
}

}  // namespace study
