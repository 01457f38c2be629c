// SPDX-License-Identifier: MIT
// A certificate as programs say it: what is proven of a model's slopes, how they stand beside the airframe's own.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "command_line/in_words.hpp"
#include "command_line/listed.hpp"
#include "pinnquad/control/motion_bias.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/exported/certificate.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/training/structured/measured_slope.hpp"
#include "training/judgement.hpp"

namespace programs {

/// A slope that is not within these shares of the airframe's own in hover is doubted.
inline constexpr double least_undoubted = 0.8, most_undoubted = 1.2;

/// "by at least 0.98 of the airframe's own slope in hover": the least of the axes.
inline std::string least_share_in_words(const pinnquad::AxisSlopes& slopes, const pinnquad::AxisSlopes& own) {
  double least = slopes[0] / own[0];
  for (std::size_t axis = 1; axis < slopes.size(); ++axis) least = std::min(least, slopes[axis] / own[axis]);
  return in_words("by at least %.2f of the airframe's own slope in hover", least);
}

/// A line for each slope that is far from the airframe's own, short: "its roll slope is 0.45 of the airframe's".
inline std::vector<std::string> odd_slopes(const pinnquad::BlockModel::ProvenSigns& signs,
                                           const pinnquad::Airframe<double>& airframe) {
  std::vector<std::string> odd;
  const auto look = [&odd](const char* name, double share) {
    if (share >= least_undoubted && share <= most_undoubted) return;
    odd.push_back(in_words("its %s slope is %.2f of the airframe's", name, share));
  };
  const pinnquad::AxisSlopes own = pinnquad::hover_slopes(airframe);
  if (signs.structure) look("thrust", signs.structure->held_thrust_slope / pinnquad::hover_thrust_slope(airframe));
  for (std::size_t axis = 0; axis < own.size(); ++axis) look(axis_names[axis], signs.held_slope[axis] / own[axis]);
  return odd;
}

/// The same in one line, with what may be the cause; empty where there are none.
inline std::string slopes_doubt(const std::vector<std::string>& odd) {
  if (odd.empty()) return "";
  return listed(odd) +
         ": trained on quiet or noisy flights, on a log with rotor lag or latency in it, or for another airframe; "
         "where the angular acceleration is not noisy, train --slopes pinned takes the airframe's slopes in hover; "
         "below 0.5 in thrust a position loop sinks under a load (docs/certificate.md)";
}

inline bool any_smoothed(const pinnquad::SlopesOfSums& slopes) {
  return std::any_of(slopes.begin(), slopes.end(), [](const auto& slope) { return slope.smoothed(); });
}

/// "the residual changes a command by at most 0.1669 0.1669 0.1669 0.1669", rotor by rotor; or that there is none.
inline std::string bound_in_words(const std::optional<pinnquad::Certificate>& structure) {
  const double* bound = structure ? structure->command_bound : nullptr;
  if (!structure || std::none_of(bound, bound + pinnquad::rotor_count, [](double most) { return most > 0; })) {
    return "there is no residual: the commands are an affine map of the features";
  }
  return in_words("the residual changes a command by at most %.4f %.4f %.4f %.4f", bound[0], bound[1], bound[2],
                  bound[3]);
}

/// "thrust 0.20 s, roll 0.50 s, pitch none, yaw 1.00 s".
template <class Times>
std::string time_constants_in_words(const Times& times_s) {
  std::string words;
  for (std::size_t k = 0; k < sum_names.size(); ++k) {
    const auto time_s = static_cast<double>(times_s[k]);
    words += (k == 0 ? "" : ", ") + std::string(sum_names[k]) + (time_s > 0 ? in_words(" %.2f s", time_s) : " none");
  }
  return words;
}

/// The certificate of a model whose bias is learnt in flight.
inline std::string bias_in_words(const pinnquad::Airframe<double>& airframe) {
  const pinnquad::Commands<double> most = pinnquad::largest_bias(airframe);
  return in_words(
      "with the bias that is learnt in flight the slopes hold as they are, for it is of the past; it changes a "
      "command by at most %.4f %.4f %.4f %.4f besides",
      most[0], most[1], most[2], most[3]);
}

}  // namespace programs
