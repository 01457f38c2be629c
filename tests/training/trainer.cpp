// SPDX-License-Identifier: MIT
#include "pinnquad/training/trainer.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/initialization.hpp"
#include "support/central_difference.hpp"
#include "support/loss_batches.hpp"
#include "support/plain_network.hpp"
#include "support/random_network.hpp"
#include "support/training_sets.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

/// Batches in recorded order.
struct TimeOrderedBatches {
  template <class Engine>
  void arrange(std::vector<int>&, Engine&) const {}
};

template <class Scalar>
using Small = Mlp<Scalar, InputSize<16>, Hidden<2, 9>, OutputSize<4>, Relu>;
using PaperContext = Context<PaperFeatures, PaperQuadrotor>;
using SpeedContext = Context<PaperFeatures, PaperQuadrotor, RotorSpeedOutputs>;

/// Data none of whose rows comes near a kink of this network.
template <class Net>
pinnquad::TrainingData<double, 16, 4> off_the_kinks(const Net& net, const plain::Network& sizes, int rows) {
  std::mt19937_64 engine(121);
  pinnquad::TrainingData<double, 16, 4> data;
  while (data.size() < rows) {
    std::vector<double> x(16);
    for (double& v : x) v = pinnquad::standard_normal(engine);
    if (plain::forward(sizes, net.parameters, x).smallest_pre_activation < kink_margin) continue;
    data.features.insert(data.features.end(), x.begin(), x.end());
    for (int k = 0; k < 4; ++k) data.outputs.push_back(pinnquad::standard_normal(engine));
  }
  return data;
}

/// Loss of these rows, without the trainer: plain forward pass, then the loss on the batch.
template <class Loss, class ContextType, class Parameters>
double plain_loss(const Loss& loss, const ContextType& context, const plain::Network& sizes,
                  const Parameters& parameters, const pinnquad::TrainingData<double, 16, 4>& data,
                  const std::vector<int>& rows) {
  pinnquad::test::PaperBatch<double> batch;
  batch.resize(static_cast<int>(rows.size()));
  for (int i = 0; i < batch.size(); ++i) {
    const int row = rows[static_cast<std::size_t>(i)];
    const std::vector<double> x(data.features_of(row), data.features_of(row) + 16);
    const auto y = plain::forward(sizes, parameters, x).outputs;
    for (int k = 0; k < 16; ++k) batch.features(k, i) = x[static_cast<std::size_t>(k)];
    for (int k = 0; k < 4; ++k) {
      batch.prediction(k, i) = y[static_cast<std::size_t>(k)];
      batch.target(k, i) = data.outputs_of(row)[k];
    }
  }
  pinnquad::test::PaperBatch<double>::Gradient unused;
  unused.setZero(4, batch.size());
  return loss.evaluate(context, batch, 1.0, unused);
}

template <class Loss, class ContextType>
void check_whole() {
  const plain::Network sizes{{16, 9, 9, 4}, plain::Activation::relu};
  std::mt19937_64 engine(122);
  auto net = initialised<Small<double>>(engine);
  for (double& p : net.parameters) p += pinnquad::uniform(engine, -0.2, 0.2);  // biases too
  const auto data = off_the_kinks(net, sizes, 64);
  auto context = flight_context<ContextType>();
  context.progress = {7, 20};
  const Loss loss{};
  auto trainer = std::make_unique<Trainer<Small<double>, Loss, Adam, ContextType>>(net, loss, Adam{}, context);
  for (const int size : {64, 1, 40, 2, 63, 3, 5}) {
    CAPTURE(size);
    std::vector<int> rows(static_cast<std::size_t>(size));
    for (int& row : rows) row = static_cast<int>(pinnquad::uniform_index(engine, 64));
    const double value = trainer->differentiate(data, rows.data(), size);
    const auto gradient = trainer->parameter_gradient();
    const auto evaluate = [&] { return plain_loss(loss, context, sizes, net.parameters, data, rows); };
    CHECK(value == doctest::Approx(evaluate()).epsilon(1e-12));
    const auto numerical = central_differences(evaluate, net.parameters.data(), net.parameters.size());
    CHECK(gradient_error(gradient.data(), numerical.data(), numerical.size()) <= gradient_tolerance);
    CHECK(trainer->network().parameters == net.parameters);  // nothing was changed
  }
}

