// SPDX-License-Identifier: MIT
// Chooses among three objects by what the processor has, and predicts with the one chosen, which argv[1] names:
// "avx2_".
#include <cmath>
#include <cstdio>
#include <cstring>

#include "compiled.hpp"
#include "pinnquad/inference/choose_prediction.hpp"

namespace {

using Model = pinnquad::test::SmallModel;
constexpr int features = Model::Features::size;

bool golden(const float* commands) {
  for (std::size_t i = 0; i < 4; ++i) {
    const double difference = static_cast<double>(commands[i]) - static_cast<double>(Model::golden_commands[0][i]);
    if (!(std::fabs(difference) <= pinnquad::golden_tolerance)) {
      std::printf("command %zu is off by %.3g\n", i, difference);
      return false;
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  using pinnquad::Status;
  if (argc != 2) return 2;
  const pinnquad::CompiledPrediction<float>* const candidates[] = {&predict_avx512, &predict_avx2, &predict_baseline};
  const auto* chosen = pinnquad::choose_prediction(candidates);
  if (chosen == nullptr) {
    std::puts("none runs here");
    return 1;
  }
  std::printf("chosen: %s\n", chosen->instruction_set);
  if (std::strncmp(chosen->instruction_set, argv[1], std::strlen(argv[1])) != 0) {
    std::printf("expected: %s\n", argv[1]);
    return 1;
  }
  const float* const x = Model::golden_features[0].data();
  float commands[4] = {}, in_batch[4] = {}, with_jacobian[4] = {}, jacobian[4 * features] = {};
  Status status = Status::not_finite;
  chosen->predict_batch(x, in_batch, &status, 1);
  const bool ok = chosen->self_test() == Status::ok && chosen->predict_features(x, commands) == Status::ok &&
                  status == Status::ok && chosen->predict_with_jacobian(x, with_jacobian, jacobian) == Status::ok &&
                  golden(commands) && golden(in_batch) && golden(with_jacobian);
  // what no processor has, and no one knows how to ask for
  const bool refused = !pinnquad::runs_on_this_processor("avx1024_") && !pinnquad::runs_on_this_processor("sse2_?") &&
                       pinnquad::runs_on_this_processor("sse2_fast_math");
  std::puts(ok && refused ? "predicts" : "predicts something else");
  return ok && refused ? 0 : 1;
}
