// SPDX-License-Identifier: MIT
// Pictures of a flight as the paper has them: trajectory (Fig. 4 d), correlation (Fig. 2), ground effect (Fig. 5), wind
// (Fig. 6).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "flight/trace.hpp"
#include "page/chart.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/simulation/switched_quadrotor.hpp"

namespace programs {

/// Fig. 4 (d): the flown path in space, coloured by speed in steps of half a metre per second, with its shadows on the
/// floor and on the two walls behind, its start and its end.
Chart trajectory_chart(const std::vector<TraceRow>& trace);

/// The files that draw_flight may write.
inline constexpr std::array<const char*, 4> flight_picture_names = {"trajectory.svg", "correlation.svg",
                                                                    "ground_effect.svg", "wind.svg"};

/// All of them into a folder that is there: trajectory.svg, correlation.svg, ground_effect.svg where there is one,
/// wind.svg if `windy`. Throws OutputError.
void draw_flight(const std::string& folder, const pinnquad::Flight& flight, const std::vector<TraceRow>& trace,
                 const pinnquad::Airframe<double>& airframe, pinnquad::GroundEffectModel ground_effect, bool windy);

}  // namespace programs
