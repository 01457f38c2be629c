// SPDX-License-Identifier: MIT
// Several scalars computed with at once, as one scalar type: the dynamics, effects and controllers of one vehicle are
// those of as many vehicles as there are lanes. Each lane has the bits of the scalar code where the compiler fuses no
// products and sums (-ffp-contract=off).
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/core/select.hpp"
#include "pinnquad/core/types.hpp"

#if defined(PINNQUAD_UNIT_AVX512) || defined(PINNQUAD_UNIT_AVX2)
#include <immintrin.h>
#elif defined(PINNQUAD_UNIT_SSE2)
#include <emmintrin.h>
#endif

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {
/// Bytes of one register.
inline constexpr int register_bytes =
#if defined(PINNQUAD_UNIT_AVX512)
    64;
#elif defined(PINNQUAD_UNIT_AVX2)
    32;
#else
    16;
#endif

/// The compiler's own vectors: + - * /, comparisons and ?: on them are instructions.
template <class Scalar>
struct RegisterTypes {
  static constexpr int width = register_bytes / static_cast<int>(sizeof(Scalar));
  typedef Scalar Register __attribute__((vector_size(register_bytes)));
  using Truths = decltype(Register{} < Register{});
  static constexpr int of(int lanes) noexcept { return lanes / width; }
};

/// True where a bit is set.
template <class Truths>
PINNQUAD_ALWAYS_INLINE bool any_bit(const Truths& truths) noexcept {
#if defined(PINNQUAD_UNIT_AVX512)
  return _mm512_test_epi32_mask((__m512i)truths, (__m512i)truths) != 0;
#elif defined(PINNQUAD_UNIT_AVX2)
  return _mm256_testz_si256((__m256i)truths, (__m256i)truths) == 0;
#elif defined(PINNQUAD_UNIT_SSE2)
  return _mm_movemask_epi8((__m128i)truths) != 0;
#else
  bool any = false;
  for (unsigned i = 0; i < sizeof truths / sizeof truths[0]; ++i) any |= truths[i] != 0;
  return any;
#endif
}

/// One truth per lane of Lanes<Scalar, Count>.
template <class Scalar, int Count>
struct LaneMask {
  using Types = RegisterTypes<Scalar>;
  static constexpr int registers = Types::of(Count);
  typename Types::Truths part[static_cast<std::size_t>(registers)];

  LaneMask() = default;
  /// In every lane.
  PINNQUAD_ALWAYS_INLINE constexpr LaneMask(bool everywhere) noexcept : part{} {
    for (auto& truths : part) truths = typename Types::Truths{} - (everywhere ? 1 : 0);
  }
  /// The truths of lanes of another scalar.
  template <class Other>
  PINNQUAD_ALWAYS_INLINE explicit LaneMask(const LaneMask<Other, Count>& other) noexcept {
    for (int i = 0; i < Count; ++i) set_lane(i, other.lane(i));
  }

  PINNQUAD_ALWAYS_INLINE bool lane(int i) const noexcept { return part[i / Types::width][i % Types::width] != 0; }
  PINNQUAD_ALWAYS_INLINE void set_lane(int i, bool truth) noexcept {
    part[i / Types::width][i % Types::width] = truth ? -1 : 0;
  }

  friend PINNQUAD_ALWAYS_INLINE LaneMask operator&&(LaneMask a, const LaneMask& b) noexcept {
    for (int i = 0; i < registers; ++i) a.part[i] &= b.part[i];
    return a;
  }
  friend PINNQUAD_ALWAYS_INLINE LaneMask operator||(LaneMask a, const LaneMask& b) noexcept {
    for (int i = 0; i < registers; ++i) a.part[i] |= b.part[i];
    return a;
  }
  friend PINNQUAD_ALWAYS_INLINE LaneMask operator!(LaneMask a) noexcept {
    for (auto& truths : a.part) truths = ~truths;
    return a;
  }
  PINNQUAD_ALWAYS_INLINE LaneMask& operator&=(const LaneMask& b) noexcept { return *this = *this && b; }

  friend PINNQUAD_ALWAYS_INLINE bool any_of(const LaneMask& a) noexcept {
    auto truths = a.part[0];
    for (int i = 1; i < registers; ++i) truths |= a.part[i];
    return any_bit(truths);
  }
  friend PINNQUAD_ALWAYS_INLINE bool all_of(const LaneMask& a) noexcept { return !any_of(!a); }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// Lanes of a register of float or double.
template <class Scalar>
inline constexpr int native_lanes = detail::RegisterTypes<Scalar>::width;

/// `Count` float or double values, whole registers of them.
template <class ScalarType, int Count>
struct Lanes {
  using Scalar = ScalarType;
  using Types = detail::RegisterTypes<Scalar>;
  using Mask = detail::LaneMask<Scalar, Count>;
  static constexpr int count = Count;
  static constexpr int registers = Types::of(Count);
  static_assert(Count > 0 && Count % Types::width == 0,
                "pinnquad: lanes fill whole registers: take native_lanes<Scalar> or a multiple of it");
  typename Types::Register part[static_cast<std::size_t>(registers)];

  Lanes() = default;
  // register by register: gcc copies an array of vectors by halves, through integers
  PINNQUAD_ALWAYS_INLINE constexpr Lanes(const Lanes& other) noexcept : part{} {
    for (int i = 0; i < registers; ++i) part[i] = other.part[i];
  }
  PINNQUAD_ALWAYS_INLINE constexpr Lanes& operator=(const Lanes& other) noexcept {
    for (int i = 0; i < registers; ++i) part[i] = other.part[i];
    return *this;
  }
  /// The same number in every lane.
  template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
  PINNQUAD_ALWAYS_INLINE constexpr explicit Lanes(Number number) noexcept : part{} {
    // less zero, as zero plus -0 is 0
    for (auto& values : part) values = static_cast<Scalar>(number) - typename Types::Register{};
  }
  /// Each rounded to this scalar.
  template <class Other>
  PINNQUAD_ALWAYS_INLINE explicit Lanes(const Lanes<Other, Count>& other) noexcept {
    for (int i = 0; i < Count; ++i) set_lane(i, static_cast<Scalar>(other.lane(i)));
  }

  PINNQUAD_ALWAYS_INLINE Scalar lane(int i) const noexcept { return part[i / Types::width][i % Types::width]; }
  PINNQUAD_ALWAYS_INLINE void set_lane(int i, Scalar value) noexcept {
    part[i / Types::width][i % Types::width] = value;
  }

#define PINNQUAD_LANE_OPERATOR(op)                                                              \
  friend PINNQUAD_ALWAYS_INLINE constexpr Lanes operator op(Lanes a, const Lanes& b) noexcept { \
    for (int i = 0; i < registers; ++i) a.part[i] = a.part[i] op b.part[i];                     \
    return a;                                                                                   \
  }                                                                                             \
  PINNQUAD_ALWAYS_INLINE constexpr Lanes& operator op##=(const Lanes& b) noexcept {             \
    for (int i = 0; i < registers; ++i) part[i] = part[i] op b.part[i];                         \
    return *this;                                                                               \
  }
  PINNQUAD_LANE_OPERATOR(+)
  PINNQUAD_LANE_OPERATOR(-)
  PINNQUAD_LANE_OPERATOR(*)
  PINNQUAD_LANE_OPERATOR(/)
#undef PINNQUAD_LANE_OPERATOR
  friend PINNQUAD_ALWAYS_INLINE constexpr Lanes operator-(Lanes a) noexcept {
    for (auto& values : a.part) values = -values;
    return a;
  }

#define PINNQUAD_LANE_COMPARISON(op)                                                        \
  friend PINNQUAD_ALWAYS_INLINE Mask operator op(const Lanes& a, const Lanes& b) noexcept { \
    Mask mask;                                                                              \
    for (int i = 0; i < registers; ++i) mask.part[i] = a.part[i] op b.part[i];              \
    return mask;                                                                            \
  }
  PINNQUAD_LANE_COMPARISON(<)
  PINNQUAD_LANE_COMPARISON(<=)
  PINNQUAD_LANE_COMPARISON(>)
  PINNQUAD_LANE_COMPARISON(>=)
#undef PINNQUAD_LANE_COMPARISON

  friend PINNQUAD_ALWAYS_INLINE Lanes select(const Mask& mask, const Lanes& yes, const Lanes& no) noexcept {
    Lanes result;
    for (int i = 0; i < registers; ++i) result.part[i] = mask.part[i] ? yes.part[i] : no.part[i];
    return result;
  }

  friend PINNQUAD_ALWAYS_INLINE Lanes absolute(const Lanes& a) noexcept {
    Lanes result;
    for (int i = 0; i < registers; ++i) result.part[i] = (Register)((Truths)a.part[i] & ~sign());
    return result;
  }
  friend PINNQUAD_ALWAYS_INLINE Lanes sqrt(const Lanes& a) noexcept {
    Lanes result;
    for (int i = 0; i < registers; ++i) result.part[i] = root(a.part[i]);
    return result;
  }
  friend PINNQUAD_ALWAYS_INLINE Lanes floor(const Lanes& a) noexcept {
    Lanes result;
#if defined(PINNQUAD_UNIT_SSE2)
    // towards zero through integers, then down; a number beyond them becomes the least of them
    Truths beyond{};
    for (int i = 0; i < registers; ++i) {
      const Register& v = a.part[i];
      Register whole;
      if constexpr (std::is_same_v<Scalar, float>) {
        whole = (Register)_mm_cvtepi32_ps(_mm_cvttps_epi32((__m128)v));
      } else {
        whole = (Register)_mm_cvtepi32_pd(_mm_cvttpd_epi32((__m128d)v));
      }
      beyond |= whole <= Register{} - Scalar(0x1p31);
      whole -= whole > v ? Register{} + Scalar(1) : Register{};
      result.part[i] = (Register)((Truths)whole | ((Truths)v & sign()));
    }
    if (!detail::any_bit(beyond)) return result;
#endif
    for (int i = 0; i < registers; ++i) result.part[i] = rounded_down(a.part[i]);
    return result;
  }

  // The C library's functions, lane by lane: the bits of the scalar code.
#define PINNQUAD_LANE_FUNCTION(name)                                                        \
  friend PINNQUAD_ALWAYS_INLINE Lanes name(const Lanes& a) noexcept {                       \
    return of_each(a, [](Scalar v) noexcept { return static_cast<Scalar>(std::name(v)); }); \
  }
  PINNQUAD_LANE_FUNCTION(exp)
  PINNQUAD_LANE_FUNCTION(sin)
  PINNQUAD_LANE_FUNCTION(cos)
  PINNQUAD_LANE_FUNCTION(tanh)
#undef PINNQUAD_LANE_FUNCTION

 private:
  using Register = typename Types::Register;
  using Truths = typename Types::Truths;

  /// A register whose lanes have the bit of the sign alone.
  static PINNQUAD_ALWAYS_INLINE Truths sign() noexcept {
    return Truths{} + std::numeric_limits<std::decay_t<decltype(Truths{}[0])>>::min();
  }

  /// Once where all lanes are equal, as the time constants of alike vehicles are.
  template <class Function>
  static PINNQUAD_ALWAYS_INLINE Lanes of_each(const Lanes& a, const Function& function) noexcept {
    const Scalar first = a.lane(0);
    const Lanes same(first);
    if (all_of(a <= same && a >= same)) return Lanes(function(first));
    Scalar value[static_cast<std::size_t>(Count)];
    for (int i = 0; i < Count; ++i) value[i] = function(a.lane(i));
    Lanes result;
    for (int i = 0; i < Count; ++i) result.set_lane(i, value[i]);
    return result;
  }

  static PINNQUAD_ALWAYS_INLINE Register root(const Register& v) noexcept {
    constexpr bool single = std::is_same_v<Scalar, float>;
#if defined(PINNQUAD_UNIT_AVX512)
    if constexpr (single) {
      return (Register)_mm512_maskz_sqrt_ps(0xffff, (__m512)v);
    } else {
      return (Register)_mm512_maskz_sqrt_pd(0xff, (__m512d)v);
    }
#elif defined(PINNQUAD_UNIT_AVX2)
    if constexpr (single) {
      return (Register)_mm256_sqrt_ps((__m256)v);
    } else {
      return (Register)_mm256_sqrt_pd((__m256d)v);
    }
#elif defined(PINNQUAD_UNIT_SSE2)
    if constexpr (single) {
      return (Register)_mm_sqrt_ps((__m128)v);
    } else {
      return (Register)_mm_sqrt_pd((__m128d)v);
    }
#else
    Register result{};
    for (int i = 0; i < Types::width; ++i)
      result[i] = single ? Scalar(__builtin_sqrtf(float(v[i]))) : Scalar(__builtin_sqrt(double(v[i])));
    return result;
#endif
  }
  static PINNQUAD_ALWAYS_INLINE Register rounded_down(const Register& v) noexcept {
    constexpr bool single = std::is_same_v<Scalar, float>;
#if defined(PINNQUAD_UNIT_AVX512)
    if constexpr (single) {
      return (Register)_mm512_maskz_roundscale_ps(0xffff, (__m512)v, _MM_FROUND_TO_NEG_INF);
    } else {
      return (Register)_mm512_maskz_roundscale_pd(0xff, (__m512d)v, _MM_FROUND_TO_NEG_INF);
    }
#elif defined(PINNQUAD_UNIT_AVX2)
    if constexpr (single) {
      return (Register)_mm256_floor_ps((__m256)v);
    } else {
      return (Register)_mm256_floor_pd((__m256d)v);
    }
#else
    Register result{};
    for (int i = 0; i < Types::width; ++i)
      result[i] = single ? Scalar(__builtin_floorf(float(v[i]))) : Scalar(__builtin_floor(double(v[i])));
    return result;
#endif
  }
};

/// The Status of each lane.
template <class Scalar, int Count>
class [[nodiscard]] LaneStatus {
 public:
  using Types = detail::RegisterTypes<Scalar>;
  using Mask = detail::LaneMask<Scalar, Count>;

  LaneStatus() = default;
  PINNQUAD_ALWAYS_INLINE constexpr LaneStatus(Status everywhere) noexcept : part_{} {
    for (auto& values : part_) values = typename Types::Truths{} + static_cast<int>(everywhere);
  }
  PINNQUAD_ALWAYS_INLINE Status lane(int i) const noexcept {
    return static_cast<Status>(part_[i / Types::width][i % Types::width]);
  }
  friend PINNQUAD_ALWAYS_INLINE Mask operator==(const LaneStatus& a, Status status) noexcept {
    const LaneStatus b(status);
    Mask mask;
    for (int i = 0; i < Mask::registers; ++i) mask.part[i] = a.part_[i] == b.part_[i];
    return mask;
  }
  friend PINNQUAD_ALWAYS_INLINE Mask operator!=(const LaneStatus& a, Status status) noexcept { return !(a == status); }
  friend PINNQUAD_ALWAYS_INLINE LaneStatus select(const Mask& mask, const LaneStatus& yes,
                                                  const LaneStatus& no) noexcept {
    LaneStatus result;
    for (int i = 0; i < Mask::registers; ++i) result.part_[i] = mask.part[i] ? yes.part_[i] : no.part_[i];
    return result;
  }

 private:
  typename Types::Truths part_[Mask::registers];
};

}  // namespace PINNQUAD_INSTRUCTION_SET

