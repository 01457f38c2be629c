// SPDX-License-Identifier: MIT
// Paths of the modules: hover, a figure-eight, one place after another.
#pragma once

#include <random>
#include <vector>

#include "../support/hover.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/simulation/flights.hpp"

namespace pinnquad::autopilot::test {

using pinnquad::TrajectoryPoint;

inline TrajectoryPoint<double> hover(double /*time_s*/) { return pinnquad::test::Hover<double>{{0, 0, -10}}.sample(0); }

/// A lying eight around the start; its length says how fast.
struct Eight {
  pinnquad::FigureEight<double> path;
  Eight(double half_length_m, double period_s) {
    path.center_m = {0, 0, -10};
    path.half_length_m = half_length_m;
    path.half_width_m = half_length_m / 2;
    path.half_height_m = half_length_m / 8;
    path.period_s = period_s;
  }
  TrajectoryPoint<double> operator()(double time_s) const { return path.sample(time_s); }
};

/// 24 m by 12 m at up to 8 m/s, where the airframe has no thrust to spare.
struct FastEight : Eight {
  FastEight() : Eight(12, 13) {}
};

/// Another place and yaw every 2 s, in a box: steps, no path.
struct RandomPlaces {
  std::vector<TrajectoryPoint<double>> places;
  explicit RandomPlaces(double half_box_m) {
    std::mt19937_64 engine(3);
    for (int i = 0; i < 20; ++i) {
      TrajectoryPoint<double> point;
      const auto draw = [&](double half) { return pinnquad::uniform(engine, -half, half); };
      point.position_m = {draw(half_box_m), draw(half_box_m), -10 + draw(half_box_m / 4)};
      point.yaw_rad = draw(1.0);
      places.push_back(point);
    }
    places[0] = hover(0);
  }
  TrajectoryPoint<double> operator()(double time_s) const { return places[static_cast<std::size_t>(time_s / 2)]; }
};

}  // namespace pinnquad::autopilot::test
