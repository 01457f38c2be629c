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
  explicit NaiveEigenNetwork(const PaperNetwork& network) {
    load<16, 25>(network, 0, first_);
    for (std::size_t i = 0; i < hidden_.size(); ++i) load<25, 25>(network, 2 * static_cast<int>(i) + 2, hidden_[i]);
    load<25, 4>(network, 20, last_);
  }

  void forward(const float* x, float* y) const {
    Eigen::Matrix<float, 16, 1> input = Eigen::Map<const Eigen::Matrix<float, 16, 1>>(x);
    Eigen::Matrix<float, 25, 1> h, g;
    g = first_.bias;
    g.noalias() += first_.weight * input;
    h = g.cwiseMax(0.0f);
    for (const Layer<25, 25>& layer : hidden_) {
      g = layer.bias;
      g.noalias() += layer.weight * h;
      h = g.cwiseMax(0.0f);
    }
    Eigen::Map<Eigen::Matrix<float, 4, 1>> output(y);
    output = last_.bias;
    output.noalias() += last_.weight * h;
  }

 private:
  template <int In, int Out>
  struct Layer {
    Eigen::Matrix<float, Out, In, Order> weight;
    Eigen::Matrix<float, Out, 1> bias;
  };

  template <int In, int Out>
  static void load(const PaperNetwork& network, int index, Layer<In, Out>& layer) {
    const float* parameters = network.parameters.data() + PaperNetwork::Sizes::offset(index);
    layer.weight = Eigen::Map<const Eigen::Matrix<float, Out, In, Eigen::RowMajor>>(parameters);
    layer.bias = Eigen::Map<const Eigen::Matrix<float, Out, 1>>(parameters + Out * In);
  }

  Layer<16, 25> first_;
  std::array<Layer<25, 25>, 9> hidden_;
  Layer<25, 4> last_;
};

/// Latency of anything with forward(const float* x, float* y).
template <class Model>
void predict(benchmark::State& state, const Model& model) {
  const PaperInput start = some_input();
  PaperInput x = start;
  PaperOutput y{};
  for (auto _ : state) {
    model.forward(x.data(), y.data());
    feed_back(start, y.data(), x.data());
    benchmark::DoNotOptimize(x.data());
    benchmark::ClobberMemory();
  }
}

/// Ends the program unless the model gives the portable kernel's numbers, to rounding, over a few steps of feedback.
template <class Model>
void require_paper_outputs(const char* name, const Model& model, const PaperNetwork& network) {
  const PaperInput start = some_input();
  PaperInput x = start;
  for (int step = 0; step < 16; ++step) {
    PaperOutput expected{}, y{};
    network.forward(x.data(), expected.data());
    model.forward(x.data(), y.data());
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double target = static_cast<double>(expected[i]);
      require_close(name, target, static_cast<double>(y[i]), 1e-5 * (1.0 + std::abs(target)));
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
