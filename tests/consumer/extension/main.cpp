// SPDX-License-Identifier: MIT
//
// Records the user's vehicle, checks the gradient of the user's network and loss against central differences, trains
// them and flies. Prints what went wrong and returns 1, or returns 0.
#include <cmath>
#include <cstdio>
#include <memory>
#include <pinnquad/pinnquad.hpp>
#include <random>
#include <vector>

#include "own_aero.hpp"
#include "own_layers.hpp"
#include "own_loss.hpp"

namespace {

using pinnquad::Status;

/// |gradient - central difference| / max |gradient|, in double.
constexpr double gradient_tolerance = 1e-6;

using Vehicle = pinnquad::Quadrotor<double, own::RotorDrag, pinnquad::QuadraticDrag>;
template <class Scalar>
using Network =
    pinnquad::Network<Scalar, pinnquad::InputSize<16>, own::ChannelScale, pinnquad::Dense<12>, own::LeakyRelu,
                      pinnquad::Dense<12>, pinnquad::Tanh, own::ChannelScale, pinnquad::Dense<4>>;
using Loss = pinnquad::PhysicsInformed<own::Huber,
                                       pinnquad::Weighted<pinnquad::LocalMonotonicity<pinnquad::Roll>, own::LinearRamp>,
                                       pinnquad::Weighted<pinnquad::LocalMonotonicity<pinnquad::Yaw>, own::LinearRamp>>;
using Knowledge = pinnquad::Context<pinnquad::PaperFeatures, own::Racer>;
template <class Scalar>
using Trainer = pinnquad::Trainer<Network<Scalar>, Loss, pinnquad::Adam, Knowledge>;

int faults = 0;
void expect(bool condition, const char* what) {
  if (condition) return;
  std::printf("FAILED: %s\n", what);
  ++faults;
}

Vehicle racer() { return Vehicle(pinnquad::airframe_value<own::Racer, double>()); }

/// Random motion, answered by the inverse of the user's vehicle: a recording without a pilot.
pinnquad::Flight recorded(std::size_t rows, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto draw = [&engine](double largest) { return pinnquad::uniform(engine, -largest, largest); };
  const Vehicle vehicle = racer();
  pinnquad::Flight flight;
  while (flight.size() < rows) {
    pinnquad::Sample sample;
    sample.time_s = 0.05 * static_cast<double>(flight.size());
    pinnquad::State<double> state;
    pinnquad::Accelerations<double> motion;
    for (int i = 0; i < 3; ++i) {
      state.velocity_m_s[i] = draw(6);
      state.body_rates_rad_s[i] = draw(2);
      motion.linear_m_s2[i] = draw(4);
      motion.angular_rad_s2[i] = draw(i < 2 ? 30 : 5);
    }
    const pinnquad::EulerAngles<double> angles{draw(0.4), draw(0.4), draw(3)};
    state.attitude = pinnquad::from_euler(angles);
    if (inverse_commands(vehicle, state, motion, 0.0, sample.commands) != Status::ok) continue;
    sample.linear_acceleration_m_s2 = motion.linear_m_s2;
    sample.angular_acceleration_rad_s2 = motion.angular_rad_s2;
    sample.velocity_m_s = pinnquad::body_velocity(state);
    sample.body_rates_rad_s = state.body_rates_rad_s;
    sample.roll_rad = angles.roll_rad;
    sample.pitch_rad = angles.pitch_rad;
    sample.yaw_rad = angles.yaw_rad;
    flight.push_back(sample);
  }
  return flight;
}

void check_contracts() {
  expect(pinnquad::is_effect<own::RotorDrag> && pinnquad::uses_rotor_wrench<own::RotorDrag>, "effect");
  expect(pinnquad::is_airframe<own::Racer>, "airframe");
  expect(pinnquad::is_layer<own::LeakyRelu> && pinnquad::is_layer<own::ChannelScale>, "layers");
  expect(pinnquad::is_loss<own::Huber>, "loss");
  expect(pinnquad::is_schedule<own::LinearRamp>, "schedule");
  expect(Network<float>::parameter_count == 16 + (16 * 12 + 12) + (12 * 12 + 12) + 12 + (12 * 4 + 4),
         "parameter count");
  const std::array<double, 4> roll = {-1, -1, 1, 1}, pitch = {-1, 1, -1, 1}, yaw = {-1, 1, 1, -1};
  expect(Knowledge::signs<pinnquad::Roll>() == roll && Knowledge::signs<pinnquad::Pitch>() == pitch &&
             Knowledge::signs<pinnquad::Yaw>() == yaw,
         "the losses know the airframe's own allocation");
}

void check_gradient(const pinnquad::Flight& flight) {
  const pinnquad::IndexRange all{0, flight.size()};
  auto context = pinnquad::make_context<Knowledge>({flight, all});
  context.progress = {3, 5};
  const auto data = pinnquad::standardised<double>(context, {flight, all});
  std::mt19937_64 engine(5);
  auto network = pinnquad::initialised<Network<double>>(engine);
  std::vector<int> rows;
  for (int i = 0; i < 13; ++i) rows.push_back(i);
  const auto value = [&](const Network<double>& net) {
    auto trainer = std::make_unique<Trainer<double>>(net, Loss{}, pinnquad::Adam{}, context);
    return trainer->differentiate(data, rows.data(), 13);
  };
  auto trainer = std::make_unique<Trainer<double>>(network, Loss{}, pinnquad::Adam{}, context);
  trainer->differentiate(data, rows.data(), 13);
  const auto gradient = trainer->parameter_gradient();
  double worst = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < gradient.size(); i += 3) {
    constexpr double step = 1e-6;  // small beside the distance of this batch from the kinks of LeakyRelu and Huber
    const double original = network.parameters[i];
    network.parameters[i] = original + step;
    const double above = value(network);
    network.parameters[i] = original - step;
    const double difference = (above - value(network)) / (2 * step);
    network.parameters[i] = original;
    worst = std::fmax(worst, std::fabs(gradient[i] - difference));
    largest = std::fmax(largest, std::fabs(difference));
  }
  std::printf("gradient: relative difference %.1e\n", worst / largest);
  expect(worst <= gradient_tolerance * largest, "gradient against central differences");
}

