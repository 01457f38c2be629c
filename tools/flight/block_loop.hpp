// SPDX-License-Identifier: MIT
// A model of a block flown in a closed loop: feed-forward on a trajectory, beside the analytic inverse and none.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "flight/loop_figures.hpp"
#include "flight/model_range.hpp"
#include "pinnquad/aero/battery.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/simulation/tracking.hpp"

namespace programs {

/// By name: a figure-eight; one in 14/15 of its period whose nose swings by 0.5 rad; a level circle.
inline constexpr std::array<const char*, 3> loop_trajectories = {"eight", "yaw_eight", "circle"};

struct LoopPlan {
  std::string trajectory;                 ///< one of loop_trajectories, or a file of waypoints (flight/waypoints.hpp)
  pinnquad::Airframe<double> airframe{};  ///< what flies, in calm air
  bool keeps_envelope = true;             ///< the model declines outside its training envelope, as TrainingGuard does
  std::vector<double> columns;            ///< of the model, in their order
  std::optional<pinnquad::Battery> battery{};  ///< that the model flies on; the others have none
};

struct LoopFlights {
  double half_length_m = 0, period_s = 0;  ///< of waypoints: half their extent, 1 m at least; from first to last
  double duration_s = pinnquad::TrackingPlan<double>{}.duration_s;
  double lowest_m = 0, highest_m = 0;  ///< altitude of the trajectory
  bool near_ground = false;            ///< in ground effect: the model is shown the altitude
  double last_voltage_V = 0;           ///< of a battery that the model reads
  pinnquad::TrackingResult<double> model, analytic_inverse, without_jerk;
  FlownTraces traces{};  ///< of the model, and of the analytic inverse without jerk
};

/// The motions that a model answers. The model must stay where it is.
ModelRange range_of(const pinnquad::BlockModel& model);

/// Where the model declines, the analytic inverse of the airframe flies. Throws std::invalid_argument, one line, of an
/// airframe that can't be flown there.
LoopFlights fly_loop(const pinnquad::BlockModel& model, const LoopPlan& plan);

}  // namespace programs