// Outside of the namespace of the instruction set, where they would hide those of scalars; their arguments are named by
// it.

/// One Status or the other in each lane.
template <class Scalar, int Count>
PINNQUAD_ALWAYS_INLINE LaneStatus<Scalar, Count> select(const detail::LaneMask<Scalar, Count>& mask, Status yes,
                                                        Status no) noexcept {
  return select(mask, LaneStatus<Scalar, Count>(yes), LaneStatus<Scalar, Count>(no));
}

/// Vectors, and numbers of each rotor: each lane's own.
template <class Scalar, int Count, int Rows, int Columns, int Options>
PINNQUAD_ALWAYS_INLINE Eigen::Matrix<Lanes<Scalar, Count>, Rows, Columns, Options> select(
    const detail::LaneMask<Scalar, Count>& mask, const Eigen::Matrix<Lanes<Scalar, Count>, Rows, Columns, Options>& yes,
    const Eigen::Matrix<Lanes<Scalar, Count>, Rows, Columns, Options>& no) noexcept {
  Eigen::Matrix<Lanes<Scalar, Count>, Rows, Columns, Options> result;
  for (int i = 0; i < Rows * Columns; ++i) result.data()[i] = select(mask, yes.data()[i], no.data()[i]);
  return result;
}
/// Takes each lane of an array's numbers from `yes` or `no`.
template <class Scalar, int Count, std::size_t Size>
PINNQUAD_ALWAYS_INLINE std::array<Lanes<Scalar, Count>, Size> select(
    const detail::LaneMask<Scalar, Count>& mask, const std::array<Lanes<Scalar, Count>, Size>& yes,
    const std::array<Lanes<Scalar, Count>, Size>& no) noexcept {
  std::array<Lanes<Scalar, Count>, Size> result;
  for (std::size_t i = 0; i < Size; ++i) result[i] = select(mask, yes[i], no[i]);
  return result;
}

