// SPDX-License-Identifier: MIT
// An aerodynamic effect of one's own: linear rotor drag, which a spinning rotor feels along its disc.
// The vehicle takes it because it has wrench(); simulator and inverse then both fly with it.
#include <cstdio>

#include "pinnquad/flight.hpp"

using namespace pinnquad;

/// F = -k_r T (v_x, v_y, 0), T the rotors' thrust, v the air-relative body velocity.
struct LinearRotorDrag {
  static constexpr bool uses_rotor_wrench = true;
  double coefficient_s_m = 0.02;

  template <class Scalar>
  Wrench<Scalar> wrench(const AeroCondition<Scalar>& condition, const Airframe<Scalar>&) const noexcept {
    const Scalar thrust = -condition.rotors.force_N[2];
    Wrench<Scalar> result;
    for (int i = 0; i < 2; ++i) {
      result.force_N[i] = -Scalar(coefficient_s_m) * thrust * condition.air_relative_velocity_m_s[i];
    }
    return result;
  }
};

int main() {
  const Quadrotor<double, QuadraticDrag, LinearRotorDrag> quadrotor(airframe_value<PaperQuadrotor, double>());
  VehicleState<double> state;
  state.body.velocity_m_s[0] = 8;
  const Accelerations<double> level{};
  if (inverse_commands(quadrotor, state.body, level, 0.0, state.rotors) != Status::ok) return 1;
  const Commands<double> hover = state.rotors;
  for (int second = 0; second <= 3; ++second) {
    std::printf("t = %.1f s: %.3f m/s forward\n", state.time_s, state.body.velocity_m_s[0]);
    for (int i = 0; i < 1000; ++i) {
      if (quadrotor.step(state, hover, 0.001) != Status::ok) return 1;
    }
  }
}
