// SPDX-License-Identifier: MIT
// Pictures of a judgement: confidence ellipses (Fig. 8), errors as bars (Figs. 7 and 9).
#pragma once

#include <array>
#include <limits>
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

/// Of one model, mean and deviation of an error; `reference` is another's result for it, NaN where there is none.
struct ErrorBar {
  std::string name;
  std::string colour = colour::blue;
  double opacity = 1, mean = 0, deviation = 0;
  double reference = std::numeric_limits<double>::quiet_NaN(), reference_deviation = 0;
};

/// Bars with whiskers from 0 to `most`; a longer one is broken there. All have their length as text.
Chart errors_chart(const std::string& title, const std::string& axis, const std::vector<ErrorBar>& bars, double most,
                   int decimals);

}  // namespace programs