/// Lane by lane, on the bits.
template <class Scalar, int Count>
PINNQUAD_ALWAYS_INLINE detail::LaneMask<Scalar, Count> is_finite(const Lanes<Scalar, Count>& value) noexcept {
  using Truths = typename detail::LaneMask<Scalar, Count>::Types::Truths;
  constexpr auto exponent = sizeof(Scalar) == 4 ? 0x7f800000ll : 0x7ff0000000000000ll;
  detail::LaneMask<Scalar, Count> mask;
  for (int i = 0; i < mask.registers; ++i) {
    const Truths all = Truths{} + static_cast<std::conditional_t<sizeof(Scalar) == 4, int, long long>>(exponent);
    mask.part[i] = ((Truths)value.part[i] & all) != all;
  }
  return mask;
}

namespace detail {
/// Those of lanes.
template <class Scalar, int Count>
struct LaneTypes<Lanes<Scalar, Count>> {
  using Mask = LaneMask<Scalar, Count>;
  using Wide = Lanes<double, Count>;
  using Outcome = LaneStatus<Scalar, Count>;
};
}  // namespace detail

}  // namespace pinnquad

namespace std {
template <class Scalar, int Count>
struct numeric_limits<pinnquad::Lanes<Scalar, Count>> : numeric_limits<Scalar> {};
}  // namespace std
