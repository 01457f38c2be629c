// SPDX-License-Identifier: MIT
// Trains the paper's network in double for 200 steps and writes all that PyTorch needs to do the same, and every weight
// after every step. Read by compare.py; run by scripts/heavy/pytorch.
//   train FOLDER mse|paper plain|batch_norm adam|adam_w_cosine
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "pinnquad/pinnquad.hpp"

namespace {

using namespace pinnquad;

constexpr int rows = 19 * 64 + 17;  // 20 batches, the last a small one
constexpr int epochs = 10;
constexpr int unseen_rows = 50;

using Plain = Mlp<double, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>;
using Normed = BatchNormMlp<double, InputSize<16>, Hidden<10, 25>, OutputSize<4>, Relu>;
using Knowledge = Context<PaperFeatures, PaperQuadrotor>;
using Data = TrainingData<double, 16, 4>;

template <class Values>
void write(const std::string& path, const Values& values) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(values.data()[0])));
  if (!file.flush()) {
    std::fprintf(stderr, "train: could not write %s\n", path.c_str());
    std::exit(1);
  }
}

/// Normal features; outputs bend and carry noise, so that no gradient vanishes.
Data draw(int count, std::mt19937_64& engine) {
  Data data;
  for (int row = 0; row < count; ++row) {
    double x[16];
    for (double& v : x) data.features.push_back(v = standard_normal(engine));
    for (int k = 0; k < 4; ++k) {
      data.outputs.push_back(std::sin(x[k] + 0.5 * x[k + 4]) + x[k + 8] * x[15] / 2 + 0.1 * standard_normal(engine));
    }
  }
  return data;
}

/// Shuffled batches whose rows are noted.
struct NotedBatches {
  std::vector<std::int32_t>* noted;
  template <class Engine>
  void arrange(std::vector<int>& order, Engine& engine) const {
    shuffle(order, engine);
    noted->insert(noted->end(), order.begin(), order.end());
  }
};

Knowledge knowledge() {
  Knowledge context;
  context.output.mean = {0.50, 0.52, 0.54, 0.56};
  context.output.standard_deviation = {0.03, 0.04, 0.05, 0.06};
  context.signed_sum_deviation = {0.11, 0.07, 0.05};
  return context;
}

template <class Net, class Loss, class Optimizer>
void train(const std::string& folder, const Loss& loss, const Optimizer& optimizer) {
  std::mt19937_64 engine(2024);
  const Data data = draw(rows, engine), unseen = draw(unseen_rows, engine);
  const Knowledge context = knowledge();
  Net network = initialised<Net>(engine);
  for (double& p : network.parameters)
    p += uniform(engine, -0.05, 0.05);  // biases, gammas, betas: none at its neutral value

  std::vector<std::int32_t> order;
  std::vector<double> weights(network.parameters.begin(), network.parameters.end());
  using Type = Trainer<Net, Loss, Optimizer, Knowledge, NotedBatches>;
  const auto trainer = std::make_unique<Type>(network, loss, optimizer, context, NotedBatches{&order});
  for (int epoch = 0; epoch < epochs; ++epoch) {
    trainer->epoch(data, {epoch, epochs}, engine, [&](const Type& t) {
      const auto now = t.network().parameters;
      weights.insert(weights.end(), now.begin(), now.end());
    });
  }

  const auto flown = folded(trainer->network());
  std::vector<double> predictions(4 * unseen_rows);
  for (int row = 0; row < unseen_rows; ++row) flown.forward(unseen.features_of(row), predictions.data() + 4 * row);

  std::vector<double> scales(context.output.mean.begin(), context.output.mean.end());
  scales.insert(scales.end(), context.output.standard_deviation.begin(), context.output.standard_deviation.end());
  scales.insert(scales.end(), context.signed_sum_deviation.begin(), context.signed_sum_deviation.end());
  write(folder + "/features.f64", data.features);
  write(folder + "/outputs.f64", data.outputs);
  write(folder + "/order.i32", order);
  write(folder + "/scales.f64", scales);
  write(folder + "/weights.f64", weights);
  write(folder + "/unseen.f64", unseen.features);
  write(folder + "/predictions.f64", predictions);
}

template <class Net, class Loss>
void train(const std::string& folder, const Loss& loss, bool decoupled) {
  if (decoupled) {
    train<Net>(folder, loss, Scheduled<AdamW, CosineDecay>{AdamW{3e-3, 0.9, 0.999, 1e-8, 1e-2}, {}});
  } else {
    train<Net>(folder, loss, Adam{1e-3, 0.9, 0.999, 1e-8, 1e-3});
  }
}

template <class Loss>
void train(const std::string& folder, const Loss& loss, bool normed, bool decoupled) {
  if (normed) {
    train<Normed>(folder, loss, decoupled);
  } else {
    train<Plain>(folder, loss, decoupled);
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) {
    std::fprintf(stderr, "usage: train FOLDER mse|paper plain|batch_norm adam|adam_w_cosine\n");
    return 2;
  }
  const std::string folder = arguments[1];
  const bool normed = std::string(arguments[3]) == "batch_norm",
             decoupled = std::string(arguments[4]) == "adam_w_cosine";
  if (std::string(arguments[2]) == "paper") {
    CyclicalAnnealing annealing;
    annealing.cycles = 2;  // of five epochs: held for three, falling for two
    PaperLoss<CyclicalAnnealing> loss;
    std::apply([&](auto&... term) { ((term.schedule = annealing), ...); }, loss.terms);
    train(folder, loss, normed, decoupled);
  } else {
    train(folder, Mse{}, normed, decoupled);
  }
  return 0;
}
