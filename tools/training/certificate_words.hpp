// SPDX-License-Identifier: MIT
// A certificate as programs say it: what is proven of a model's slopes, how they stand beside the airframe's own.
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "pinnquad/exported/certificate.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "training/judgement.hpp"

namespace programs {

/// A line for each slope that is far from the airframe's own.
inline std::vector<std::string> slope_doubts(const pinnquad::AxisSlopes& slopes, const pinnquad::AxisSlopes& own) {
  constexpr double least = 0.8, most = 1.2;
  std::vector<std::string> doubts;
  for (std::size_t axis = 0; axis < slopes.size(); ++axis) {
    const double ratio = slopes[axis] / own[axis];
    if (ratio >= least && ratio <= most) continue;
    doubts.push_back(
        std::string("the ") + axis_names[axis] +
        " slope is not the airframe's: trained on quiet or noisy flights, on a log with rotor lag or latency "
        "in it, or for another airframe; where the angular acceleration is not noisy, train --slopes pinned "
        "takes the airframe's slope in hover instead of learning one");
  }
  return doubts;
}

/// Of a model that asks for thrust: nothing where its base follows the thrust that is asked by half as much as the
/// airframe in hover, or more.
inline std::optional<std::string> thrust_doubt(const pinnquad::Certificate& certificate, double own) {
  if (certificate.held_thrust_slope >= pinnquad::least_thrust_share * own) return {};
  char text[256];
  std::snprintf(text, sizeof text,
                "the sum of the commands follows the thrust that is asked by %.2f of what the airframe's own does in "
                "hover: below %.1f a position loop sinks under a load that it should carry (docs/certificate.md)",
                certificate.held_thrust_slope / own, pinnquad::least_thrust_share);
  return text;
}

/// "the residual changes a command by at most 0.1669 0.1669 0.1669 0.1669", rotor by rotor; or that there is none.
inline std::string bound_in_words(const std::optional<pinnquad::Certificate>& structure) {
  const double* bound = structure ? structure->command_bound : nullptr;
  if (!structure || std::none_of(bound, bound + pinnquad::rotor_count, [](double most) { return most > 0; })) {
    return "there is no residual: the commands are an affine map of the features";
  }
  char text[128];
  std::snprintf(text, sizeof text, "the residual changes a command by at most %.4f %.4f %.4f %.4f", bound[0], bound[1],
                bound[2], bound[3]);
  return text;
}

}  // namespace programs
