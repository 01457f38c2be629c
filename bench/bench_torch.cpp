// SPDX-License-Identifier: MIT
// The same prediction in libtorch, one thread: layer by layer, as TorchScript, and frozen. Built where libtorch is
// installed (Debian: libtorch-dev). The same weights, checked against ours before the first timing.
#include <benchmark/benchmark.h>
#include <torch/script.h>
#include <torch/torch.h>

#include <string>
#include <vector>

#include "pinnquad/nn/packed_network.hpp"
#include "support/naive_eigen_network.hpp"
#include "support/program.hpp"

namespace {

using namespace pinnquad;
using namespace pinnquad::bench;

struct Weights {
  std::vector<torch::Tensor> weight, bias;
};

Weights weights_of(const PaperNetwork& network) {
  Weights result;
  unroll<PaperNetwork::layer_count>([&](auto index) {
    using Layer = PaperNetwork::Layer<decltype(index)::value>;
    if constexpr (Layer::parameter_count > 0) {
      float* own = const_cast<float*>(network.parameters.data()) + PaperNetwork::Sizes::offset(index);
      const auto options = torch::TensorOptions().dtype(torch::kFloat32);
      result.weight.push_back(torch::from_blob(own, {Layer::outputs, Layer::inputs}, options).clone());
      result.bias.push_back(torch::from_blob(own + Layer::weight_count, {Layer::outputs}, options).clone());
    }
  });
  return result;
}

/// Anything that maps a 1 x 16 tensor to a 1 x 4 one, with the interface of the other networks here.
template <class Function>
class TorchNetwork {
 public:
  using Scalar = float;
  explicit TorchNetwork(Function function) : function_(std::move(function)) {}

  void forward(const float* x, float* y) const {
    const torch::InferenceMode no_gradients;
    std::memcpy(input_.data_ptr<float>(), x, 16 * sizeof(float));
    const torch::Tensor output = function_(input_);
    std::memcpy(y, output.data_ptr<float>(), 4 * sizeof(float));
  }

 private:
  mutable Function function_;
  torch::Tensor input_ = torch::zeros({1, 16});
};

template <class Function>
void add(const std::string& name, Function function, const PaperNetwork& network) {
  static const TorchNetwork<Function> model(std::move(function));
  require_paper_outputs(name.c_str(), model, network);
  benchmark::RegisterBenchmark(name.c_str(), [](benchmark::State& state) { predict(state, model); });
}

torch::jit::Module scripted(const Weights& weights) {
  torch::jit::Module module("network");
  std::string source = "def forward(self, x):\n";
  for (std::size_t i = 0; i < weights.weight.size(); ++i) {
    const std::string n = std::to_string(i);
    module.register_parameter("w" + n, weights.weight[i], false);
    module.register_parameter("b" + n, weights.bias[i], false);
    source += "  x = torch.linear(x, self.w" + n + ", self.b" + n + ")\n";
    if (i + 1 < weights.weight.size()) source += "  x = torch.relu(x)\n";
  }
  module.define(source + "  return x\n");
  module.eval();
  return module;
}

}  // namespace

int main(int argc, char** argv) {
  at::set_num_threads(1);
  const PaperNetwork network = healthy_network();
  static const PackedNetwork<PaperNetwork> packed(network.parameters);
  benchmark::RegisterBenchmark("Predict/paper_network", [](benchmark::State& state) { predict(state, packed); });
  const Weights weights = weights_of(network);
  add(
      "Predict/libtorch_eager",
      [weights](const torch::Tensor& input) {
        torch::Tensor x = input;
        for (std::size_t i = 0; i < weights.weight.size(); ++i) {
          x = torch::linear(x, weights.weight[i], weights.bias[i]);
          if (i + 1 < weights.weight.size()) x = torch::relu(x);
        }
        return x;
      },
      network);
  const auto run = [](torch::jit::Module module) {
    return [module = std::move(module)](const torch::Tensor& x) mutable { return module.forward({x}).toTensor(); };
  };
  add("Predict/libtorch_script", run(scripted(weights)), network);
  add(
      "Predict/libtorch_frozen",
      [frozen = torch::jit::freeze(scripted(weights))](const torch::Tensor& x) mutable {
        return frozen.forward({x}).toTensor();
      },
      network);
  return run_benchmarks(argc, argv);
}
