// SPDX-License-Identifier: MIT
// bench_peers: what users' files register (bench/peer.hpp), ours and the limit, in one run. Each peer is checked before
// the first timing: predictions over a few steps of feedback, losses over three epochs.
#include <memory>
#include <numeric>
#include <random>

#include "peer.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/nn/packed_network.hpp"
#include "pinnquad/training/trainer.hpp"
#include "support/fma_peak.hpp"
#include "support/naive_eigen_network.hpp"
#include "support/naive_eigen_trainer.hpp"
#include "support/program.hpp"

namespace {

using namespace pinnquad;
using namespace pinnquad::bench;

static_assert(peer_inputs == PaperNetwork::inputs && peer_outputs == PaperNetwork::outputs);

/// With forward() as the other networks here.
struct CheckedPeer {
  using Scalar = float;
  const PeerNetwork* peer;
  std::shared_ptr<const void> network;
  void forward(const float* x, float* y) const { peer->forward(network.get(), x, y); }
};

/// Orders of samples as our trainer draws them, epoch by epoch.
class Orders {
 public:
  explicit Orders(int samples) : order_(static_cast<std::size_t>(samples)) {
    std::iota(order_.begin(), order_.end(), 0);
  }
  const int* next() {
    shuffle(order_, engine_);
    return order_.data();
  }

 private:
  std::vector<int> order_;
  std::mt19937_64 engine_{4};
};

void register_networks(const PaperNetwork& network) {
  static const PackedNetwork<PaperNetwork> packed(network.parameters);
  static const auto start = paper_input<float>();
  require_paper_outputs("Predict/paper_network", packed, network);
  benchmark::RegisterBenchmark("Predict/paper_network", [](benchmark::State& s) { predict(s, packed); });
  benchmark::RegisterBenchmark("Peak/fma", fma_peak<NativePack<float>, paper_multiply_adds>);
  for (const PeerNetwork& peer : peer_networks()) {
    const CheckedPeer checked{&peer, peer.make(network.parameters.data())};
    const std::string name = "Predict/" + peer.name;
    require_paper_outputs(name.c_str(), checked, network);
    benchmark::RegisterBenchmark(
        name.c_str(), [checked](benchmark::State& s) { checked.peer->time(s, checked.network.get(), start.data()); });
  }
}

void register_trainers(const PaperNetwork& network) {
  static const PaperTrainingData data = smooth_training_set();
  static const TrainingTask task{network.parameters.data(), data.features.data(), data.outputs.data(), data.size()};
  for (const PeerTrainer& peer : peer_trainers()) {
    const std::string name = "TrainEpoch/" + peer.name;
    const auto trainer = peer.make(task);
    const auto plain = std::make_unique<NaiveEigenTrainer>(network, Adam{});
    Orders orders(data.size());
    std::mt19937_64 engine(4);
    for (int epoch = 0; epoch < 3; ++epoch) {
      const double expected = plain->epoch(data, engine);
      require_close(name.c_str(), expected, peer.epoch(trainer.get(), orders.next()), 2e-3 * expected);
    }
    benchmark::RegisterBenchmark(name.c_str(), [&peer](benchmark::State& state) {
      const auto own = peer.make(task);
      Orders own_orders(task.samples);
      for (auto _ : state) benchmark::DoNotOptimize(peer.epoch(own.get(), own_orders.next()));
    })->Unit(benchmark::kMillisecond);
  }
  if (peer_trainers().empty()) return;
  benchmark::RegisterBenchmark("TrainEpoch/vanilla", [](benchmark::State& state) {
    using PaperContext = Context<PaperFeatures, PaperQuadrotor>;
    using Ours = Trainer<PaperNetwork, Mse, Adam, PaperContext>;
    const auto ours = std::make_unique<Ours>(healthy_network(), Mse{}, Adam{}, PaperContext{});
    std::mt19937_64 engine(4);
    for (auto _ : state) benchmark::DoNotOptimize(ours->epoch(data, Progress{0, 300}, engine));
  })->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  static const PaperNetwork network = healthy_network();
  if (peer_networks().empty() && peer_trainers().empty()) {
    std::fprintf(stderr, "bench_peers: no file registers a peer: expected add_peer_network or add_peer_trainer\n");
    return 2;
  }
  register_networks(network);
  register_trainers(network);
  return run_benchmarks(argc, argv);
}
