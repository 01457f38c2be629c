// SPDX-License-Identifier: MIT
// Activations, norms and gates are trained on a simulated flight, written as a block, read back to the bit, and fly a
// figure-eight as flight code does.
#include <doctest/doctest.h>

#include <cstring>
#include <functional>
#include <memory>
#include <random>
#include <tuple>

#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/exported/run_time_model.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/nn/activations.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/simulation/tracking.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/trainer.hpp"
#include "support/block_bytes.hpp"

namespace {

using namespace pinnquad;

using Setting = Context<PaperFeatures, PaperQuadrotor>;
constexpr int neurons = 16, epochs = 16;

/// A network of two hidden layers, each with these layers behind it.
template <class... Specs>
struct Behind {
  using Net = Network<float, InputSize<16>, Dense<neurons>, Specs..., Dense<neurons>, Specs..., Dense<4>>;
};
using Kinds = std::tuple<Behind<Gelu>, Behind<Elu>, Behind<LayerNorm<neurons>, Relu>, Behind<RmsNorm<neurons>, Relu>,
                         Behind<Glu<neurons / 2>>>;

const Quadrotor<double>& quadrotor() {
  static const Quadrotor<double> made(airframe_value<PaperQuadrotor, double>(), paper_site<double>());
  return made;
}
const Flight& flight() {
  static const Flight flown = [] {
    const RandomPilot<std::mt19937_64> pilot(std::mt19937_64(3), pilot_style(quadrotor(), FlightPlan{}.start_m, 8.0),
                                             0);
    FlightPlan plan;
    plan.samples = 4000;
    return fly(quadrotor(), pilot, plan).flight;
  }();
  return flown;
}

/// Any network as a policy: the loop is compiled once.
struct AnyNetwork {
  std::function<Status(const State<double>&, const Accelerations<double>&, std::uint64_t, Commands<double>&)> ask;
  Status operator()(const State<double>& state, const Accelerations<double>& wanted, std::uint64_t time_us,
                    Commands<double>& commands) const noexcept {
    return ask(state, wanted, time_us, commands);
  }
};

TrackingResult<double> flown(const AnyNetwork& network) {
  FigureEight<double> eight;
  eight.center_m = Vector3<double>(0, 0, -20);
  TrackingPlan<double> plan;
  plan.duration_s = 12;
  return track(quadrotor(), eight, FlightController<double>{}, network, plan);
}

}  // namespace

TEST_CASE_TEMPLATE_DEFINE("trained, written, read back to the bit, flown", Kind, trained_and_flown) {
  using Net = typename Kind::Net;
  using Model = TrainedModel<Net, Setting>;
  std::mt19937_64 engine(5);
  const auto context = make_context<Setting>({flight(), {0, flight().size()}});
  const auto data = standardised<float>(context, {flight(), {0, flight().size()}});
  Adam adam;
  adam.learning_rate = 3e-3;
  const auto trainer =
      std::make_unique<Trainer<Net, Mse, Adam, Setting>>(initialised<Net>(engine), Mse{}, adam, context);
  const double before = trainer->validate(data).mean_squared;
  for (int epoch = 0; epoch < epochs; ++epoch) trainer->epoch(data, {epoch, epochs}, engine);
  const double after = trainer->validate(data).mean_squared;
  CHECK(after < 0.15 * before);

  const Model model = make_trained_model(trainer->network(), context, {flight(), {0, flight().size()}});
  typename Model::FeatureVector golden{};
  for (std::size_t i = 0; i < golden.size(); ++i) golden[i] = model.input.mean[i];
  const test::BlockBytes block(
      model_block(model, {golden}, {"a simulated flight", 1, 100, 5, epochs, "mse"}, "Layers"));
  ModelView<Model> view;
  REQUIRE(ModelView<Model>::open(block.data(), block.size(), view) == Status::ok);
  auto run_time = std::make_unique<RunTimeModel<float>>();
  REQUIRE(RunTimeModel<float>::open(block.data(), block.size(), *run_time) == Status::ok);
  CHECK(std::memcmp(run_time->parameters(), model.network.parameters.data(), sizeof model.network.parameters) == 0);

  NetworkInverse<InverseDynamics<ModelView<Model>>> inverse{InverseDynamics<ModelView<Model>>(view)};
  const auto result =
      flown(AnyNetwork{[&](const State<double>& state, const Accelerations<double>& wanted, std::uint64_t time_us,
                           Commands<double>& commands) { return inverse(state, wanted, time_us, commands); }});
  MESSAGE("standardised error ", after, ", off its path by ", 100 * result.rmse_m, " cm");
  CHECK(result.status == Status::ok);
  CHECK(result.rmse_m < 0.5);
  CHECK(inverse.count().fallbacks() * 10 < inverse.count().asked);
}
TEST_CASE_TEMPLATE_APPLY(trained_and_flown, Kinds);
