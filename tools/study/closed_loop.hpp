// SPDX-License-Identifier: MIT
// A model as feed-forward in the demo's closed loop: how far off the vehicle flies, and how often the model declines.
#pragma once

#include <array>
#include <functional>

#include "pinnquad/data/row_set.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "training/judgement.hpp"

namespace study {

/// Trajectories flown: the demo's figure-eight (4.8 m/s), one of 5.1 m/s whose nose swings by 0.5 rad, a circle (4.2
/// m/s); 30 s each, calm air.
inline constexpr std::array<const char*, 3> loop_trajectories = {"eight", "yaw_eight", "circle"};

/// Of each trajectory; NaN where none was flown, or the flight ended early.
struct LoopFigures {
  using Each = std::array<double, loop_trajectories.size()>;
  Each rmse_m = {pinnquad::not_a_number, pinnquad::not_a_number, pinnquad::not_a_number};
  Each declined_share = rmse_m;  ///< of the control ticks: the model had no answer
};

/// Commands of a row, NaN where the model declines.
using RowPredictions = std::function<programs::Predictions(const pinnquad::RowSet&)>;

/// Flies `flown`. Where the model declines, its rigid body stands in. The outer loop is the same for all models.
LoopFigures closed_loop(const RowPredictions& model, const pinnquad::Airframe<double>& flown);

}  // namespace study