Network<float> train(const pinnquad::Flight& flight, const Knowledge& context) {
  const auto data = pinnquad::standardised<float>(context, {flight, {0, flight.size()}});
  std::mt19937_64 engine(7);
  pinnquad::Adam adam;
  adam.learning_rate = 5e-3;
  auto trainer = std::make_unique<Trainer<float>>(pinnquad::initialised<Network<float>>(engine), Loss{}, adam, context);
  constexpr int epochs = 20;
  double first = 0.0, last = 0.0;
  for (int epoch = 0; epoch < epochs; ++epoch) {
    last = trainer->epoch(data, {epoch, epochs}, engine);
    if (epoch == 0) first = last;
  }
  std::printf("loss: %.4f -> %.4f\n", first, last);
  expect(last < 0.5 * first, "the loss falls, though the ramp adds to it");
  const auto trained = trainer->network();
  expect(trained.parameters[0] != 1.0F, "the user's parameters are trained too");
  return trained;
}

/// Portable and vector kernel carry the user's layers.
void check_kernels(const Network<float>& network) {
  const pinnquad::PackedNetwork<Network<float>> packed(network.parameters);
  std::mt19937_64 engine(9);
  for (int round = 0; round < 50; ++round) {
    float x[16], y[4] = {}, z[4] = {};
    for (float& v : x) v = static_cast<float>(pinnquad::standard_normal(engine));
    network.forward(x, y);
    packed.forward(x, z);
    for (int i = 0; i < 4; ++i)
      expect(std::fabs(y[i] - z[i]) <= 1e-5F, "kernels agree");  // some hundred float roundings
  }
}

void fly(const pinnquad::TrainedModel<Network<float>, Knowledge>& model) {
  const Vehicle vehicle = racer();
  expect(vehicle.status() == Status::ok, "the airframe can fly");
  pinnquad::VehicleState<double> state;
  state.body.velocity_m_s[0] = 3.0;
  pinnquad::Commands<double> hover{};
  expect(inverse_commands(vehicle, state.body, {}, 0.0, hover) == Status::ok, "an inverse through the user's effect");
  state.rotors = hover;
  for (int step = 0; step < 200; ++step) {
    expect(vehicle.step(state, hover, 0.001) == Status::ok, "a step with the user's effect");
  }
  // 0.2 s of rotor drag k T v / m = 0.02 g v and some quadratic drag
  expect(state.body.velocity_m_s[0] < 3.0 * std::exp(-0.02 * 9.8 * 0.2) && state.body.velocity_m_s[0] > 2.7,
         "drag slows it");
  expect(std::fabs(state.body.velocity_m_s[2]) < 0.01, "hover thrust holds it");

  // the trained network asks about what it can: is it nearer to the truth than the mean command?
  double error = 0.0, spread = 0.0;
  const auto unseen = recorded(200, 99);
  for (const auto& sample : unseen) {
    const auto commands = model.predict(sample);
    for (std::size_t i = 0; i < 4; ++i) {
      error += std::fabs(static_cast<double>(commands[i]) - sample.commands[i]);
      spread += std::fabs(static_cast<double>(model.output.mean[i]) - sample.commands[i]);
    }
  }
  std::printf("unseen rows: error %.3f of the spread\n", error / spread);
  expect(error < 0.5 * spread, "the network has learned the user's vehicle");
}

}  // namespace

int main() {
  check_contracts();
  const auto flight = recorded(1000, 1);
  check_gradient(flight);
  const pinnquad::IndexRange all{0, flight.size()};
  const auto context = pinnquad::make_context<Knowledge>({flight, all});
  const auto network = train(flight, context);
  check_kernels(network);
  fly(pinnquad::make_trained_model(network, context, {flight, all}));
  return faults == 0 ? 0 : 1;
}
