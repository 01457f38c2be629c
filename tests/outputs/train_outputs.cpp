// SPDX-License-Identifier: MIT
// Flies the simulator, trains one model per output schema on that flight and writes the headers.
//   train_outputs FOLDER
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "outputs/setting.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "pinnquad/schedule/constant.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/trainer.hpp"

namespace {

using namespace pinnquad;

template <class Schema>
void train(const Flight& flight, const std::string& folder, const std::string& file, const std::string& name) {
  using Surroundings = Context<PaperFeatures, PaperQuadrotor, Schema>;
  using Net = Mlp<float, Inputs<PaperFeatures::size>, Hidden<2, 20>, Outputs<Schema::size>, Tanh>;
  using Loss = PaperLoss<Constant>;
  const IndexRange rows{0, flight.size()};
  const auto context = make_context<Surroundings>(flight, rows);
  const auto data = standardised<float>(context, flight, rows);
  std::mt19937_64 engine(5);
  Loss loss;
  std::apply([](auto&... term) { ((term.schedule.value = 1e-3), ...); }, loss.terms);
  auto trainer =
      std::make_unique<Trainer<Net, Loss, Adam, Surroundings>>(initialised<Net>(engine), loss, Adam{}, context);
  constexpr int epochs = 240;
  for (int epoch = 0; epoch < epochs; ++epoch) trainer->epoch(data, {epoch, epochs}, engine);
  const auto model = make_trained_model(trainer->network(), context, flight, rows);
  std::vector<typename decltype(model)::FeatureVector> golden;
  for (std::size_t i = 0; i < 4; ++i) golden.push_back(sample_features<PaperFeatures, float>(flight[100 + 700 * i]));
  write_model_header(folder + "/" + file, name, model, golden,
                     {"simulated flight", content_hash(flight), flight.size(), 5, epochs, "PaperLoss"});
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  try {
    const test::Flown vehicle = test::flown_vehicle();
    FlightPlan plan;
    plan.samples = 4000;
    const RandomPilot<std::mt19937_64> pilot(std::mt19937_64(11), pilot_style(vehicle, plan.start_m),
                                             vehicle.site().ground_z_m);
    const RecordedFlight recorded = fly(vehicle, pilot, plan);
    if (recorded.flight.size() != plan.samples) throw std::runtime_error("the flight ended early");
    const std::string folder = arguments[1];
    train<AccelerationOutputs>(recorded.flight, folder, "accelerations.hpp", "AccelerationsModel");
    train<WrenchOutputs>(recorded.flight, folder, "wrench.hpp", "WrenchModel");
    train<ResidualOutputs<LinearizedInverse>>(recorded.flight, folder, "residual.hpp", "ResidualModel");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "train_outputs: %s\n", error.what());
    return 1;
  }
  return 0;
}
