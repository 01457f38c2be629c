// SPDX-License-Identifier: MIT
// Flies the simulator, trains one model per output schema on that flight and writes the headers.
//   train_outputs FOLDER
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "own_outputs/setting.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/evaluation/linear_regression.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/loss/physics_informed.hpp"
#include "pinnquad/model/composition.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "pinnquad/schedule/constant.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/structured/residual_fit.hpp"
#include "pinnquad/training/symmetric_answer.hpp"
#include "pinnquad/training/symmetric_context.hpp"
#include "pinnquad/training/symmetric_rows.hpp"
#include "pinnquad/training/trainer.hpp"

namespace {

using namespace pinnquad;

std::vector<std::array<float, 16>> golden_of(const Flight& flight) {
  std::vector<std::array<float, 16>> golden;
  for (std::size_t i = 0; i < 4; ++i) golden.push_back(sample_features<PaperFeatures, float>(flight[100 + 700 * i]));
  return golden;
}

template <class Schema>
auto train(const Flight& flight, const std::string& folder, const std::string& file, const std::string& name) {
  using Surroundings = Context<PaperFeatures, PaperQuadrotor, Schema>;
  using Net = Mlp<float, InputSize<PaperFeatures::size>, Hidden<2, 20>, OutputSize<OutputMap<Schema>::size>, Tanh>;
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
  auto model = make_trained_model(trainer->network(), context, flight, rows);
  write_model_header(folder + "/" + file, name, model, golden_of(flight),
                     {"simulated flight", content_hash(flight), flight.size(), 5, epochs, "PaperLoss"});
  return model;
}

using Plain = Context<PaperFeatures, PaperQuadrotor>;

/// An answer of one's own making, in the envelope of a trained model; its scalers do nothing.
template <class Answer, class Trained>
void compose(const typename Answer::Parameters& parameters, const Trained& from, const Flight& flight,
             const std::string& file, const std::string& name) {
  TrainedModel<Answer, Plain> model;
  model.network.parameters = parameters;
  model.envelope_lower = from.envelope_lower;
  model.envelope_upper = from.envelope_upper;
  write_model_header(file, name, model, golden_of(flight),
                     {"simulated flight", content_hash(flight), flight.size(), 0, 0, "none"});
}

/// A network with its scalers, as a part.
template <class Trained>
std::vector<float> scaled(const Trained& model) {
  std::vector<float> numbers;
  const auto add = [&numbers](const auto& values) { numbers.insert(numbers.end(), values.begin(), values.end()); };
  add(model.input.mean);
  add(model.input.standard_deviation);
  add(model.output.mean);
  add(model.output.standard_deviation);
  add(model.network.parameters);
  return numbers;
}

template <class Answer>
typename Answer::Parameters joined(std::initializer_list<std::vector<float>> parts) {
  typename Answer::Parameters parameters{};
  std::size_t at = 0;
  for (const auto& part : parts) {
    for (const float number : part) parameters.at(at++) = number;
  }
  if (at != parameters.size()) throw std::logic_error("parts that do not fill the answer");
  return parameters;
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
  std::vector<float> numbers;
  for (const auto& row : fit.coefficients) {
    for (const double v : row) numbers.push_back(float(v));
  }
  for (const double v : fit.intercept) numbers.push_back(float(v));
  using Ridge = Network<float, InputSize<16>, Dense<4>>;
  compose<Ridge>(joined<Ridge>({numbers}), envelope, flight, file, "RidgeModel");
}

/// A trained network cut before its last layer: a trunk, and rotor 1 and the other three as two heads.
template <class Trained>
void write_heads(const Flight& flight, const Trained& from, const std::string& file) {
  using Trunk = Network<float, InputSize<16>, Dense<20>, Tanh, Dense<20>, Tanh>;
  using Whole =
      Scaled<Then<Trunk, Heads<Network<float, InputSize<20>, Dense<1>>, Network<float, InputSize<20>, Dense<3>>>>>;
  const std::vector<float> numbers = scaled(from);
  const auto last_weights = numbers.end() - 84, last_biases = numbers.end() - 4;
  std::vector<float> cut(numbers.begin(), last_weights);
  cut.insert(cut.end(), last_weights, last_weights + 20);
  cut.push_back(*last_biases);
  cut.insert(cut.end(), last_weights + 20, last_biases);
  cut.insert(cut.end(), last_biases + 1, numbers.end());
  compose<Whole>(joined<Whole>({cut}), from, flight, file, "HeadsModel");
}

using Structured = Context<PhysicsFeatures, PaperQuadrotor, AxisCommandOutputs>;

ResidualTraining short_training() {
  ResidualTraining how;
  how.epochs = 40;
  return how;
}

template <class Answer>
void write_structured(const Answer& answer, const Structured& context, const RowSet& rows, const Flight& flight,
                      const std::string& file, const std::string& name) {
  const auto model = make_trained_model(answer, context, rows);
  using Model = std::decay_t<decltype(model)>;
  std::vector<typename Model::FeatureVector> golden;
  for (std::size_t i = 0; i < 4; ++i) {
    golden.push_back(sample_features<PhysicsFeatures, float>(flight[100 + 700 * i]));
  }
  write_model_header(file, name, model, golden,
                     {"simulated flight", content_hash(flight), rows.size(), 5, short_training().epochs, "structured"});
}

/// Monotone by construction: a base in closed form and a residual, whether it helps here or not. Three of them: one that
/// is shown no angular acceleration, the same as its own mirror image, one that is shown it.
void write_structured(const Flight& flight, const std::string& folder) {
  using Residual = Mlp<float, InputSize<residual_inputs<PhysicsFeatures>>, Hidden<2, 20>, OutputSize<4>, Tanh>;
  using Seeing = Mlp<float, InputSize<PhysicsFeatures::size>, Hidden<2, 20>, OutputSize<4>, Tanh>;
  const RowSet training(flight, {0, flight.size() * 3 / 4}), validation(flight, {flight.size() * 3 / 4, flight.size()});
  const auto on = [](int) { return true; };
  std::mt19937_64 engine(5);

  const auto context = make_context<Structured>(training);
  const AffineMap map = fit_monotone_base(context, training);
  const auto fit = fit_monotone<Residual>(context, training, validation, map, short_training(), engine, on);
  write_structured(fit.predictor, context, training, flight, folder + "/structured.hpp", "StructuredModel");
  const auto seeing = fit_path_bounded<Seeing>(context, training, validation, map, short_training(), engine, on);
  write_structured(seeing.predictor, context, training, flight, folder + "/path_bounded.hpp", "PathBoundedModel");

  const SymmetricRows both(training, PaperQuadrotor::value<double>(), {true, false}, engine);
  const auto of_both = context_of_mirror_images(make_context<Structured>(both.rows()));
  const auto mirrored = fit_monotone<Residual>(of_both, both.rows(), validation,
                                               fit_monotone_base(of_both, both.rows()), short_training(), engine, on);
  write_structured(own_mirror_image<PhysicsFeatures, Residual>(mirrored.predictor), of_both, both.rows(), flight,
                   folder + "/symmetric.hpp", "SymmetricModel");
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
    const auto residual =
        train<ResidualOutputs<LinearizedBase>>(recorded.flight, folder, "residual.hpp", "ResidualModel");
    const auto direct = train<CommandOutputs>(recorded.flight, folder, "direct.hpp", "DirectModel");
    write_structured(recorded.flight, folder);
    write_ridge(recorded.flight, residual, folder + "/ridge.hpp");
    write_heads(recorded.flight, direct, folder + "/heads.hpp");
    using Part = Scaled<std::decay_t<decltype(residual.network)>>;
    using Formula = Analytic<float, 16, LinearizedBase, PaperQuadrotor>;
    using Whole = Sum<Formula, Part>;
    compose<Whole>(joined<Whole>({{1.0f}, scaled(residual)}), residual, recorded.flight, folder + "/sum.hpp",
                   "SumModel");
    using Two = Ensemble<Sum<Formula, Part>, 2>;  // one without the formula, one with it
    compose<Two>(joined<Two>({{1.0f}, scaled(residual), {0.0f}, scaled(direct)}), residual, recorded.flight,
                 folder + "/ensemble.hpp", "EnsembleModel");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "train_outputs: %s\n", error.what());
    return 1;
  }
  return 0;
}
