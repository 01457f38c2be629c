// SPDX-License-Identifier: MIT
// A recorded flight as rows in time order, and the number that names its content.
// The number goes into exported headers: it says which flight a model was trained on.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "pinnquad/core/fnv1a.hpp"
#include "pinnquad/data/sample.hpp"

namespace pinnquad {

/// Rows of one flight, time strictly increasing.
using Flight = std::vector<Sample>;

/// Provenance of a flight: 64-bit FNV-1a over the number of rows and the IEEE 754 bits of every value, each as eight
/// bytes, least significant first, rows in order, values in the order of `sample_field_names`.
/// The same on every compiler and byte order. All NaNs count as one; 0 and -0 differ. No protection against forgery.
inline std::uint64_t content_hash(const Flight& flight) {
  static_assert(sizeof(double) == sizeof(std::uint64_t) && std::numeric_limits<double>::is_iec559,
                "content_hash: double must be IEEE 754 binary64");
  constexpr std::uint64_t canonical_nan = 0x7ff8000000000000u;
  detail::Fnv1a fnv;
  fnv.absorb_word(flight.size());
  for (const Sample& sample : flight) {
    for (const double value : to_values(sample)) {
      std::uint64_t bits = canonical_nan;
      if (!std::isnan(value)) std::memcpy(&bits, &value, sizeof bits);
      fnv.absorb_word(bits);
    }
  }
  return fnv.hash;
}

}  // namespace pinnquad
