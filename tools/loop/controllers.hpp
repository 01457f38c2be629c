// SPDX-License-Identifier: MIT
// Controllers that are compared: compositions of flight code by name. Outer loop, reference, limits, filters and the
// rotors' lag are the same for all; they differ in what turns a motion into commands, and in what they learn.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "flight/loop_trajectories.hpp"
#include "loop/any_policy.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/simulation/switched_quadrotor.hpp"

namespace programs {

struct LoopController {
  const char* name;
  const char* summary;
  bool asks_model = false;  ///< of the block
  bool learns = false;
  bool asks_wrench = false;  ///< of --wrench
  bool feeds_back = false;   ///< itself: the outer loop adds nothing
};

inline constexpr std::array<LoopController, 18> loop_controllers = {{
    {"pid", "cascaded PID: the rigid body's allocation, integral of the feedback", false, true},
    {"formula", "the analytic inverse with nominal drag"},
    {"geometric", "the same, and the attitude leans against nominal drag"},
    {"formula_adaptive", "the analytic inverse, with a bias learnt in flight", false, true},
    {"indi", "incremental inversion of the rigid body (INDI): rates and force", false, true},
    {"observer", "disturbance observer: geometric, and a low-pass of what it lacks", false, true},
    {"l1", "L1 adaptive: geometric, and the low-pass of a piecewise-constant estimate", false, true},
    {"wrench", "the rigid body with the learnt residual wrench; the attitude leans against it", false, false, true},
    {"wrench_indi", "incremental inversion of that", false, true, true},
    {"full", "the same, and wind, thrust and force by a Kalman filter through the network", false, true, true},
    {"full_nominal", "full, with nominal drag in place of the learnt residual wrench", false, true},
    {"full_bias", "full, without a residual wrench", false, true},
    {"mppi", "model predictive path integral: nominal drag, 512 flights of 0.8 s, fifty times a second", false, false,
     false, true},
    {"structured", "the model of the block", true},
    {"structured_drag", "the same, and the attitude leans against nominal drag", true},
    {"adaptive", "the model, with a bias learnt in flight; beyond its bound formula_adaptive", true, true},
    {"structured_indi", "incremental inversion of the model", true, true},
    {"structured_observer", "disturbance observer on the model, and the attitude leans against nominal drag", true,
     true},
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
  const std::vector<double>& columns;  ///< of the model, in their order
  const pinnquad::SwitchedQuadrotor& vehicle;
  pinnquad::BiasSettings<double> bias{};
  double delay_s = 0;                            ///< by which states come late
  const pinnquad::BlockModel* wrench = nullptr;  ///< a residual wrench (loop/wrench_block.hpp), where one is given
  const AnyTrajectory* path = nullptr;           ///< for one that plans ahead
  double speed_m_s = 0;                          ///< that the model's envelope holds, level: likewise
};

/// Throws std::out_of_range for a name that is none.
AnyPolicy loop_policy(const std::string& name, const LoopKnowledge& known, const LoopGains& gains);

}  // namespace programs
