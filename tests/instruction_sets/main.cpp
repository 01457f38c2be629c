// SPDX-License-Identifier: MIT
// Calls the baseline's prediction and compares it with plain loops. The other instruction sets' are linked in, not called:
// if the linker took one of their functions for the baseline's, this program dies on a machine without them.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

#include "prediction.hpp"

extern "C" {
void predict_baseline(const float* x, float* y);
#if defined(WITH_OTHERS)
void predict_avx2(const float* x, float* y);
void predict_avx512(const float* x, float* y);
#endif
}

namespace {

/// Four outputs of a network in double: layer sizes, weights as the library lays them out, one activation.
template <class Parameters, class Activation>
bool agrees(const std::vector<std::size_t>& sizes, const Parameters& parameters, const float* x, const float* y,
            const Activation& activation) {
  std::vector<double> values(x, x + sizes[0]);
  std::size_t next = 0;
  for (std::size_t layer = 1; layer < sizes.size(); ++layer) {
    std::vector<double> sums(sizes[layer]);
    const std::size_t bias = next + sizes[layer] * values.size();
    for (std::size_t row = 0; row < sums.size(); ++row) {
      sums[row] = static_cast<double>(parameters[bias + row]);
      for (const double v : values) sums[row] += static_cast<double>(parameters[next++]) * v;
      if (layer + 1 < sizes.size()) sums[row] = activation(sums[row]);
    }
    next = bias + sums.size();
    values = sums;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    // sums of at most 70 terms of order 1, five layers: far below this; a wrong instruction is far above
    if (!(std::fabs(values[i] - static_cast<double>(y[i])) <= 1e-4 * (1.0 + std::fabs(values[i])))) {
      std::printf("output %zu is %.9g instead of %.9g\n", i, static_cast<double>(y[i]), values[i]);
      return false;
    }
  }
  return true;
}

bool golden_commands(const float* commands) {
  for (std::size_t i = 0; i < 4; ++i) {
    const float difference = commands[i] - instruction_sets::Model::golden_commands[0][i];
    if (!(std::fabs(static_cast<double>(difference)) <= pinnquad::golden_tolerance)) {
      std::printf("command %zu of the exported model is off by %.3g\n", i, static_cast<double>(difference));
      return false;
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace instruction_sets;
  void (*predict)(const float*, float*) = predict_baseline;
#if defined(WITH_OTHERS)
  if (argc > 1 && std::strcmp(argv[1], "avx2") == 0) predict = predict_avx2;
  if (argc > 1 && std::strcmp(argv[1], "avx512") == 0) predict = predict_avx512;
#else
  static_cast<void>(argc);
  static_cast<void>(argv);
#endif
  float x[16];
  for (int i = 0; i < 16; ++i) x[i] = 0.125f * static_cast<float>(i) - 1.0f;
  float y[outputs] = {};
  predict(x, y);
  const auto relu = [](double v) { return v < 0.0 ? 0.0 : v; };
  const auto tanh = [](double v) { return std::tanh(v); };
  const bool ok = agrees({16, 25, 25, 25, 4}, some_parameters<Net>(), x, y, relu) &&
                  agrees({16, 70, 4}, some_parameters<WideNet>(), x, y + 4, tanh) &&
                  agrees({16, 25, 25, 25, 4}, some_parameters<Net>(), x, y + 8, relu) && golden_commands(y + 12);
  std::puts(ok ? "predicts" : "predicts something else");
  return ok ? 0 : 1;
}
