// SPDX-License-Identifier: MIT
// What can be wrong with an input of flight code, which has no exceptions.
// Every function that returns a Status leaves its output untouched unless the Status is `ok`.
#pragma once

#include <cstdint>

namespace pinnquad {

enum class [[nodiscard]] Status : std::uint8_t{
    ok = 0,
    not_finite,           ///< an input is NaN or infinite
    out_of_range,         ///< an argument lies outside what makes sense, such as a negative time step
    not_unit_quaternion,  ///< the attitude's norm is not 1 (tolerance: see unit_quaternion_tolerance)
    outside_envelope,     ///< a feature lies outside what the model was trained on
    output_not_finite,    ///< finite inputs led to NaN or Inf
    no_solution,          ///< the inverse problem has no solution (thrust equation, allocation)
    invalid_airframe,     ///< mass, inertia, rotors or allocation can't be those of a quadrotor that flies
    self_test_failed,     ///< a golden vector was not reproduced
};

/// Plain words for logs.
constexpr const char* to_string(Status status) noexcept {
  switch (status) {
    case Status::ok: return "ok";
    case Status::not_finite: return "input not finite";
    case Status::out_of_range: return "argument out of range";
    case Status::not_unit_quaternion: return "attitude is not a unit quaternion";
    case Status::outside_envelope: return "outside the training envelope";
    case Status::output_not_finite: return "output not finite";
    case Status::no_solution: return "no solution";
    case Status::invalid_airframe: return "invalid airframe";
    case Status::self_test_failed: return "self test failed";
  }
  return "unknown status";
}

}  // namespace pinnquad