template <class TrainerType, class Data>
auto trained(const Data& data, std::uint64_t seed, int epochs, double* last_loss = nullptr) {
  using Network = typename TrainerType::Network;
  std::mt19937_64 engine(seed);
  auto trainer = std::make_unique<TrainerType>(initialised<Network>(engine), PaperLoss<CyclicalAnnealing>{}, Adam{},
                                               flight_context<PaperContext>());
  for (int epoch = 0; epoch < epochs; ++epoch) {
    const double loss = trainer->epoch(data, Progress{epoch, epochs}, engine);
    if (last_loss != nullptr) *last_loss = loss;
  }
  return trainer->network().parameters;
}

}  // namespace

TEST_CASE("gradient of the whole: network, loss, context, whole and partial batches") {
  SUBCASE("mse") { check_whole<Mse, PaperContext>(); }
  SUBCASE("physics-informed") { check_whole<PaperLoss<CyclicalAnnealing>, PaperContext>(); }
  SUBCASE("physics-informed, rotor speeds") { check_whole<PaperLoss<Constant>, SpeedContext>(); }
}

TEST_CASE_TEMPLATE("the same seed gives the same bits, another seed others", Scalar, float, double) {
  using Type = Trainer<Small<Scalar>, PaperLoss<CyclicalAnnealing>, Adam, PaperContext>;
  const auto data = known_map<Scalar>(200, 131);  // 3 batches of 64 and one of 8
  const auto first = trained<Type>(data, 1, 4);
  CHECK(first == trained<Type>(data, 1, 4));
  CHECK(first != trained<Type>(data, 2, 4));
}

TEST_CASE("training lowers the loss; a linear map is learned") {
  using Type = Trainer<Small<float>, PaperLoss<CyclicalAnnealing>, Adam, PaperContext>;
  const auto data = known_map<float>(640, 132);
  double early = 0.0, late = 0.0;
  trained<Type>(data, 3, 1, &early);
  trained<Type>(data, 3, 40, &late);
  CHECK(late < 0.5 * early);

  using Linear = pinnquad::Network<double, InputSize<16>, pinnquad::Dense<4>>;
  using Straight = Trainer<Linear, Mse, Adam, PaperContext>;
  const auto lines = linear_map<double>(256, 133);
  std::mt19937_64 engine(4);
  auto trainer =
      std::make_unique<Straight>(initialised<Linear>(engine), Mse{}, Adam{0.02, 0.9, 0.999, 1e-8, 0.0}, PaperContext{});
  double loss = 0.0;
  for (int epoch = 0; epoch < 200; ++epoch) loss = trainer->epoch(lines, Progress{epoch, 200}, engine);
  CHECK(loss < 1e-6);
  // the map itself, not only its values: weight (k, i) = cos(1.7 (i + 1) (k + 1)) / 4, bias k / 10
  const auto parameters = trainer->network().parameters;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < 16; ++i) {
      const double weight = std::cos(1.7 * static_cast<double>((i + 1) * (k + 1))) / 4.0;
      CHECK(std::fabs(parameters[k * 16 + i] - weight) < 2e-3);
    }
    CHECK(std::fabs(parameters[64 + k] - 0.1 * static_cast<double>(k)) < 2e-3);
  }
}

