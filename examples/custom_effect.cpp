// SPDX-License-Identifier: MIT
// An aerodynamic effect of one's own: a thermal, a column of rising air.
// The vehicle takes it because it has surroundings(); simulator and inverse then both fly through it.
#include <cmath>
#include <cstdio>

#include "pinnquad/flight.hpp"

using namespace pinnquad;

/// Rises with w exp(-(d / R)^2) at a distance d from its axis.
struct Thermal {
  double north_m = 40, east_m = 0, radius_m = 15, climb_m_s = 3;

  template <class Scalar>
  void surroundings(Surroundings<Scalar>& air) const noexcept {
    using std::exp;
    const Scalar north = air.position_m[0] - Scalar(north_m), east = air.position_m[1] - Scalar(east_m);
    const Scalar share = (north * north + east * east) / Scalar(radius_m * radius_m);
    air.wind_m_s[2] -= Scalar(climb_m_s) * exp(-share);  // NED: up is negative
  }
};

int main() {
  const Quadrotor<double, Thermal, QuadraticDrag> quadrotor(airframe_value<PaperQuadrotor, double>());
  State<double> state;
  for (double north_m = 0; north_m <= 80; north_m += 20) {
    state.position_m = {north_m, 0, -50};
    Commands<double> hover{};
    if (inverse_commands(quadrotor, state, Accelerations<double>{}, 0.0, hover) != Status::ok) return 1;
    std::printf("%2.0f m north: hovers at command %.4f\n", north_m, hover[0]);
  }
}
