// SPDX-License-Identifier: MIT
// Flies the simulator, trains one model per output schema on that flight and writes the headers.
//   train_models FOLDER
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "pinnquad/aero/drag.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/evaluation/errors.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/outputs/wrench_outputs.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/structured/residual_fit.hpp"
#include "pinnquad/training/trainer.hpp"

namespace {

using namespace pinnquad;

template <class Features>
auto golden_of(const Flight& flight) {
  std::vector<std::array<float, Features::size>> golden;
  for (std::size_t i = 0; i < 4; ++i) golden.push_back(sample_features<Features, float>(flight[100 + 700 * i]));
  return golden;
}

template <class Schema>
auto train(const Flight& flight, const std::string& folder, const std::string& file, const std::string& name) {
  using Surroundings = Context<PaperFeatures, PaperQuadrotor, Schema>;
  using Net = Mlp<float, InputSize<PaperFeatures::size>, Hidden<2, 20>, OutputSize<OutputMap<Schema>::size>, Tanh>;
  using Loss = PaperLoss<Constant>;
  const RowSet rows(flight, {0, flight.size()});
  const auto context = make_context<Surroundings>(rows);
  const auto data = standardised<float>(context, rows);
  std::mt19937_64 engine(5);
  Loss loss;
  std::apply([](auto&... term) { ((term.schedule.value = 1e-3), ...); }, loss.terms);
  auto trainer =
      std::make_unique<Trainer<Net, Loss, Adam, Surroundings>>(initialised<Net>(engine), loss, Adam{}, context);
  constexpr int epochs = 240;
  for (int epoch = 0; epoch < epochs; ++epoch) trainer->epoch(data, {epoch, epochs}, engine);
  auto model = make_trained_model(trainer->network(), context, rows);
  write_model_header(folder + "/" + file, name, model, golden_of<PaperFeatures>(flight),
                     {"simulated flight", content_hash(flight), flight.size(), 5, epochs, "PaperLoss"});
  return model;
}

/// Least squares of the flight: one affine layer.
template <class Trained>
void write_ridge(const Flight& flight, const Trained& envelope, const std::string& file) {
  std::vector<std::array<double, 16>> x;
  std::vector<std::array<double, 4>> y;
  for (const Sample& sample : flight) {
    x.push_back(sample_features<PaperFeatures, double>(sample));
    y.push_back(sample.commands);
  }
  const auto fit = fit_linear_regression(x, y);
  using Ridge = Network<float, InputSize<16>, Dense<4>>;
  TrainedModel<Ridge, Context<PaperFeatures, PaperQuadrotor>> model;  // its scalers do nothing
  std::size_t at = 0;
  for (const auto& row : fit.coefficients) {
    for (const double v : row) model.network.parameters.at(at++) = float(v);
  }
  for (const double v : fit.intercept) model.network.parameters.at(at++) = float(v);
  model.envelope_lower = envelope.envelope_lower;
  model.envelope_upper = envelope.envelope_upper;
  write_model_header(file, "RidgeModel", model, golden_of<PaperFeatures>(flight),
                     {"simulated flight", content_hash(flight), flight.size(), 0, 0, "none"});
}

using Structured = Context<PhysicsFeatures, PaperQuadrotor, AxisCommandOutputs>;

/// Monotone by construction: a base in closed form and a residual, whether it helps here or not.
void write_structured(const Flight& flight, const std::string& file) {
  using Residual = Mlp<float, InputSize<residual_inputs<PhysicsFeatures>>, Hidden<2, 20>, OutputSize<4>, Tanh>;
  const RowSet training(flight, {0, flight.size() * 3 / 4}), validation(flight, {flight.size() * 3 / 4, flight.size()});
  const auto context = make_context<Structured>(training);
  ResidualTraining how;
  how.epochs = 40;
  std::mt19937_64 engine(5);
  const auto fit = fit_monotone<Residual>(context, training, validation, fit_monotone_base(context, training), how,
                                          engine, [](int) { return true; });
  write_model_header(file, "StructuredModel", make_trained_model(fit.predictor, context, training),
                     golden_of<PhysicsFeatures>(flight),
                     {"simulated flight", content_hash(flight), training.size(), 5, how.epochs, "structured"});
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  try {
    const Quadrotor<double, QuadraticDrag> vehicle(airframe_value<PaperQuadrotor, double>(), paper_site<double>());
    FlightPlan plan;
    plan.samples = 4000;
    const RandomPilot<std::mt19937_64> pilot(std::mt19937_64(11), pilot_style(vehicle, plan.start_m),
                                             vehicle.site().ground_z_m);
    const RecordedFlight recorded = fly(vehicle, pilot, plan);
    if (recorded.flight.size() != plan.samples) throw std::runtime_error("the flight ended early");
    const std::string folder = arguments[1];
    train<AccelerationOutputs>(recorded.flight, folder, "accelerations.hpp", "AccelerationsModel");
    train<WrenchOutputs>(recorded.flight, folder, "wrench.hpp", "WrenchModel");
    const auto residual =
        train<ResidualOutputs<LinearizedBase>>(recorded.flight, folder, "residual.hpp", "ResidualModel");
    train<CommandOutputs>(recorded.flight, folder, "direct.hpp", "DirectModel");
    write_structured(recorded.flight, folder + "/structured.hpp");
    write_ridge(recorded.flight, residual, folder + "/ridge.hpp");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "train_models: %s\n", error.what());
    return 1;
  }
  return 0;
}
