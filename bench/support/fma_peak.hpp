// SPDX-License-Identifier: MIT
// The ceiling of this machine: multiply-adds per second of one core at the vector width in use, from registers only.
#pragma once

#include <benchmark/benchmark.h>

#include "pinnquad/nn/kernel/pack.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"

namespace pinnquad::bench {

/// One iteration is `MultiplyAdds`, rounded up to whole rounds of twelve independent chains (latency 4 x 2 units = 8
/// are needed): its time is what a forward pass of so many would take at the machine's peak. The exact figure, without
/// the rounding, is the counter `forward_pass_ns`.
template <class Pack, int MultiplyAdds>
void fma_peak(benchmark::State& state) {
  constexpr int chains = 12;
  constexpr int per_round = chains * Pack::width;
  constexpr int rounds = (MultiplyAdds + per_round - 1) / per_round;
  using Scalar = typename Pack::Scalar;
  auto shrink = static_cast<Scalar>(0.999), add = static_cast<Scalar>(1e-3);
  benchmark::DoNotOptimize(shrink);
  benchmark::DoNotOptimize(add);
  const Pack factor = Pack::broadcast(shrink);
  const Pack term = Pack::broadcast(add);
  Pack sum[chains];
  unroll<chains>([&](auto i)
                     PINNQUAD_INLINE_LAMBDA { sum[i] = Pack::broadcast(static_cast<Scalar>(decltype(i)::value)); });
  for (auto _ : state) {
    for (int round = 0; round < rounds; ++round) {
      unroll<chains>([&](auto i) PINNQUAD_INLINE_LAMBDA { sum[i] = Pack::multiply_add(sum[i], factor, term); });
    }
  }
  Scalar result[chains * Pack::width];
  unroll<chains>([&](auto i) PINNQUAD_INLINE_LAMBDA { sum[i].store(result + i * Pack::width); });
  benchmark::DoNotOptimize(result);
  // an inverted rate is seconds per 1e9 / MultiplyAdds iterations, which is nanoseconds per forward pass
  const double passes = static_cast<double>(state.iterations()) * rounds * per_round / MultiplyAdds;
  state.counters["forward_pass_ns"] =
      benchmark::Counter(passes * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

}  // namespace pinnquad::bench
