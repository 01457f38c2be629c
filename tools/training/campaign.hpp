// SPDX-License-Identifier: MIT
// Trains every kind of network from every seed, over the cores, with progress; Ctrl-C keeps what is finished.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <random>
#include <vector>

#include "command_line/interrupt.hpp"
#include "command_line/parallel.hpp"
#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/schedule/cyclical_annealing.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "pinnquad/training/trainer.hpp"

namespace programs {

/// The paper's network and its two losses.
using PaperNetwork = pinnquad::Mlp<float, pinnquad::InputSize<pinnquad::PaperFeatures::size>, pinnquad::Hidden<10, 25>,
                                   pinnquad::OutputSize<pinnquad::rotor_count>, pinnquad::Relu>;
using VanillaLoss = pinnquad::Mse;
using PhysicsLoss = pinnquad::PaperLoss<pinnquad::CyclicalAnnealing>;

enum class Kind { vanilla, physics_informed };

inline const char* kind_name(Kind kind) { return kind == Kind::vanilla ? "vanilla" : "physics-informed"; }

/// A finished training.
struct Training {
  Kind kind = Kind::vanilla;
  std::uint64_t seed = 0;
  PaperNetwork network{};
  double training_s = 0;
};

/// One network, start to end. A seed gives initialisation and batch order, alike for both losses. False if interrupted.
template <class Loss, class Context, class Data>
bool train_one(const Context& context, const Data& data, int epochs, Training& training,
               std::atomic<long>& epochs_done) {
  using Trainer = pinnquad::Trainer<PaperNetwork, Loss, pinnquad::Adam, Context>;
  const auto start = std::chrono::steady_clock::now();
  std::mt19937_64 engine(training.seed);
  const auto network = pinnquad::initialised<PaperNetwork>(engine);
  const auto trainer = std::make_unique<Trainer>(network, Loss{}, pinnquad::Adam{}, context);
  for (int epoch = 0; epoch < epochs; ++epoch) {
    if (interrupted()) return false;
    trainer->epoch(data, {epoch, epochs}, engine);
    epochs_done.fetch_add(1);
  }
  training.network = trainer->network();
  training.training_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return true;
}

/// All trainings that were finished, in the order of kind and seed.
template <class Context, class Data>
std::vector<Training> train_all(const Context& context, const Data& data, int epochs, std::uint64_t first_seed,
                                int seeds, unsigned threads) {
  std::vector<Training> jobs;
  for (int i = 0; i < seeds; ++i) {
    for (const Kind kind : {Kind::vanilla, Kind::physics_informed}) {
      jobs.push_back({kind, first_seed + static_cast<std::uint64_t>(i), {}, 0});
    }
  }
  std::vector<char> finished(jobs.size(), 0);
  std::atomic<long> epochs_done{0};
  const double all_epochs = static_cast<double>(jobs.size()) * epochs;
  run_parallel(
      "training " + std::to_string(jobs.size()) + " networks", jobs.size(), threads,
      [&] { return static_cast<double>(epochs_done.load()) / all_epochs; },
      [&](std::size_t i) {
        const bool done = jobs[i].kind == Kind::vanilla
                              ? train_one<VanillaLoss>(context, data, epochs, jobs[i], epochs_done)
                              : train_one<PhysicsLoss>(context, data, epochs, jobs[i], epochs_done);
        finished[i] = done ? 1 : 0;
        return done;
      });

  std::vector<Training> done;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (finished[i] != 0) done.push_back(jobs[i]);
  }
  std::stable_sort(done.begin(), done.end(), [](const Training& a, const Training& b) { return a.kind < b.kind; });
  return done;
}

}  // namespace programs
