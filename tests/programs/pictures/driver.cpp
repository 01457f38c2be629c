// SPDX-License-Identifier: MIT
// Pictures of made-up flights and judgements, in which every colour occurs.
//   pictures_driver <folder>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "flight/pictures.hpp"
#include "training/pictures.hpp"

namespace {

/// Circles that climb while the speed rises from 0.
std::vector<programs::TraceRow> spiral(double fastest_m_s) {
  constexpr int rows = 1600;
  std::vector<programs::TraceRow> trace;
  for (int i = 0; i < rows; ++i) {
    const double share = static_cast<double>(i) / rows, turn = 40 * share;
    programs::TraceRow row;
    row.time_s = 0.05 * i;
    row.position_m = {12 * std::cos(turn), 7 + 17 * std::sin(turn), -3 - 20 * share};
    row.height_m = -row.position_m[2];
    row.speed_m_s = fastest_m_s * share;
    trace.push_back(row);
  }
  return trace;
}

programs::AxisSeries ellipse_cloud() {
  programs::AxisSeries series;
  for (int i = 0; i < 400; ++i) {
    const double angle = 0.61 * i, radius = 0.05 * (i % 60);
    series.angular_acceleration.push_back(40 * radius * std::cos(angle));
    series.target.push_back(0.1 * radius * std::cos(angle + 0.2));
    series.predicted.push_back(0.1 * radius * std::cos(angle + 0.3));
  }
  return series;
}

void draw(const std::string& folder) {
  const programs::AxisSeries series = ellipse_cloud();
  programs::write_svg(folder + "/trajectory.svg", programs::trajectory_chart(spiral(8)));
  programs::write_svg(folder + "/slow_trajectory.svg", programs::trajectory_chart(spiral(3)));
  std::ofstream(folder + "/ellipses.html")
      << programs::inline_chart(programs::ellipses_chart({{"a & b </script>", {series, series, series}}}));
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fprintf(stderr, "usage: pictures_driver <folder>\n");
    return 2;
  }
  try {
    draw(arguments[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pictures_driver: %s\n", error.what());
    return 2;
  }
}
