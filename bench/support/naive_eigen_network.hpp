// SPDX-License-Identifier: MIT
// The yardstick of prediction: what a user gets who types Eq. (4) into Eigen with sizes known at compile time.
#pragma once

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>

#include "pinnquad/core/types.hpp"
#include "support/paper_network.hpp"
#include "support/program.hpp"

namespace pinnquad::bench {

/// Per layer: g = b; g.noalias() += W h; h = max(g, 0). Eigen's own alignment, `Order` for the weights.
template <int Order>
class NaiveEigenNetwork {
 public:
  using Scalar = PaperNetwork::Scalar;

  explicit NaiveEigenNetwork(const PaperNetwork& network) {
    load<16, 25>(network, 0, first_);
    for (std::size_t i = 0; i < hidden_.size(); ++i) load<25, 25>(network, 2 * static_cast<int>(i) + 2, hidden_[i]);
    load<25, 4>(network, 20, last_);
  }

  void forward(const Scalar* x, Scalar* y) const {
    Eigen::Matrix<Scalar, 16, 1> input = Eigen::Map<const Eigen::Matrix<Scalar, 16, 1>>(x);
    Eigen::Matrix<Scalar, 25, 1> h, g;
    g = first_.bias;
    g.noalias() += first_.weight * input;
    h = g.cwiseMax(Scalar(0));
    for (const Layer<25, 25>& layer : hidden_) {
      g = layer.bias;
      g.noalias() += layer.weight * h;
      h = g.cwiseMax(Scalar(0));
    }
    Eigen::Map<Eigen::Matrix<Scalar, 4, 1>> output(y);
    output = last_.bias;
    output.noalias() += last_.weight * h;
  }

 private:
  template <int In, int Out>
  struct Layer {
    Eigen::Matrix<Scalar, Out, In, Order> weight;
    Eigen::Matrix<Scalar, Out, 1> bias;
  };

  template <int In, int Out>
  static void load(const PaperNetwork& network, int index, Layer<In, Out>& layer) {
    const Scalar* parameters = network.parameters.data() + PaperNetwork::Sizes::offset(index);
    layer.weight = Eigen::Map<const Eigen::Matrix<Scalar, Out, In, Eigen::RowMajor>>(parameters);
    layer.bias = Eigen::Map<const Eigen::Matrix<Scalar, Out, 1>>(parameters + Out * In);
  }

  Layer<16, 25> first_;
  std::array<Layer<25, 25>, 9> hidden_;
  Layer<25, 4> last_;
};

/// `some_input` in another scalar.
template <class Scalar>
std::array<Scalar, PaperNetwork::inputs> paper_input(std::uint64_t seed = 2) {
  std::array<Scalar, PaperNetwork::inputs> x{};
  const PaperInput drawn = some_input(seed);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<Scalar>(drawn[i]);
  return x;
}

/// Latency of anything with forward(const Scalar* x, Scalar* y) and the paper's sizes: the output is fed into the next
/// input.
template <class Model>
void predict(benchmark::State& state, const Model& model) {
  using Scalar = typename Model::Scalar;
  const auto start = paper_input<Scalar>();
  auto x = start;
  std::array<Scalar, PaperNetwork::outputs> y{};
  for (auto _ : state) {
    model.forward(x.data(), y.data());
    feed_back(start, y.data(), x.data());
    benchmark::DoNotOptimize(x.data());
    benchmark::ClobberMemory();
  }
}

/// Time per prediction of independent inputs, which the processor may overlap.
template <class Model>
void predict_throughput(benchmark::State& state, const Model& model) {
  using Scalar = typename Model::Scalar;
  std::array<std::array<Scalar, PaperNetwork::inputs>, 64> inputs{};
  for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i] = paper_input<Scalar>(i + 2);
  std::array<Scalar, PaperNetwork::outputs> y{};
  std::size_t next = 0;
  for (auto _ : state) {
    model.forward(inputs[next].data(), y.data());
    next = (next + 1) % inputs.size();
    benchmark::DoNotOptimize(y.data());
    benchmark::ClobberMemory();
  }
}

/// Ends the program unless the model gives the portable kernel's numbers in double, to rounding, over a few steps of
/// feedback.
template <class Model>
void require_paper_outputs(const char* name, const Model& model, const PaperNetwork& network) {
  using Scalar = typename Model::Scalar;
  const auto reference = rebind<double>(network);
  const auto start = paper_input<double>();
  auto x = start;
  for (int step = 0; step < 16; ++step) {
    std::array<double, PaperNetwork::outputs> expected{};
    std::array<Scalar, PaperNetwork::inputs> inputs{};
    std::array<Scalar, PaperNetwork::outputs> y{};
    for (std::size_t i = 0; i < x.size(); ++i) {
      inputs[i] = static_cast<Scalar>(x[i]);
      x[i] = static_cast<double>(inputs[i]);
    }
    reference.forward(x.data(), expected.data());
    model.forward(inputs.data(), y.data());
    for (std::size_t i = 0; i < y.size(); ++i) {
      require_close(name, expected[i], static_cast<double>(y[i]), 1e-5 * (1.0 + std::abs(expected[i])));
    }
    feed_back(start, expected.data(), x.data());
  }
}

/// `Predict/naive_eigen`, after a check that it computes what ours does.
inline void register_naive_eigen(const PaperNetwork& network) {
  static const NaiveEigenNetwork<Eigen::ColMajor> naive(network);
  require_paper_outputs("Predict/naive_eigen", naive, network);
  benchmark::RegisterBenchmark("Predict/naive_eigen", [](benchmark::State& state) { predict(state, naive); });
}

}  // namespace pinnquad::bench
