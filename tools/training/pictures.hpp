// SPDX-License-Identifier: MIT
// A picture of a judgement: confidence ellipses (Fig. 8).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "page/chart.hpp"
#include "training/judgement.hpp"

namespace programs {

/// A line of three panels.
struct EllipsesOf {
  std::string model;
  std::array<AxisSeries, 3> axes;
};

/// Fig. 8: signed command sum over angular acceleration, standardised by the target's standard deviation; dots target,
/// plus signs prediction, 3-sigma ellipses with their major axis.
Chart ellipses_chart(const std::vector<EllipsesOf>& models);

}  // namespace programs
