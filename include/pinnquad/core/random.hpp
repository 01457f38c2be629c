// SPDX-License-Identifier: MIT
// Portable distributions: the same engine state gives the same bits with every compiler and standard library.
// Engines are passed in by the caller and must yield 64 uniform bits (std::mt19937_64 does).
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace pinnquad {

namespace detail {
template <class Engine>
constexpr void require_64_bit_engine() noexcept {
  static_assert(Engine::min() == 0 && Engine::max() == ~std::uint64_t{0},
                "pinnquad: a random engine must yield 64 uniform bits, as std::mt19937_64 does");
}
}  // namespace detail

/// Uniform in [0, 1), 53 random bits.
template <class Engine>
double uniform_01(Engine& engine) {
  detail::require_64_bit_engine<Engine>();
  return static_cast<double>(engine() >> 11) * 0x1p-53;
}

/// Uniform between lower and upper; upper itself only by rounding. Products and sums here must not be contracted
/// (-ffp-contract=off) where bits count.
template <class Engine>
double uniform(Engine& engine, double lower, double upper) {
  return lower + (upper - lower) * uniform_01(engine);
}

/// Uniform integer in [0, count), without modulo bias; count > 0.
template <class Engine>
std::uint64_t uniform_index(Engine& engine, std::uint64_t count) {
  detail::require_64_bit_engine<Engine>();
  const std::uint64_t threshold = (~count + 1) % count;  // 2^64 mod count
  std::uint64_t bits = engine();
  while (bits < threshold) bits = engine();
  return bits % count;
}

/// Normal with mean 0 and variance 1 (Box-Muller; one of the pair is dropped so that no state is kept).
template <class Engine>
double standard_normal(Engine& engine) {
  constexpr double two_pi = 6.283185307179586;
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform_01(engine)));
  return radius * std::cos(two_pi * uniform_01(engine));
}

/// Fisher-Yates shuffle of a random-access container.
template <class Container, class Engine>
void shuffle(Container& values, Engine& engine) {
  using std::swap;
  for (auto remaining = static_cast<std::uint64_t>(values.size()); remaining > 1; --remaining) {
    const auto last = static_cast<decltype(values.size())>(remaining - 1);
    const auto chosen = static_cast<decltype(values.size())>(uniform_index(engine, remaining));
    swap(values[last], values[chosen]);
  }
}

}  // namespace pinnquad
