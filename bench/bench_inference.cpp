// SPDX-License-Identifier: MIT
// Latency of one prediction: ours, what Eigen gives, and the time at which this machine's multiply-add units would be full.
#include <benchmark/benchmark.h>

#include "pinnquad/nn/packed_network.hpp"
#include "support/fma_peak.hpp"
#include "support/naive_eigen_network.hpp"
#include "support/program.hpp"

namespace {

using namespace pinnquad;
using namespace pinnquad::bench;

void register_ours(const PaperNetwork& network) {
  static const PackedNetwork<PaperNetwork> packed(network.parameters);
  static const PaperNetwork portable = network;
  require_paper_outputs("Predict/paper_network", packed, network);
  benchmark::RegisterBenchmark("Predict/paper_network", [](benchmark::State& state) { predict(state, packed); });
  benchmark::RegisterBenchmark("Predict/portable", [](benchmark::State& state) { predict(state, portable); });
}

void register_naive_eigen_rowmajor(const PaperNetwork& network) {
  static const NaiveEigenNetwork<Eigen::RowMajor> naive(network);
  require_paper_outputs("Predict/naive_eigen_rowmajor", naive, network);
  benchmark::RegisterBenchmark("Predict/naive_eigen_rowmajor", [](benchmark::State& state) { predict(state, naive); });
}

}  // namespace

int main(int argc, char** argv) {
  const PaperNetwork network = healthy_network();
  register_ours(network);
  register_naive_eigen(network);
  register_naive_eigen_rowmajor(network);
  benchmark::RegisterBenchmark("Peak/fma", fma_peak<NativePack<float>, paper_multiply_adds>);
  return run_benchmarks(argc, argv);
}
