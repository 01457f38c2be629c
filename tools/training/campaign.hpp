// SPDX-License-Identifier: MIT
// Trains a network type under every loss that is asked for, from every seed, over the cores, with progress; Ctrl-C
// keeps what is finished. The body of a recipe.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line/interrupt.hpp"
#include "command_line/parallel.hpp"
#include "pinnquad/loss/local_monotonicity.hpp"
#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "pinnquad/training/trainer.hpp"
#include "training/best_recipe.hpp"
#include "training/recipe.hpp"

namespace programs {

/// Features and airframe of every recipe.
using TrainingContext = pinnquad::Context<pinnquad::PaperFeatures, pinnquad::GivenAirframe>;
using TrainingRows =
    pinnquad::TrainingData<float, pinnquad::PaperFeatures::size, pinnquad::OutputMap<pinnquad::CommandOutputs>::size>;

/// One network, start to end. A seed gives initialisation and batch order, alike for all losses.
template <class Network, class Loss, class Optimizer>
void train_one(const TrainingContext& context, const TrainingRows& data, const Loss& loss, const Optimizer& optimizer,
               int epochs, std::atomic<long>& epochs_done, Training& training, Network& trained) {
  using Trainer = pinnquad::Trainer<Network, Loss, Optimizer, TrainingContext, pinnquad::ShuffledBatches, batch_size>;
  const auto start = std::chrono::steady_clock::now();
  std::mt19937_64 engine(training.seed);
  const auto network = pinnquad::initialised<Network>(engine);
  const auto trainer = std::make_unique<Trainer>(network, loss, optimizer, context);
  for (int epoch = 0; epoch < epochs; ++epoch) {
    stop_if_interrupted();
    trainer->epoch(data, {epoch, epochs}, engine);
    epochs_done.fetch_add(1);
  }
  trained = trainer->network();
  training.training_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Axis>
using PearsonTerm = pinnquad::Weighted<pinnquad::PearsonCorrelation<Axis>, pinnquad::CyclicalAnnealing>;
using PearsonLoss = pinnquad::PhysicsInformed<pinnquad::Mse, PearsonTerm<pinnquad::Roll>, PearsonTerm<pinnquad::Pitch>,
                                              PearsonTerm<pinnquad::Yaw>>;

/// `Parts` is what differs between recipes: type Network; losses annealed(), constant(), pearson(); optimisers
/// vanilla_optimizer() and informed_optimizer().
template <class Parts>
std::vector<Training> train_all(const TrainingPlan& plan) {
  using Network = typename Parts::Network;
  const auto context = pinnquad::make_context<TrainingContext>(plan.split.train, plan.airframe);
  const auto data = pinnquad::standardised<float>(context, plan.split.train);
  std::vector<Training> jobs;
  for (int i = 0; i < plan.seeds; ++i) {
    for (const LossName& loss : plan.losses) {
      jobs.push_back({loss, plan.first_seed + static_cast<std::uint64_t>(i), 0, nullptr});
    }
  }
  std::atomic<long> epochs_done{0};
  const double all_epochs = static_cast<double>(jobs.size()) * plan.epochs;
  run_parallel(
      plan.silent ? "" : "training " + std::to_string(jobs.size()) + " networks", jobs.size(), plan.threads,
      [&] { return static_cast<double>(epochs_done.load()) / all_epochs; },
      [&](std::size_t i) {
        Training& job = jobs[i];
        const auto network = std::make_unique<Network>();
        const auto trained = [&](const auto& loss, const auto& optimizer) {
          train_one(context, data, loss, optimizer, plan.epochs, epochs_done, job, *network);
        };
        const std::string key = job.loss.key;
        key == "vanilla"            ? trained(pinnquad::Mse{}, Parts::vanilla_optimizer())
        : key == "physics_informed" ? trained(Parts::annealed(), Parts::informed_optimizer())
        : key == "constant_weight"  ? trained(Parts::constant(), Parts::informed_optimizer())
        : key == "pearson"          ? trained(Parts::pearson(), Parts::informed_optimizer())
                                    : throw std::logic_error("no such loss: " + key);
        const auto model = pinnquad::make_trained_model(*network, context, plan.split.train);
        using Model = std::decay_t<decltype(model)>;
        job.network = std::make_shared<NetworkOfModel<Model>>(model, plan.library_airframe);
      });

  std::vector<Training> done;
  for (const LossName& loss : plan.losses) {
    for (const Training& job : jobs) {
      if (job.network && job.loss.key == loss.key) done.push_back(job);
    }
  }
  return done;
}

/// "16 -> 10 x 25 ReLU -> 4, 6379 parameters": the words are the middle.
template <class Network>
std::string network_in_words(const std::string& hidden) {
  return std::to_string(Network::inputs) + " -> " + hidden + " -> " + std::to_string(Network::outputs) + ", " +
         std::to_string(Network::parameter_count) + " parameters";
}

}  // namespace programs
