// SPDX-License-Identifier: MIT
// Prints the output bits of the portable kernel for networks that take each of its paths: same_bits.sh compiles this
// for several machines, by several compilers, and compares.
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "pinnquad/nn/network.hpp"
#include "pinnquad/nn/relu.hpp"
#include "samples.hpp"

namespace {

using pinnquad::Dense;
using pinnquad::Hidden;
using pinnquad::InputSize;
using pinnquad::Mlp;
using pinnquad::Network;
using pinnquad::OutputSize;
using pinnquad::Relu;

#if !defined(ROUNDED_TWICE) && !defined(__FP_FAST_FMAF) && !defined(__FMA__) && !defined(__ARM_FEATURE_FMA)
#error "no fused multiply-add: other bits are right here, and nothing would be compared"
#endif

/// Every NaN prints alike: its payload is the processor's own.
template <class Scalar>
void print(Scalar value) {
  if (value != value) {
    std::printf(" nan");
    return;
  }
  unsigned char bytes[sizeof(Scalar)];
  std::memcpy(bytes, &value, sizeof bytes);
  std::printf(" ");
  for (std::size_t i = sizeof bytes; i-- > 0;) std::printf("%02x", static_cast<unsigned>(bytes[i]));
}

template <class Net>
void print_network(const char* name) {
  using Scalar = typename Net::Scalar;
  static Net network;
  samples::Numbers numbers(5);
  for (Scalar& v : network.parameters) v = Scalar(numbers.next()) * Scalar(0.375);
  const auto run = [&](const samples::Kind& kind, std::uint32_t seed) {
    float drawn[static_cast<std::size_t>(Net::inputs)];
    Scalar x[static_cast<std::size_t>(Net::inputs)], y[static_cast<std::size_t>(Net::outputs)];
    samples::fill(kind, seed, drawn);
    for (int i = 0; i < Net::inputs; ++i) x[i] = Scalar(drawn[i]);
    network.forward(x, y);
    std::printf("%s %s", name, kind.name);
    for (const Scalar v : y) print(v);
    std::printf("\n");
  };
  for (std::uint32_t seed = 0; seed < 50; ++seed) run(samples::kinds[0], seed);
  for (const samples::Kind& kind : samples::kinds) run(kind, 50);
}

}  // namespace

int main() {
  using WithoutBias = pinnquad::DenseWithoutBias<9>;
  print_network<Mlp<float, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>>("paper");
  print_network<Mlp<double, InputSize<16>, Hidden<3, 25>, OutputSize<4>, Relu>>("double");
  print_network<Mlp<float, InputSize<16>, Hidden<2, 64>, OutputSize<4>, Relu>>("wide");
  print_network<Network<float, InputSize<7>, WithoutBias, Relu, WithoutBias, Dense<3>, Relu>>("without_bias");
  return 0;
}