TEST_CASE("an epoch is its batches: every row once, the last batch as small as it comes") {
  const auto data = known_map<double>(70, 134);
  std::mt19937_64 engine(5);
  const auto net = initialised<Small<double>>(engine);
  using Ordered = Trainer<Small<double>, Mse, Adam, PaperContext, TimeOrderedBatches, 32>;
  auto by_epoch = std::make_unique<Ordered>(net, Mse{}, Adam{}, PaperContext{});
  auto by_hand = std::make_unique<Ordered>(net, Mse{}, Adam{}, PaperContext{});
  std::vector<int> rows(70);
  for (int i = 0; i < 70; ++i) rows[static_cast<std::size_t>(i)] = i;
  const double mean = by_epoch->epoch(data, Progress{0, 1}, engine);
  double sum = 32 * by_hand->batch(data, rows.data(), 32);
  sum += 32 * by_hand->batch(data, rows.data() + 32, 32);
  sum += 6 * by_hand->batch(data, rows.data() + 64, 6);
  CHECK(by_epoch->network().parameters == by_hand->network().parameters);
  CHECK(mean == doctest::Approx(sum / 70));  // over samples, not over batches
  CHECK(by_epoch->steps() == 3);
}

TEST_CASE("order: time-ordered keeps the rows, shuffled permutes them anew each epoch") {
  std::mt19937_64 engine(6);
  std::vector<int> order = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  const auto recorded = order;
  ShuffledBatches{}.arrange(order, engine);
  const auto first = order;
  CHECK(order != recorded);
  ShuffledBatches{}.arrange(order, engine);
  CHECK(order != first);
  std::sort(order.begin(), order.end());
  CHECK(order == recorded);  // a permutation

  const auto data = known_map<double>(100, 135);
  const auto net = initialised<Small<double>>(engine);
  const auto run = [&](auto policy) {
    using Type = Trainer<Small<double>, Mse, Adam, PaperContext, decltype(policy), 32>;
    auto trainer = std::make_unique<Type>(net, Mse{}, Adam{}, PaperContext{}, policy);
    std::mt19937_64 draws(7);
    trainer->epoch(data, Progress{0, 1}, draws);
    return trainer->network().parameters;
  };
  CHECK(run(ShuffledBatches{}) != run(TimeOrderedBatches{}));
}

TEST_CASE("a trainer is a value: a copy goes on by itself, with its own moments") {
  using Type = Trainer<Small<double>, PaperLoss<CyclicalAnnealing>, Adam, PaperContext>;
  const auto data = known_map<double>(100, 136);
  std::mt19937_64 engine(8);
  auto original = std::make_unique<Type>(initialised<Small<double>>(engine), PaperLoss<CyclicalAnnealing>{}, Adam{},
                                         flight_context<PaperContext>());
  original->epoch(data, Progress{0, 3}, engine);
  auto copy = std::make_unique<Type>(*original);
  auto engine_of_copy = engine;
  const auto before = original->network().parameters;
  copy->epoch(data, Progress{1, 3}, engine_of_copy);
  CHECK(original->network().parameters == before);
  CHECK(copy->network().parameters != before);
  original->epoch(data, Progress{1, 3}, engine);
  CHECK(original->network().parameters == copy->network().parameters);
  const auto expected = copy->network().parameters;
  original.reset();
  CHECK(copy->network().parameters == expected);
}

TEST_CASE("after steps, the gradient is that of the network as it stands") {
  using Type = Trainer<Small<double>, PaperLoss<CyclicalAnnealing>, Adam, PaperContext>;
  const auto data = known_map<double>(64, 138);
  std::mt19937_64 engine(12);
  const auto context = flight_context<PaperContext>();
  const Adam fast{0.05, 0.9, 0.999, 1e-8, 0.0};
  auto trainer =
      std::make_unique<Type>(initialised<Small<double>>(engine), PaperLoss<CyclicalAnnealing>{}, fast, context);
  std::vector<int> rows(64);
  std::iota(rows.begin(), rows.end(), 0);
  for (int step = 0; step < 3; ++step) {
    trainer->batch(data, rows.data(), 64);
    auto fresh = std::make_unique<Type>(trainer->network(), PaperLoss<CyclicalAnnealing>{}, fast, context);
    const double value = trainer->differentiate(data, rows.data(), 64);
    CHECK(value == fresh->differentiate(data, rows.data(), 64));
    CHECK(trainer->parameter_gradient() == fresh->parameter_gradient());
  }
}

