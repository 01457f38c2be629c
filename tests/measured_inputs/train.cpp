// SPDX-License-Identifier: MIT
// Flights with batteries of many charges, recorded as CSV with the voltage, read, split by flight, trained on and
// exported: a model with the voltage as an input, and one that sees it and the motion twice, 50 ms apart.
//   train_measured_inputs FOLDER     writes voltage_model.hpp and window_model.hpp
#include <cstdio>
#include <memory>
#include <random>
#include <string>

#include "battery.hpp"
#include "pinnquad/data/csv.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/simulation/simulator.hpp"
#include "pinnquad/training/adam.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/optimizer.hpp"
#include "pinnquad/training/trainer.hpp"

namespace {

using namespace battery;

/// The vehicle's rows, and the voltage that the pack's sensor shows.
struct VoltageRecorder : ExactRecorder {
  std::vector<ColumnName> columns() const { return {{BatteryVoltage::name, BatteryVoltage::unit}}; }
  template <class Quadrotor>
  void measure(const Quadrotor& /*quadrotor*/, const VehicleState<double>& state, double* values) const {
    values[0] = pack.voltage_V(state.time_s);
  }
  Pack pack;
};

/// One flight through a file, as `train` would read it.
Flight recorded(const std::string& folder, double start_V, std::uint64_t seed) {
  const Vehicle quadrotor = vehicle(start_V);
  FlightPlan plan;
  plan.samples = 1500;
  const RandomPilot<std::mt19937_64> pilot(std::mt19937_64(seed), pilot_style(quadrotor, plan.start_m, 5.0),
                                           quadrotor.site().ground_z_m);
  VoltageRecorder recorder;
  recorder.pack.start_V = start_V;
  const RecordedFlight flown = fly(quadrotor, pilot, plan, recorder);
  const std::string path = folder + "/flight_" + std::to_string(seed) + ".csv";
  write_flight_csv(path, flown.flight);
  Flight flight = read_flight_csv(path, minimum_flight_rows, wanted_columns<Past>());
  flight.name = std::to_string(seed);
  return flight;
}

/// Root of the mean square error of the commands on rows that were not trained on.
template <class Model>
double error_of(const Model& model, const RowSet& rows) {
  double squares = 0;
  std::size_t count = 0;
  each_features<typename Model::Features, float>(rows, [&](const Flight& flight, std::size_t row, const auto& x) {
    const auto u = model.predict(x);
    for (std::size_t i = 0; i < u.size(); ++i) {
      const double difference = double(u[i]) - flight[row].commands[i];
      squares += difference * difference;
      ++count;
    }
  });
  return std::sqrt(squares / double(count));
}

template <class Features>
auto trained(const RowSplit& split) {
  using Net = Mlp<float, InputSize<Features::size>, Hidden<2, 32>, OutputSize<4>, Tanh>;
  using Setting = Context<Features, PaperQuadrotor>;
  const auto context = make_context<Setting>(split.train);
  const auto data = standardised<float>(context, split.train);
  std::mt19937_64 engine(5);
  Scheduled<Adam, CosineDecay> optimiser;
  optimiser.optimizer.learning_rate = 3e-3;
  using Training = Trainer<Net, Mse, Scheduled<Adam, CosineDecay>, Setting>;
  const auto trainer = std::make_unique<Training>(initialised<Net>(engine), Mse{}, optimiser, context);
  constexpr int epochs = 60;
  for (int epoch = 0; epoch < epochs; ++epoch) trainer->epoch(data, {epoch, epochs}, engine);
  return make_trained_model(trainer->network(), context, split.train);
}

template <class Model>
void write(const std::string& path, const std::string& name, const Model& model, const Dataset& dataset,
           const RowSplit& split) {
  std::vector<typename Model::FeatureVector> golden;
  each_features<typename Model::Features, float>(split.train, [&](const Flight&, std::size_t row, const auto& x) {
    if (row % 500 == 100) golden.push_back(x);
  });
  write_model_header(path, name, model, golden,
                     {"four flights", content_hash(dataset), split.train.size(), 5, 60, "MSE"});
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const std::string folder = arguments[1];
  Dataset dataset;
  std::uint64_t seed = 1;
  for (const double start_V : {16.8, 15.9, 15.0, 16.2, 15.6}) dataset.add(recorded(folder, start_V, seed++));
  const RowSplit split = split_by_flight(dataset);
  const auto blind = trained<PaperFeatures>(split);
  const auto voltage = trained<Voltage>(split);
  const auto past = trained<Past>(split);
  const double of_blind = error_of(blind, split.test), of_voltage = error_of(voltage, split.test),
               of_past = error_of(past, split.test);
  std::printf(
      "RMSE of the commands on a flight that was not trained on: %.4f without voltage, %.4f with, %.4f windowed\n",
      of_blind, of_voltage, of_past);
  write(folder + "/voltage_model.hpp", "VoltageModel", voltage, dataset, split);
  write(folder + "/window_model.hpp", "WindowModel", past, dataset, split);
  return of_voltage < 0.6 * of_blind && of_past < 0.6 * of_blind ? 0 : 1;
}
