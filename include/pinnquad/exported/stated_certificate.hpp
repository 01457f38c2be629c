// SPDX-License-Identifier: MIT
// The certificate that a block states against the one that its weights give (exported/certificate.hpp).
#pragma once

#include <cstring>

#include "pinnquad/exported/certificate.hpp"

namespace pinnquad {
namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Numbers of a certificate that a compiler may round otherwise differ by less than this share of the larger one.
inline constexpr double certificate_tolerance = 1e-6;

/// `stated`: the bytes of a block's record. False for NaN, and for a number that the weights do not give.
inline bool states_certificate(const unsigned char* stated, const Certificate& own) noexcept {
  constexpr std::size_t count = 8 + rotor_count;
  double numbers[count]{};
  double* to = static_cast<double*>(numbers);
  for (const double slope : own.slope) *to++ = slope;
  for (const double slope : own.held_slope) *to++ = slope;
  *to++ = own.thrust_slope;
  *to++ = own.held_thrust_slope;
  for (const double bound : own.command_bound) *to++ = bound;
  bool same = true;
  for (std::size_t i = 0; i < count; ++i) {
    double value = 0;
    std::memcpy(&value, stated + 8 * i, sizeof value);
    if (!is_finite(numbers[i]) || !is_finite(value)) {  // of a formula nothing is said: -infinity, to the bit
      same = same && std::memcmp(&value, &numbers[i], sizeof value) == 0;
      continue;
    }
    const double difference = value - numbers[i];
    const double larger_one = larger(magnitude(value), magnitude(numbers[i]));
    same = same && magnitude(difference) <= certificate_tolerance * larger_one;
  }
  return same;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
