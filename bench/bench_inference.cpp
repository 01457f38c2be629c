// SPDX-License-Identifier: MIT
// One prediction, batch 1: ours, what Eigen gives, and the time at which this machine's multiply-add units would be
// full. Predict/* is latency (the output is fed into the next input), PredictThroughput/* independent inputs,
// Dense/<in>x<out> the latency of one layer with ReLU, Shape/* that of other networks, each with its own Peak/* and
// ShapeThroughput/*. Peak/read_64_kib reads what the nearest cache does not hold, as weights are read, and no more.
#include <benchmark/benchmark.h>

#include <string>

#include "pinnquad/model/axis_aligned.hpp"
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

/// Latency of a predictor under a name: as many outputs as there are inputs to take them are fed back. Under
/// `throughput`, if there is one, without.
template <class Net>
void register_network(const std::string& name, const std::string& throughput = {}) {
  static const Net network = [] {
    std::mt19937_64 engine(3);
    Net drawn;
    for (float& p : drawn.parameters) p = static_cast<float>(uniform(engine, -1.0, 1.0)) / 8.0F;
    return drawn;
  }();
  static const auto packed = [] {  // as an exported model runs it
    detail::PackedPredictor<Net> made;
    made.assign(network.parameters.data());
    return made;
  }();
  static const std::array<float, Net::inputs> start = [] {
    std::mt19937_64 engine(4);
    std::array<float, Net::inputs> x{};
    for (float& v : x) v = static_cast<float>(uniform(engine, -1.0, 1.0));
    return x;
  }();
  std::array<float, Net::outputs> expected{}, said{};
  network.forward(start.data(), expected.data());
  packed.forward(start.data(), said.data());
  for (std::size_t i = 0; i < said.size(); ++i) {
    require_close(name.c_str(), double(expected[i]), double(said[i]), 1e-4 * (1.0 + std::abs(double(expected[i]))));
  }
  benchmark::RegisterBenchmark(name.c_str(), [](benchmark::State& state) {
    auto x = start;
    std::array<float, Net::outputs> y{};
    for (auto _ : state) {
      packed.forward(x.data(), y.data());
      feed_back(start, y.data(), x.data(), y.size());
      benchmark::DoNotOptimize(x.data());
      benchmark::ClobberMemory();
    }
  });
  if (throughput.empty()) return;
  benchmark::RegisterBenchmark(throughput.c_str(), [](benchmark::State& state) {
    auto x = start;
    std::array<float, Net::outputs> y{};
    for (auto _ : state) {
      benchmark::DoNotOptimize(x.data());
      packed.forward(x.data(), y.data());
      benchmark::DoNotOptimize(y.data());
      benchmark::ClobberMemory();
    }
  });
}

template <int In, int Out>
void register_dense() {
  register_network<Network<float, InputSize<In>, Dense<Out>, Relu>>("Dense/" + std::to_string(In) + "x" +
                                                                    std::to_string(Out));
}

/// `Shape/<name>` of so many inputs and hidden layers, four outputs, and `Peak/<name>`, its multiply-adds.
template <int In, int Layers, int Width>
void register_shape(const std::string& name) {
  constexpr int multiply_adds = In * Width + (Layers - 1) * Width * Width + Width * 4;
  register_network<Mlp<float, InputSize<In>, Hidden<Layers, Width>, OutputSize<4>, Relu>>("Shape/" + name,
                                                                                          "ShapeThroughput/" + name);
  benchmark::RegisterBenchmark(("Peak/" + name).c_str(), fma_peak<NativePack<float>, multiply_adds>);
}

void read_64_kib(benchmark::State& state) {
  using Pack = NativePack<float>;
  static std::array<float, 65536 / sizeof(float)> weights;
  weights.fill(0.1F);
  Pack sum[8];
  for (Pack& s : sum) s = Pack::broadcast(0.0F);
  for (auto _ : state) {
    for (const float* w = weights.data(); w < weights.data() + weights.size(); w += 8 * Pack::width) {
      unroll<8>([&](auto v) PINNQUAD_INLINE_LAMBDA { sum[v] = sum[v] + Pack::load(w + v * Pack::width); });
    }
    benchmark::ClobberMemory();
  }
  for (const Pack& s : sum) s.store(weights.data());
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
  register_shape<16, 2, 32>("2x32");
  register_shape<16, 3, 25>("3x25");
  register_shape<16, 3, 64>("3x64");
  register_shape<16, 2, 128>("2x128");
  register_shape<60, 2, 32>("2x32_windowed");
  // the structured model's: an affine base of 19 features, and a bounded residual of the 16 that are no acceleration
  using Residual = Mlp<float, InputSize<16>, Hidden<2, 32>, OutputSize<4>, Relu>;
  register_network<Sum<AxisAligned<float, 19, 1>, Saturated<Masked<Residual, 19, 1>>>>(
      "Shape/2x32_structured", "ShapeThroughput/2x32_structured");
  constexpr int structured_multiply_adds = 4 * 16 + 3 + 16 * 32 + 32 * 32 + 32 * 4;
  benchmark::RegisterBenchmark("Peak/2x32_structured", fma_peak<NativePack<float>, structured_multiply_adds>);
  benchmark::RegisterBenchmark("Peak/fma", fma_peak<NativePack<float>, paper_multiply_adds>);
  benchmark::RegisterBenchmark("Peak/fma_double", fma_peak<NativePack<double>, paper_multiply_adds>);
  benchmark::RegisterBenchmark("Peak/read_64_kib", read_64_kib);
  return run_benchmarks(argc, argv);
}
