// SPDX-License-Identifier: MIT
// A project of your own: trains a network whose features, layers, loss and optimiser are the types below, which
// `pinnquad train` has no options for. Copy this file beside the CMakeLists.txt of docs/start.md and edit the types.
//   train FOLDER FLIGHT.csv
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <random>
#include <stdexcept>
#include <utility>

#include <pinnquad/pinnquad.hpp>

using namespace pinnquad;

using MyAirframe = PaperQuadrotor;  // yours as a struct: pinnquad airframe convert mine.toml --out mine.hpp
using MyFeatures = PaperFeatures;   // or WithColumns<PaperFeatures, BatteryVoltage>, Windowed<...>
using MyOutputs = CommandOutputs;   // or WrenchOutputs
using MyNetwork = Mlp<float, InputSize<MyFeatures::size>, Hidden<10, 25>, OutputSize<4>, Relu>;
using MyLoss = PaperLoss<CyclicalAnnealing>;  // or Mse
using MyOptimizer = Adam;                     // or Scheduled<AdamW, CosineDecay>
// The header says this of the loss: edit both.
constexpr const char* my_loss_in_words = "MSE + local monotonicity (roll, pitch, yaw), cyclical annealing";
constexpr int my_epochs = 300;
constexpr unsigned my_seed = 1;

int main(int count, char** arguments) try {
  if (count != 3) throw std::invalid_argument("expected FOLDER FLIGHT.csv");
  Flight flight = read_flight_csv(arguments[2], minimum_flight_rows, wanted_columns<MyFeatures>());
  flight.name = std::filesystem::path(arguments[2]).filename().string();
  require_plausible(arguments[2], flight);
  Dataset flights;
  flights.add(std::move(flight));
  const auto split = split_for_training(flights);  // one flight: 60 % train, 20 % validate, 20 % test, in time

  using MyContext = Context<MyFeatures, MyAirframe, MyOutputs>;
  const auto context = make_context<MyContext>(split.train);
  const auto data = standardised<MyNetwork::Scalar>(context, split.train);
  const auto validation = standardised<MyNetwork::Scalar>(context, split.validation);
  std::mt19937_64 engine(my_seed);
  using MyTrainer = Trainer<MyNetwork, MyLoss, MyOptimizer, MyContext>;
  const auto trainer = std::make_unique<MyTrainer>(initialised<MyNetwork>(engine), MyLoss{}, MyOptimizer{}, context);
  Checkpoint<MyNetwork> best;
  for (int epoch = 0; epoch < my_epochs; ++epoch) {
    const double loss = trainer->epoch(data, {epoch, my_epochs}, engine);
    best.offer(epoch, trainer->validate(validation).mean_absolute, *trainer);
    std::printf("epoch %d of %d: loss %.4f, best error %.4f\n", epoch + 1, my_epochs, loss, best.error());
  }

  const auto model = make_trained_model(best.network(), context, split.train);
  const Verdict verdict = verdict_on(model, split.train, split.test);
  std::printf("test rows: R^2 %.4f, of linear regression %.4f\n", verdict.test_r_squared,
              verdict.linear_regression_r_squared);
  if (verdict.worse_than_mean()) throw std::runtime_error("not exported: worse than the mean of the commands");
  export_model(arguments[1], "MyModel", model, split,
               provenance_of(flights, split, my_seed, my_epochs, my_loss_in_words, verdict));
} catch (const std::exception& error) {
  std::fprintf(stderr, "train: %s\n", error.what());
  return 2;
}
