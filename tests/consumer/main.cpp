// SPDX-License-Identifier: MIT
//
// The least that a user can do: include the flight rooms and an autopilot's core, use one name, say the version.
#include <cstdio>
#include <pinnquad/control/autopilot/recorded_controller.hpp>
#include <pinnquad/flight.hpp>
#include <pinnquad/version.hpp>

int main() {
  const pinnquad::Status status = pinnquad::Status::ok;
  std::printf("pinnquad %s: %s\n", PINNQUAD_VERSION, pinnquad::to_string(status));
  return status == pinnquad::Status::ok ? 0 : 1;
}
