// SPDX-License-Identifier: MIT
// A peer: any other implementation of what bench_inference and bench_training time, in a file of your own.
// `bench/run --peers DIR` compiles DIR/*.cpp into bench_peers and times them beside ours (docs/benchmarks.md).
// A peer file includes this header, writes a class or two, and registers them:
//   struct MyNetwork {
//     explicit MyNetwork(const float* parameters);
//     void forward(const float* x, float* y) const;  // 16 inputs, 4 outputs
//   };
//   const bool network = pinnquad::bench::add_peer_network<MyNetwork>("my_library");
//   struct MyTrainer {
//     explicit MyTrainer(const pinnquad::bench::TrainingTask& task);
//     double epoch(const int* order);  // the mean loss
//   };
//   const bool trainer = pinnquad::bench::add_peer_trainer<MyTrainer>("my_library");
// Parameters: of ten layers of 25 neurons with ReLU and a last one of 4 without, layer by layer: weights row by row
// (row = neuron), then biases; 6,379 floats. They, and a TrainingTask's arrays, live as long as the program.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace pinnquad::bench {

inline constexpr int peer_inputs = 16, peer_outputs = 4;

/// An epoch is one pass over the samples in the order given, in batches of 64 (the last one smaller). Loss: the mean
/// over the batch's samples and outputs of the squared error. Optimiser: Adam, learning rate 1e-3, betas 0.9 and 0.999,
/// epsilon 1e-8; 1e-5 times the parameter is added to each gradient before the moments.
struct TrainingTask {
  const float* parameters;  ///< to begin with
  const float* features;    ///< samples x 16, row by row, standardised
  const float* outputs;     ///< samples x 4
  int samples;
};

/// A registered prediction; read by bench_peers.
struct PeerNetwork {
  std::string name;
  std::function<std::shared_ptr<const void>(const float* parameters)> make;
  void (*forward)(const void* network, const float* x, float* y);
  /// Latency: outputs of one prediction move the next one's first inputs away from `start`.
  void (*time)(benchmark::State& state, const void* network, const float* start);
};
struct PeerTrainer {
  std::string name;
  std::function<std::shared_ptr<void>(const TrainingTask& task)> make;
  double (*epoch)(void* trainer, const int* order);
};
inline std::vector<PeerNetwork>& peer_networks() {
  static std::vector<PeerNetwork> all;
  return all;
}
inline std::vector<PeerTrainer>& peer_trainers() {
  static std::vector<PeerTrainer> all;
  return all;
}

/// `Predict/<name>`, after a check that it computes what ours does.
template <class Network>
bool add_peer_network(const std::string& name) {
  peer_networks().push_back(
      {name, [](const float* parameters) { return std::make_shared<const Network>(parameters); },
       [](const void* network, const float* x, float* y) { static_cast<const Network*>(network)->forward(x, y); },
       [](benchmark::State& state, const void* network, const float* start) {
         const auto& own = *static_cast<const Network*>(network);
         float x[peer_inputs], y[peer_outputs] = {};
         for (int i = 0; i < peer_inputs; ++i) x[i] = start[i];
         for (auto _ : state) {
           own.forward(x, y);
           for (int i = 0; i < peer_outputs; ++i) x[i] = start[i] + 0.125F * y[i];
           benchmark::DoNotOptimize(&x[0]);
           benchmark::ClobberMemory();
         }
       }});
  return true;
}

/// `TrainEpoch/<name>`, after a check that its losses are those of plain Eigen, to rounding.
template <class Trainer>
bool add_peer_trainer(const std::string& name) {
  peer_trainers().push_back({name, [](const TrainingTask& task) { return std::make_shared<Trainer>(task); },
                             [](void* trainer, const int* order) {
                               return static_cast<double>(static_cast<Trainer*>(trainer)->epoch(order));
                             }});
  return true;
}

}  // namespace pinnquad::bench
