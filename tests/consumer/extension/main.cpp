// SPDX-License-Identifier: MIT
//
// Records the user's vehicle by its inverse through the user's effect, and checks the gradient of the user's network
// and loss against central differences. Prints what went wrong and returns 1, or returns 0.
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
using Network =
    pinnquad::Network<double, pinnquad::InputSize<16>, own::ChannelScale, pinnquad::Dense<12>, own::LeakyRelu,
                      pinnquad::Dense<12>, pinnquad::Tanh, own::ChannelScale, pinnquad::Dense<4>>;
using Loss = pinnquad::PhysicsInformed<own::Huber,
                                       pinnquad::Weighted<pinnquad::LocalMonotonicity<pinnquad::Roll>, own::LinearRamp>,
                                       pinnquad::Weighted<pinnquad::LocalMonotonicity<pinnquad::Yaw>, own::LinearRamp>>;
using Knowledge = pinnquad::Context<pinnquad::PaperFeatures, own::Racer>;
using Trainer = pinnquad::Trainer<Network, Loss, pinnquad::Adam, Knowledge>;

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
  expect(Network::parameter_count == 16 + (16 * 12 + 12) + (12 * 12 + 12) + 12 + (12 * 4 + 4), "parameter count");
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
  auto network = pinnquad::initialised<Network>(engine);
  std::vector<int> rows;
  for (int i = 0; i < 13; ++i) rows.push_back(i);
  const auto value = [&](const Network& net) {
    auto trainer = std::make_unique<Trainer>(net, Loss{}, pinnquad::Adam{}, context);
    return trainer->differentiate(data, rows.data(), 13);
  };
  auto trainer = std::make_unique<Trainer>(network, Loss{}, pinnquad::Adam{}, context);
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

}  // namespace

int main() {
  check_contracts();
  check_gradient(recorded(1000, 1));
  return faults == 0 ? 0 : 1;
}
