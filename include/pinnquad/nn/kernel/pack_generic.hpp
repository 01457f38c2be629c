// SPDX-License-Identifier: MIT
// A pack of scalars without instruction set: plain loops that a compiler may vectorise.
// The interface is that of pack_contract.hpp; used for other scalars than float and double, and where no vector unit is
// targeted.
#pragma once

#include <cstddef>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/core/scalar_math.hpp"

namespace pinnquad {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// `Width` scalars that are computed with at once. Product and sum are rounded separately.
template <class ScalarType, int Width>
struct GenericPack {
  using Scalar = ScalarType;
  static constexpr VectorUnit unit = VectorUnit::none;
  static constexpr bool fused = false;
  static constexpr int width = Width;
  static constexpr int tile_rows = 4;  ///< register tile of tile.hpp
  static constexpr int tile_vectors = 1;

  Scalar lane[static_cast<std::size_t>(Width)];

  static PINNQUAD_ALWAYS_INLINE GenericPack load(const Scalar* p) noexcept {
    GenericPack r;
    for (int i = 0; i < Width; ++i) r.lane[i] = p[i];
    return r;
  }
  static PINNQUAD_ALWAYS_INLINE GenericPack broadcast(Scalar v) noexcept {
    GenericPack r;
    for (int i = 0; i < Width; ++i) r.lane[i] = v;
    return r;
  }
  PINNQUAD_ALWAYS_INLINE void store(Scalar* p) const noexcept {
    for (int i = 0; i < Width; ++i) p[i] = lane[i];
  }
  /// a * b + c
  static PINNQUAD_ALWAYS_INLINE GenericPack multiply_add(GenericPack a, GenericPack b, GenericPack c) noexcept {
    GenericPack r;
    for (int i = 0; i < Width; ++i) {
      const Scalar product = a.lane[i] * b.lane[i];
      r.lane[i] = product + c.lane[i];
    }
    return r;
  }
  friend PINNQUAD_ALWAYS_INLINE GenericPack operator+(GenericPack a, GenericPack b) noexcept {
    for (int i = 0; i < Width; ++i) a.lane[i] += b.lane[i];
    return a;
  }
  friend PINNQUAD_ALWAYS_INLINE GenericPack operator-(GenericPack a, GenericPack b) noexcept {
    for (int i = 0; i < Width; ++i) a.lane[i] -= b.lane[i];
    return a;
  }
  friend PINNQUAD_ALWAYS_INLINE GenericPack operator*(GenericPack a, GenericPack b) noexcept {
    for (int i = 0; i < Width; ++i) a.lane[i] *= b.lane[i];
    return a;
  }
  friend PINNQUAD_ALWAYS_INLINE GenericPack operator/(GenericPack a, GenericPack b) noexcept {
    for (int i = 0; i < Width; ++i) a.lane[i] /= b.lane[i];
    return a;
  }
  static PINNQUAD_ALWAYS_INLINE GenericPack square_root(GenericPack a) noexcept {
    for (int i = 0; i < Width; ++i) a.lane[i] = detail::square_root(a.lane[i]);
    return a;
  }
  /// See pack_avx512.hpp: plain loops are the compiler's to order.
  PINNQUAD_ALWAYS_INLINE void settle() noexcept {}
  /// v < 0 ? 0 : v. NaN goes through.
  static PINNQUAD_ALWAYS_INLINE GenericPack positive_part(GenericPack a) noexcept {
    for (int i = 0; i < Width; ++i) a.lane[i] = detail::positive_part(a.lane[i]);
    return a;
  }
  /// gate > 0 ? a : 0.
  static PINNQUAD_ALWAYS_INLINE GenericPack where_positive(GenericPack gate, GenericPack a) noexcept {
    for (int i = 0; i < Width; ++i) a.lane[i] = gate.lane[i] > Scalar(0) ? a.lane[i] : Scalar(0);
    return a;
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
