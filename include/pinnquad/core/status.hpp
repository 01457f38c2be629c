// SPDX-License-Identifier: MIT
// The outcome of a call in flight code, which has no exceptions.
// Every function that returns a Status leaves its output untouched unless has_output(status).
#pragma once

#include <cstdint>

#include "pinnquad/core/attributes.hpp"

namespace pinnquad {

/// Why a function has no answer, or how good one is. Nothing that flies throws.
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
    outside_limits,       ///< a command lies outside the output limits, and the guard refuses it
    limited,              ///< commands clipped to limits; they are written
    fell_back,  ///< the network declined; the commands written are the fallback's, or its beyond the edge (Fallback)
    block_truncated,     ///< a model block is shorter than it says, or not aligned
    block_incompatible,  ///< a block of another format, network or feature set
    block_corrupt,       ///< a block whose checksum or contents are wrong
    // no 15: recorded flights hold the numbers that follow
    warming_up = 16,  ///< a model with a past has not seen enough of it, or lost it in a gap (features/windowed.hpp)
    outside_distribution,  ///< the features lie further from the training rows than the guard allows, taken together
    distrusted,            ///< the model has lately been wrong about what was flown (inference/monitored_inverse.hpp)
};

/// More than any Status, for counters by Status.
inline constexpr int status_count = static_cast<int>(Status::distrusted) + 1;

/// True where the output was written: `ok`, `limited`, `fell_back`.
PINNQUAD_ALWAYS_INLINE constexpr bool has_output(Status status) noexcept {
  return status == Status::ok || status == Status::limited || status == Status::fell_back;
}

/// The enumerator's own name: what documents and logs say is one word, found by one search.
constexpr const char* to_string(Status status) noexcept {
  switch (status) {
    case Status::ok: return "ok";
    case Status::not_finite: return "not_finite";
    case Status::out_of_range: return "out_of_range";
    case Status::not_unit_quaternion: return "not_unit_quaternion";
    case Status::outside_envelope: return "outside_envelope";
    case Status::output_not_finite: return "output_not_finite";
    case Status::no_solution: return "no_solution";
    case Status::invalid_airframe: return "invalid_airframe";
    case Status::self_test_failed: return "self_test_failed";
    case Status::outside_limits: return "outside_limits";
    case Status::limited: return "limited";
    case Status::fell_back: return "fell_back";
    case Status::block_truncated: return "block_truncated";
    case Status::block_incompatible: return "block_incompatible";
    case Status::block_corrupt: return "block_corrupt";
    case Status::warming_up: return "warming_up";
    case Status::outside_distribution: return "outside_distribution";
    case Status::distrusted: return "distrusted";
  }
  return "unknown status";
}

}  // namespace pinnquad
