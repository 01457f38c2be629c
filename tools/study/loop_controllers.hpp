// SPDX-License-Identifier: MIT
// Controllers that are compared: those that one ships, and what was tried beside them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "loop/controllers.hpp"

namespace study {

struct StudiedController : programs::LoopController {
  bool asks_wrench = false;  ///< of --wrench
  bool feeds_back = false;   ///< itself: the outer loop adds nothing
};

/// Beside programs::loop_controllers.
inline constexpr std::array<StudiedController, 11> research_controllers = {{
    {{"geometric", "formula, and the attitude leans against nominal drag"}},
    {{"observer", "disturbance observer: geometric, and a low-pass of what it lacks", true}},
    {{"l1", "L1 adaptive: geometric, and the low-pass of a piecewise-constant estimate", true}},
    {{"wrench", "the rigid body with the learnt residual wrench; the attitude leans against it"}, true},
    {{"wrench_indi", "incremental inversion of that", true}, true},
    {{"full", "the same, and wind, thrust and force by a Kalman filter through the network", true}, true},
    {{"full_nominal", "full, with nominal drag in place of the learnt residual wrench", true}},
    {{"full_bias", "full, without a residual wrench", true}},
    {{"mppi", "model predictive path integral: nominal drag, 512 flights of 0.8 s, fifty times a second"}, false, true},
    {{"structured_drag", "structured, and the attitude leans against nominal drag"}},
    {{"structured_observer", "disturbance observer on the model, and the attitude leans against nominal drag", true}},
}};

/// programs::loop_controllers, then research_controllers.
const std::vector<StudiedController>& studied_controllers();

/// Throws std::out_of_range for a name that is none of them.
const StudiedController& controller_of(const std::string& name);

/// `wrench`: a residual wrench (study/wrench_block.hpp), where one is given. Throws as controller_of().
programs::AnyPolicy studied_policy(const std::string& name, const programs::LoopKnowledge& known,
                                   const pinnquad::BlockModel* wrench, const programs::LoopGains& gains);

}  // namespace study