TEST_CASE("the schedule follows the epoch that the trainer is told") {
  using Type = Trainer<Small<double>, PaperLoss<CyclicalAnnealing>, Adam, PaperContext>;
  const auto data = known_map<double>(64, 137);
  std::mt19937_64 engine(9);
  const auto net = initialised<Small<double>>(engine);
  const auto loss_in_epoch = [&](int epoch) {
    auto trainer = std::make_unique<Type>(net, PaperLoss<CyclicalAnnealing>{}, Adam{}, flight_context<PaperContext>());
    std::mt19937_64 draws(10);
    return trainer->epoch(data, Progress{epoch, 300}, draws);
  };
  CHECK(loss_in_epoch(0) == loss_in_epoch(60));
  CHECK(loss_in_epoch(0) > loss_in_epoch(59));
  CHECK(loss_in_epoch(45) > loss_in_epoch(59));
}

TEST_CASE("no data: no step, loss 0") {
  std::mt19937_64 engine(11);
  using Type = Trainer<Small<double>, Mse, Adam, PaperContext>;
  auto trainer = std::make_unique<Type>(initialised<Small<double>>(engine), Mse{}, Adam{}, PaperContext{});
  CHECK(trainer->epoch({}, Progress{0, 1}, engine) == 0.0);
  CHECK(trainer->steps() == 0);
}

TEST_CASE("a batch that is none is refused, and nothing has changed") {
  using Type = Trainer<Small<double>, Mse, Adam, PaperContext, ShuffledBatches, 8>;
  std::mt19937_64 engine(14);
  const auto net = initialised<Small<double>>(engine);
  const auto trainer = std::make_unique<Type>(net, Mse{}, Adam{}, PaperContext{});
  const auto data = known_map<double>(200, 140);
  std::vector<int> rows(200);
  std::iota(rows.begin(), rows.end(), 0);
  CHECK_THROWS_WITH_AS(trainer->batch(data, rows.data(), 9), "Trainer: expected 1 to 8 rows in a batch, found 9",
                       std::invalid_argument);
  CHECK_THROWS_AS(trainer->batch(data, rows.data(), 200), std::invalid_argument);
  CHECK_THROWS_AS(trainer->differentiate(data, rows.data(), 9), std::invalid_argument);
  CHECK_THROWS_AS(trainer->batch(data, rows.data(), 0), std::invalid_argument);  // the mean over no rows is NaN
  CHECK_THROWS_AS(trainer->batch(data, rows.data(), -1), std::invalid_argument);
  rows[3] = 200;
  CHECK_THROWS_WITH_AS(trainer->batch(data, rows.data(), 8), "Trainer: expected a row from 0 to below 200, found 200",
                       std::invalid_argument);
  rows[3] = -1;
  CHECK_THROWS_AS(trainer->batch(data, rows.data(), 8), std::invalid_argument);
  rows[3] = 3;
  auto broken = data;
  broken.outputs[4 * 3 + 1] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH_AS(trainer->batch(broken, rows.data(), 8),
                       "Trainer: expected finite numbers, found others in row 3", std::invalid_argument);
  auto torn = data;
  torn.features.pop_back();
  CHECK_THROWS_WITH_AS(trainer->epoch(torn, {0, 1}, engine),
                       "Trainer: expected rows of 16 features and 4 outputs, found 3199 and 800 numbers",
                       std::invalid_argument);
  CHECK_THROWS_AS(trainer->validate(torn), std::invalid_argument);
  CHECK(trainer->steps() == 0);
  CHECK(trainer->network().parameters == net.parameters);
}

