// SPDX-License-Identifier: MIT
// Pictures of made-up flights and judgements, in which every colour and every bar occurs.
//   pictures_driver <folder>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "flight/pictures.hpp"
#include "training/plots.hpp"

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

std::vector<programs::Result> results(const std::vector<std::string>& models,
                                      const std::vector<std::array<double, 2>>& errors) {
  std::vector<programs::Result> made;
  for (std::size_t model = 0; model < models.size(); ++model) {
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      made.push_back({models[model], seed + 1, {}, 0, 0});
      made.back().test.errors.mean.mean_absolute = errors[model][seed];
    }
  }
  return made;
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

bool draw(const std::string& folder) {
  const std::vector<std::string> models = {"linearized", "vanilla", "physics_informed"};
  const programs::AxisSeries series = ellipse_cloud();
  programs::Judgement judged;
  for (pinnquad::PhysicalConsistency& axis : judged.axes) axis = pinnquad::physical_consistency(series);
  return programs::plot_trajectory(folder + "/trajectory.svg", spiral(8)) &&
         programs::plot_trajectory(folder + "/slow_trajectory.svg", spiral(3)) &&
         programs::plot_errors(folder + "/errors.svg",
                               results(models, {{0.0549, 0.0549}, {0.0082, 0.0078}, {0.0072, 0.0074}}), models) &&
         programs::plot_errors(folder + "/even_errors.svg",
                               results(models, {{0.009, 0.009}, {0.0082, 0.0078}, {0.0072, 0.0074}}), models) &&
         programs::plot_ellipses(folder + "/ellipses.svg", {"a & b"}, {{series, series, series}}, {judged}) &&
         programs::plot_prediction(folder + "/prediction.svg", {0, 0.05, 0.1}, {0.4, 0.5, 0.45}, {"vanilla"},
                                   {{0.41, 0.52, 0.44}});
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fprintf(stderr, "usage: pictures_driver <folder>\n");
    return 2;
  }
  try {
    return draw(arguments[1]) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pictures_driver: %s\n", error.what());
    return 2;
  }
}
