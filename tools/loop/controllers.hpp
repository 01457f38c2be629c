// SPDX-License-Identifier: MIT
// Controllers that fly in the loop: compositions of flight code by name. Outer loop, reference, limits, filters and the
// rotors' lag are the same for all; they differ in what turns a motion into commands, and in what they learn.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "flight/loop_trajectories.hpp"
#include "loop/any_policy.hpp"
#include "pinnquad/control/adaptive_inverse.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/simulation/switched_quadrotor.hpp"

namespace programs {

struct LoopController {
  const char* name;
  const char* summary;
  bool learns = false;
};

/// The controllers that one ships.
inline constexpr std::array<LoopController, 7> loop_controllers = {{
    {"pid", "cascaded PID: the rigid body's allocation, integral of the feedback", true},
    {"formula", "the analytic inverse with nominal drag"},
    {"formula_adaptive", "the analytic inverse, with a bias learnt in flight", true},
    {"indi", "incremental inversion of the rigid body (INDI): rates and force", true},
    {"structured", "the model of the block"},
    {"adaptive", "the model, with a bias learnt in flight; beyond its bound formula_adaptive", true},
    {"structured_indi", "incremental inversion of the model", true},
}};

/// Factors of what each controller has by default; 1 each: equal, moderate gains.
struct LoopGains {
  double outer = 1;     ///< of position and velocity gains
  double inner = 1;     ///< of attitude and body rate gains
  double learning = 1;  ///< of the rates at which it learns: integral, bias, cut-off
};

pinnquad::FlightGains<double> flight_gains(const LoopGains& factors);

/// All that the controllers are told.
struct LoopKnowledge {
  const pinnquad::BlockModel& model;
  const std::vector<double>& columns;  ///< of the model, in their order, as they stand at each tick
  const pinnquad::SwitchedQuadrotor& vehicle;
  pinnquad::BiasSettings<double> bias{};
  double delay_s = 0;                   ///< by which states come late
  const AnyTrajectory* path = nullptr;  ///< for one that plans ahead
  double speed_m_s = 0;                 ///< that the model's envelope holds, level: likewise
};

/// Throws std::out_of_range for a name that is none of loop_controllers.
AnyPolicy loop_policy(const std::string& name, const LoopKnowledge& known, const LoopGains& gains);

}  // namespace programs