TEST_CASE("an epoch past the last, or before the first, is refused") {
  using Type = Trainer<Small<double>, Mse, Adam, PaperContext>;
  std::mt19937_64 engine(15);
  const auto trainer = std::make_unique<Type>(initialised<Small<double>>(engine), Mse{}, Adam{}, PaperContext{});
  const auto data = known_map<double>(10, 141);
  CHECK_THROWS_WITH_AS(trainer->epoch(data, {3, 3}, engine), "Trainer: expected an epoch from 0 to below 3, found 3",
                       std::invalid_argument);
  CHECK_THROWS_AS(trainer->epoch(data, {-1, 3}, engine), std::invalid_argument);
  CHECK_THROWS_AS(trainer->epoch(data, {0, 0}, engine), std::invalid_argument);
  CHECK(trainer->steps() == 0);
  CHECK_NOTHROW(trainer->epoch(data, {2, 3}, engine));
}

namespace {
/// Loses a row.
struct ShortOrder {
  template <class Engine>
  void arrange(std::vector<int>& order, Engine&) const {
    order.pop_back();
  }
};
}  // namespace

TEST_CASE("an order policy must keep every row") {
  using Type = Trainer<Small<double>, Mse, Adam, PaperContext, ShortOrder>;
  std::mt19937_64 engine(16);
  const auto trainer = std::make_unique<Type>(initialised<Small<double>>(engine), Mse{}, Adam{}, PaperContext{});
  CHECK_THROWS_WITH_AS(trainer->epoch(known_map<double>(10, 142), {0, 1}, engine),
                       "Trainer: expected an order of 10 rows as in the data, found 9", std::invalid_argument);
}

TEST_CASE("a loss whose numbers make no sense does not begin a training") {
  using Loss = PaperLoss<CyclicalAnnealing>;
  using Type = Trainer<Small<double>, Loss, Adam, PaperContext>;
  std::mt19937_64 engine(17);
  const auto net = initialised<Small<double>>(engine);
  Loss loss{};
  SUBCASE("no cycle") {
    std::get<1>(loss.terms).schedule.cycles = 0;
    CHECK_THROWS_WITH_AS(std::make_unique<Type>(net, loss, Adam{}, PaperContext{}),
                         "CyclicalAnnealing::cycles: expected a number from 1, found 0", std::invalid_argument);
  }
  SUBCASE("a context of rows with a NaN") {
    PaperContext context;
    context.input.mean[5] = context.input.standard_deviation[5] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(std::make_unique<Type>(net, loss, Adam{}, context),
                         "Context::input: expected a finite number, found nan", std::invalid_argument);
  }
  SUBCASE("a spread of 0") {
    PaperContext context;
    context.signed_sum_deviation[2] = 0.0;
    CHECK_THROWS_WITH_AS(std::make_unique<Type>(net, loss, Adam{}, context),
                         "Context::signed_sum_deviation: expected a standard deviation above 0, found 0",
                         std::invalid_argument);
  }
  SUBCASE("gain") {
    std::get<2>(loss.terms).loss.gain = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(std::make_unique<Type>(net, loss, Adam{}, PaperContext{}),
                         "LocalMonotonicity::gain: expected a finite number from 0, found nan", std::invalid_argument);
  }
}

TEST_CASE("an observer sees the trainer after each step, and changes nothing") {
  const auto data = known_map<double>(70, 139);
  std::mt19937_64 engine(13);
  const auto net = initialised<Small<double>>(engine);
  using Ordered = Trainer<Small<double>, Mse, Adam, PaperContext, TimeOrderedBatches, 32>;
  auto seen = std::make_unique<Ordered>(net, Mse{}, Adam{}, PaperContext{});
  auto unseen = std::make_unique<Ordered>(net, Mse{}, Adam{}, PaperContext{});
  std::vector<Small<double>::Parameters> weights;
  std::vector<long> steps;
  const double loss = seen->epoch(data, Progress{0, 1}, engine, [&](const Ordered& trainer) {
    weights.push_back(trainer.network().parameters);
    steps.push_back(trainer.steps());
  });
  CHECK(loss == unseen->epoch(data, Progress{0, 1}, engine));
  CHECK(steps == std::vector<long>{1, 2, 3});
  CHECK(weights[0] != weights[1]);
  CHECK(weights[2] == unseen->network().parameters);
}
