// SPDX-License-Identifier: MIT
// A residual asked of rows that it has not seen, group by group: how much of its answer counts.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "pinnquad/outputs/axis_command_outputs.hpp"

namespace pinnquad::detail {

/// Sums over the answers of a residual and the truth, of each axis command in its own unit.
class Agreement {
 public:
  static constexpr int outputs = AxisCommandOutputs::size;

  void begin_group() { groups_.emplace_back(); }
  void add(int output, double said, double truth) {
    Sums& of = groups_.back()[static_cast<std::size_t>(output)];
    of.product += said * truth;
    of.said += said * said;
    of.truth += truth * truth;
    of.rows += 1;
  }
  /// The share of the answer that leaves the least squared error: by least squares, of 0 to 1; 0 where it does not
  /// lower that of each group.
  double share(int output) const {
    const Sums all = total(output);
    const double share = all.said > 0 ? std::clamp(all.product / all.said, 0.0, 1.0) : 0.0;
    for (const auto& group : groups_) {
      if (!(group[static_cast<std::size_t>(output)].gain(share) > 0)) return 0;
    }
    return share;
  }
  /// By how much these shares lower the squared error of the signed sums.
  double gain() const {
    double all = 0;
    for (int output = 0; output < outputs; ++output) all += total(output).gain(share(output));
    return all;
  }
  /// Root mean square of the commands' error that they leave: the squared error of the signed sums is four times that
  /// of the commands.
  double error() const {
    double squares = 0, rows = 0;
    for (int output = 0; output < outputs; ++output) {
      squares += total(output).truth;
      rows = total(output).rows;
    }
    return std::sqrt((squares - gain()) / (4 * outputs * rows));
  }

 private:
  /// Sums of answer x truth and of the squares of either, and the number of rows.
  struct Sums {
    double product = 0, said = 0, truth = 0, rows = 0;
    double gain(double share) const { return (2 * product - share * said) * share; }
  };

  Sums total(int output) const {
    Sums all;
    for (const auto& group : groups_) {
      const Sums& of = group[static_cast<std::size_t>(output)];
      all.product += of.product;
      all.said += of.said;
      all.truth += of.truth;
      all.rows += of.rows;
    }
    return all;
  }

  std::vector<std::array<Sums, static_cast<std::size_t>(outputs)>> groups_;
};

}  // namespace pinnquad::detail
