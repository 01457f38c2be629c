// SPDX-License-Identifier: MIT
// Both choices of PINNQUAD_KERNEL_BITS in one program: this file compiled with each, and with MAIN. Prediction,
// value and Jacobian, batch and training's gradient agree to rounding.
#include <array>
#include <cmath>
#include <cstdio>

#include "pinnquad/nn/batched_network.hpp"
#include "pinnquad/nn/jacobian.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/training/network_gradient.hpp"

namespace {
using Net =
    pinnquad::Mlp<float, pinnquad::InputSize<16>, pinnquad::Hidden<10, 25>, pinnquad::OutputSize<4>, pinnquad::Relu>;
constexpr int samples = 37, more = 40;  // whole packs and a rest
/// Outputs of each kernel, of one choice of bits.
struct Results {
  int width;  // of a pack
  std::array<float, 4> predicted;
  std::array<float, 4 + 4 * 16> with_jacobian;
  std::array<float, 4 * samples> batch;
  Net::Parameters gradient;
};
}  // namespace

extern "C" void by_256(Results& results);
extern "C" void by_512(Results& results);

#if !defined(MAIN)
#if PINNQUAD_KERNEL_BITS == 256
extern "C" void by_256(Results& results) {
#else
extern "C" void by_512(Results& results) {
#endif
  static Net::Parameters weights;
  static float x[16 * more];
  unsigned state = 12345;
  const auto draw = [&state] {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) / 16777216.0f - 0.5f;
  };
  for (float& weight : weights) weight = draw();
  for (float& value : x) value = draw();
  static pinnquad::PackedNetwork<Net> packed(weights);
  results.width = pinnquad::NativePack<float>::width;
  packed.forward(x, results.predicted.data());
  float* const jacobian = results.with_jacobian.data() + 4;
  pinnquad::JacobianPass<Net>::run(packed, weights.data(), x, results.with_jacobian.data(), jacobian);
  pinnquad::BatchedNetwork<Net>::forward(weights.data(), x, results.batch.data(), samples);
  static pinnquad::detail::NetworkGradient<Net, 64> trained;
  trained.load(weights);
  for (const int count : {more, samples}) {  // the first leaves its gradients behind the samples of the second
    trained.put(x, count);
    trained.forward(count);
    for (int k = 0; k < 4; ++k) {
      for (int i = 0; i < count; ++i) trained.output_delta(k, i) = draw();
    }
    trained.backward(count);
  }
  trained.store_gradient(results.gradient);
}
#else
template <std::size_t Size>
bool agree(const char* what, const std::array<float, Size>& a, const std::array<float, Size>& b) {
  float largest = 0, apart = 0;
  for (std::size_t i = 0; i < Size; ++i) {
    largest = std::fmax(largest, std::fabs(a[i]));
    apart = std::fabs(a[i] - b[i]) <= apart ? apart : std::fabs(a[i] - b[i]);  // NaN stays
  }
  const bool good = largest > 0 && apart <= 1e-5f * largest;
  std::printf("%s: %g apart of %g%s\n", what, double(apart), double(largest), good ? "" : ": too far");
  return good;
}

int main() {
  static Results narrow, wide;
  by_256(narrow);
  by_512(wide);
  std::printf("floats in a pack: %d, %d\n", narrow.width, wide.width);
  bool good = narrow.width == 8 && wide.width == 16;
  good &= agree("prediction", narrow.predicted, wide.predicted);
  good &= agree("value and Jacobian", narrow.with_jacobian, wide.with_jacobian);
  good &= agree("batch", narrow.batch, wide.batch);
  good &= agree("gradient", narrow.gradient, wide.gradient);
  return good ? 0 : 1;
}
#endif
