// SPDX-License-Identifier: MIT
// One epoch of training, 9,000 samples in batches of 64: the plain loss, the physics-informed one, both with batch
// norm, and Eigen typed naively. Peak/TrainEpoch is the time in which this machine's multiply-add units could do the
// products of such an epoch. bench/torch_training.py does the same epoch in PyTorch.
#include <benchmark/benchmark.h>

#include <memory>
#include <random>
#include <type_traits>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/trainer.hpp"
#include "support/fma_peak.hpp"
#include "support/naive_eigen_trainer.hpp"
#include "support/program.hpp"

namespace {

using namespace pinnquad;
using namespace pinnquad::bench;

using PaperContext = Context<PaperFeatures, PaperQuadrotor>;
template <class Network, class Loss>
using PaperTrainer = Trainer<Network, Loss, Adam, PaperContext>;
using Vanilla = Mse;
using PhysicsInformedLoss = PaperLoss<CyclicalAnnealing>;

/// The trainers hold their work space: too large for a stack.
template <class Network, class Loss>
std::unique_ptr<PaperTrainer<Network, Loss>> make_trainer() {
  Network network;
  if constexpr (std::is_same_v<Network, PaperNetwork>) {
    network = healthy_network();
  } else {  // batch norm keeps activations alive, whatever the weights
    std::mt19937_64 engine(1);
    network = initialised<Network>(engine);
  }
  return std::make_unique<PaperTrainer<Network, Loss>>(network, Loss{}, Adam{}, PaperContext{});
}

constexpr int samples = 9000;
/// Of an epoch: the forward pass, and as many for the gradients of weights and of each layer's inputs. Nobody asks for
/// that of the network's own inputs.
constexpr int epoch_multiply_adds = samples * (3 * paper_multiply_adds - 16 * 25);

const PaperTrainingData& training_set() {
  static const PaperTrainingData data = smooth_training_set(samples);
  return data;
}

/// The schedule stands at its first epoch, where the weight of the physics-informed terms is largest.
template <class Network, class Loss>
void train_epoch(benchmark::State& state) {
  const PaperTrainingData& data = training_set();
  const auto trainer = make_trainer<Network, Loss>();
  std::mt19937_64 engine(4);
  for (auto _ : state) benchmark::DoNotOptimize(trainer->epoch(data, Progress{0, 300}, engine));
  state.counters["samples_per_second"] =
      benchmark::Counter(static_cast<double>(data.size()), benchmark::Counter::kIsIterationInvariantRate);
}

void train_epoch_naive(benchmark::State& state) {
  const PaperTrainingData& data = training_set();
  const auto trainer = std::make_unique<NaiveEigenTrainer>(healthy_network(), Adam{});
  std::mt19937_64 engine(4);
  for (auto _ : state) benchmark::DoNotOptimize(trainer->epoch(data, engine));
  state.counters["samples_per_second"] =
      benchmark::Counter(static_cast<double>(data.size()), benchmark::Counter::kIsIterationInvariantRate);
}

/// The same seed must give both trainers the same losses, to what rounding becomes in three epochs.
void require_same_training() {
  const auto ours = make_trainer<PaperNetwork, Vanilla>();
  const auto naive = std::make_unique<NaiveEigenTrainer>(healthy_network(), Adam{});
  std::mt19937_64 our_engine(4), naive_engine(4);
  for (int epoch = 0; epoch < 3; ++epoch) {
    const double expected = naive->epoch(training_set(), naive_engine);
    const double actual = ours->epoch(training_set(), Progress{epoch, 3}, our_engine);
    require_close("TrainEpoch/vanilla", expected, actual, 2e-3 * expected);
  }
}

}  // namespace

int main(int argc, char** argv) {
  require_same_training();
  benchmark::RegisterBenchmark("TrainEpoch/vanilla", train_epoch<PaperNetwork, Vanilla>)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("TrainEpoch/physics_informed", train_epoch<PaperNetwork, PhysicsInformedLoss>)
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("TrainEpoch/batch_norm", train_epoch<PaperBatchNormNetwork, Vanilla>)
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("TrainEpoch/batch_norm_physics_informed",
                               train_epoch<PaperBatchNormNetwork, PhysicsInformedLoss>)
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("TrainEpoch/naive_eigen", train_epoch_naive)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("Peak/TrainEpoch", fma_peak<NativePack<float>, epoch_multiply_adds>)
      ->Unit(benchmark::kMillisecond);
  return run_benchmarks(argc, argv);
}
