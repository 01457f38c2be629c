// SPDX-License-Identifier: MIT
// Many predictions at once, and the Jacobian, beside one prediction and the peak of the same run. Batched/* counts time
// per sample: `per_sample_ns`.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "pinnquad/nn/batched_network.hpp"
#include "pinnquad/nn/jacobian.hpp"
#include "support/fma_peak.hpp"
#include "support/naive_eigen_network.hpp"
#include "support/program.hpp"

namespace {

using namespace pinnquad;
using namespace pinnquad::bench;

/// An inverted rate is seconds per 1e9 samples, which is nanoseconds per sample.
void count_samples(benchmark::State& state, int samples) {
  const double seen = static_cast<double>(state.iterations()) * samples;
  state.counters["per_sample_ns"] =
      benchmark::Counter(seen * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Standardised inputs by feature.
template <class Scalar>
std::vector<Scalar> some_inputs(int samples) {
  std::mt19937_64 engine(5);
  std::vector<Scalar> x(static_cast<std::size_t>(PaperNetwork::inputs * samples));
  for (Scalar& v : x) v = static_cast<Scalar>(uniform(engine, -1.0, 1.0));
  return x;
}

template <class Scalar>
void batched(benchmark::State& state, int samples) {
  static const auto network = rebind<Scalar>(healthy_network());
  const auto x = some_inputs<Scalar>(samples);
  std::vector<Scalar> y(static_cast<std::size_t>(PaperNetwork::outputs * samples));
  for (auto _ : state) {
    BatchedNetwork<PaperNetwork::Rebind<Scalar>>::forward(network.parameters.data(), x.data(), y.data(), samples);
    benchmark::DoNotOptimize(y.data());
    benchmark::ClobberMemory();
  }
  count_samples(state, samples);
}

/// Matrices with a fixed number of columns, one per sample: what Eigen is best at.
class NaiveEigenBatch {
 public:
  static constexpr int samples = 256;
  using Inputs = Eigen::Matrix<float, 16, samples>;
  using Hidden = Eigen::Matrix<float, 25, samples>;
  using Outputs = Eigen::Matrix<float, 4, samples>;

  explicit NaiveEigenBatch(const PaperNetwork& network) : network_(network) {}

  void forward(const Inputs& x, Outputs& y) {
    layer<16>(0, x, hidden_[0]);
    for (int i = 1; i < 10; ++i) layer<25>(2 * i, hidden_[(i - 1) % 2], hidden_[i % 2]);
    y = (weight<25, 4>(20) * hidden_[1]).colwise() + bias<25, 4>(20);
  }

 private:
  template <int In, int Out>
  Eigen::Map<const Eigen::Matrix<float, Out, In, Eigen::RowMajor>> weight(int index) const {
    return Eigen::Map<const Eigen::Matrix<float, Out, In, Eigen::RowMajor>>(network_.parameters.data() +
                                                                            PaperNetwork::Sizes::offset(index));
  }
  template <int In, int Out>
  Eigen::Matrix<float, Out, 1> bias(int index) const {
    return Eigen::Map<const Eigen::Matrix<float, Out, 1>>(network_.parameters.data() +
                                                          PaperNetwork::Sizes::offset(index) + In * Out);
  }
  template <int In, class X>
  void layer(int index, const X& x, Hidden& y) const {
    y.noalias() = weight<In, 25>(index) * x;
    y = (y.colwise() + bias<In, 25>(index)).cwiseMax(0.0f);
  }

  PaperNetwork network_;
  Hidden hidden_[2];
};

void register_naive_eigen_batch(const PaperNetwork& network) {
  static NaiveEigenBatch naive(network);
  static NaiveEigenBatch::Inputs x;
  static NaiveEigenBatch::Outputs y;
  const auto values = some_inputs<float>(NaiveEigenBatch::samples);
  for (int s = 0; s < NaiveEigenBatch::samples; ++s) {
    for (int i = 0; i < 16; ++i) x(i, s) = values[static_cast<std::size_t>(i * NaiveEigenBatch::samples + s)];
  }
  std::vector<float> expected(4 * NaiveEigenBatch::samples);
  BatchedNetwork<PaperNetwork>::forward(network.parameters.data(), values.data(), expected.data(),
                                        NaiveEigenBatch::samples);
  naive.forward(x, y);
  for (int s = 0; s < NaiveEigenBatch::samples; ++s) {
    const auto e = static_cast<double>(expected[static_cast<std::size_t>(s)]);
    require_close("Batched/naive_eigen", e, static_cast<double>(y(0, s)), 1e-4 * (1 + std::abs(e)));
  }
  benchmark::RegisterBenchmark("Batched/naive_eigen/256", [](benchmark::State& state) {
    for (auto _ : state) {
      naive.forward(x, y);
      benchmark::DoNotOptimize(y.data());
      benchmark::ClobberMemory();
    }
    count_samples(state, NaiveEigenBatch::samples);
  });
}

/// The outputs are fed into the next inputs, as in Predict/*.
void register_jacobian(const PaperNetwork& network) {
  static const PaperNetwork net = network;
  static const PackedNetwork<PaperNetwork> packed(net.parameters);
  benchmark::RegisterBenchmark("Jacobian/paper_network", [](benchmark::State& state) {
    const PaperInput start = some_input();
    PaperInput x = start;
    float y[4], jacobian[64];
    for (auto _ : state) {
      JacobianPass<PaperNetwork>::run(packed, net.parameters.data(), x.data(), y, jacobian);
      feed_back(start, y, x.data());
      benchmark::DoNotOptimize(jacobian);
      benchmark::ClobberMemory();
    }
  });
  benchmark::RegisterBenchmark("Jacobian/portable", [](benchmark::State& state) {
    const PaperInput start = some_input();
    PaperInput x = start;
    float y[4], jacobian[64];
    for (auto _ : state) {
      JacobianPass<PaperNetwork, GenericPack<float, 4>>::run(net.parameters.data(), x.data(), y, jacobian);
      feed_back(start, y, x.data());
      benchmark::DoNotOptimize(jacobian);
      benchmark::ClobberMemory();
    }
  });
  benchmark::RegisterBenchmark("Predict/paper_network", [](benchmark::State& state) { predict(state, packed); });
}

}  // namespace

int main(int argc, char** argv) {
  const PaperNetwork network = healthy_network();
  for (const int samples : {32, 256, 1024}) {
    const std::string size = std::to_string(samples);
    benchmark::RegisterBenchmark(("Batched/paper_network/" + size).c_str(),
                                 [samples](benchmark::State& state) { batched<float>(state, samples); });
  }
  benchmark::RegisterBenchmark("Batched/paper_network_double/256",
                               [](benchmark::State& state) { batched<double>(state, 256); });
  register_naive_eigen_batch(network);
  register_jacobian(network);
  benchmark::RegisterBenchmark("Peak/fma", fma_peak<NativePack<float>, paper_multiply_adds>);
  return run_benchmarks(argc, argv);
}
