// SPDX-License-Identifier: MIT
// The README's example: an exported model in flight code.
#include <cstdio>
#include "model.hpp"  // demo_out/model.hpp, written by ./scripts/demo; includes pinnquad/flight.hpp

int main() {
  const pinnquad::InverseDynamics<TrainedQuadModel> inverse;  // no state, no heap; weights stay in flash
  if (pinnquad::self_test(inverse) != pinnquad::Status::ok) return 1;

  TrainedQuadModel::Inputs wanted;                             // hover, level, and ...
  wanted.angular_acceleration_rad_s2[0] = 5.0f;                // ... roll to the right
  pinnquad::Commands<float> u{};                               // motor commands, 0..1
  const pinnquad::Status status = inverse.predict(wanted, u);  // noexcept; u untouched unless ok
  std::printf("%s: %.3f %.3f %.3f %.3f\n", pinnquad::to_string(status), double(u[0]), double(u[1]), double(u[2]),
              double(u[3]));
}
