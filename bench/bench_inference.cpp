// SPDX-License-Identifier: MIT
// One prediction, batch 1: ours, what Eigen gives, and the time at which this machine's multiply-add units would be
// full. Predict/* is latency (the output is fed into the next input), PredictThroughput/* independent inputs,
// Dense/<in>x<out> the latency of one layer with ReLU.
#include <benchmark/benchmark.h>

#include <string>

#include "pinnquad/nn/packed_network.hpp"
#include "support/fma_peak.hpp"
#include "support/naive_eigen_network.hpp"
#include "support/program.hpp"

namespace {

using namespace pinnquad;
using namespace pinnquad::bench;

/// Latency and throughput of a model with the paper's sizes, which lives as long as the program.
template <class Model>
void register_model(const std::string& name, const Model& model, const PaperNetwork& network) {
  require_paper_outputs(name.c_str(), model, network);
  benchmark::RegisterBenchmark(("Predict/" + name).c_str(), [&model](benchmark::State& s) { predict(s, model); });
  benchmark::RegisterBenchmark(("PredictThroughput/" + name).c_str(),
                               [&model](benchmark::State& s) { predict_throughput(s, model); });
}

/// Ours in one scalar.
template <class Scalar>
void register_ours(const std::string& suffix, const PaperNetwork& network) {
  using Net = PaperNetwork::Rebind<Scalar>;
  static const Net portable = rebind<Scalar>(network);
  static const PackedNetwork<Net> packed(portable.parameters);
  register_model("paper_network" + suffix, packed, network);
  register_model("portable" + suffix, portable, network);
}

void register_eigen(const PaperNetwork& network) {
  static const NaiveEigenNetwork<Eigen::ColMajor> naive(network);
  static const NaiveEigenNetwork<Eigen::RowMajor> naive_rowmajor(network);
  register_model("naive_eigen", naive, network);
  register_model("naive_eigen_rowmajor", naive_rowmajor, network);
}

/// `Dense/<In>x<Out>`: as many outputs as there are inputs to take them are fed back.
template <int In, int Out>
void register_dense() {
  using Net = Network<float, InputSize<In>, Dense<Out>, Relu>;
  static const PackedNetwork<Net> packed = [] {
    std::mt19937_64 engine(3);
    typename Net::Parameters parameters{};
    for (float& p : parameters) p = static_cast<float>(uniform(engine, -1.0, 1.0)) / static_cast<float>(In);
    return PackedNetwork<Net>(parameters);
  }();
  const std::string name = "Dense/" + std::to_string(In) + "x" + std::to_string(Out);
  benchmark::RegisterBenchmark(name.c_str(), [](benchmark::State& state) {
    std::mt19937_64 engine(4);
    std::array<float, In> start{};
    for (float& v : start) v = static_cast<float>(uniform(engine, -1.0, 1.0));
    auto x = start;
    std::array<float, Out> y{};
    for (auto _ : state) {
      packed.forward(x.data(), y.data());
      feed_back(start, y.data(), x.data(), Out);
      benchmark::DoNotOptimize(x.data());
      benchmark::ClobberMemory();
    }
  });
}

}  // namespace

int main(int argc, char** argv) {
  const PaperNetwork network = healthy_network();
  register_ours<float>("", network);
  register_ours<double>("_double", network);
  register_eigen(network);
  register_dense<16, 25>();
  register_dense<25, 25>();
  register_dense<25, 4>();
  register_dense<40, 40>();
  register_dense<64, 64>();
  register_dense<256, 256>();
  benchmark::RegisterBenchmark("Peak/fma", fma_peak<NativePack<float>, paper_multiply_adds>);
  benchmark::RegisterBenchmark("Peak/fma_double", fma_peak<NativePack<double>, paper_multiply_adds>);
  return run_benchmarks(argc, argv);
}
