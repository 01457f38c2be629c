// SPDX-License-Identifier: MIT
// Both cores with a learner of the vehicle (docs/onboard.md), and a vehicle that is not the one they guess.
#pragma once

#include <random>

#include "model_blocks.hpp"
#include "pinnquad/control/onboard/onboard_inverse.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "stacks.hpp"

namespace pinnquad::autopilot::test {

template <class Model>
using OnboardController =
    NeuralController<Model, pinnquad::ModelView<Model>, pinnquad::Quadrotor<float, pinnquad::QuadraticDrag>, void,
                     pinnquad::OnboardInverse<float>>;
using OnboardPx4Stack = Px4StackOf<DemoQuadModel, OnboardController<DemoQuadModel>>;
using OnboardCrazyflieStack = CrazyflieStackOf<CrazyflieModel, OnboardController<CrazyflieModel>>;

/// A vehicle of other slopes than a core's airframe says, its sensors and its rotors. `held`: in the hand.
template <class Stack>
class StrangeVehicle {
 public:
  using Vehicle = pinnquad::Quadrotor<double, pinnquad::StandardAtmosphere, pinnquad::QuadraticDrag>;
  static constexpr double tick_s = 1e-3 * Stack::period_ms;

  bool held = false;
  double rotor_0 = 1;      ///< share of its thrust that rotor 0 makes
  bool no_motion = false;  ///< the estimator says NaN

  StrangeVehicle() : vehicle_(airframe(), pinnquad::paper_site<double>()) {
    body_.body.position_m = {0, 0, -20};
    pinnquad::Commands<double> trim{};
    static_cast<void>(pinnquad::hover_trim(vehicle_, body_.body.position_m, trim));
    body_.rotors = trim;
  }

  /// Slopes over those of the core's airframe: thrust 1 / 0.8, roll and pitch 1 / 1.3, yaw 1 / 0.75.
  static pinnquad::Airframe<double> airframe() {
    auto airframe = pinnquad::airframe_value<typename Stack::Model::Vehicle, double>();
    airframe.mass_kg *= 0.8;
    airframe.inertia_kg_m2[0] *= 1.3;
    airframe.inertia_kg_m2[1] *= 1.3;
    airframe.inertia_kg_m2[2] *= 0.75;
    airframe.rotor_time_constant_s *= 1.3;
    return airframe;
  }
  void weigh(double share) {
    auto heavier = airframe();
    heavier.mass_kg *= share;
    vehicle_ = Vehicle(heavier, pinnquad::paper_site<double>());
  }
  /// Time of a tick: PX4's follow the gyro, and a step is late by up to 0.4 ms.
  static std::uint64_t time_us(long tick) {
    const std::uint32_t late_us = Stack::period_ms == 1 ? (static_cast<std::uint32_t>(tick) * 2654435761u) % 401u : 0;
    return static_cast<std::uint64_t>(5'000'000 + tick * 1000 * Stack::period_ms) + late_us;
  }
  const pinnquad::State<double>& body() const { return body_.body; }

  /// The samples of a tick, some of them with each.
  void feed(Stack& stack, long tick, std::uint64_t now_us, const pinnquad::TrajectoryPoint<double>& point) {
    const long ms = tick * Stack::period_ms;
    const double nan = no_motion ? std::numeric_limits<double>::quiet_NaN() : 0;
    stack.rates(now_us, body_.body.body_rates_rad_s + noise(0.02) + pinnquad::Vector3<double>(0, nan, 0));
    if (ms % 4 == 0) stack.attitude(now_us, body_.body.attitude);
    if (ms % 10 == 0) {
      stack.local(now_us, body_.body.position_m,
                  body_.body.velocity_m_s + noise(0.01) + pinnquad::Vector3<double>(nan, 0, 0));
    }
    if (ms % 20 == 0) stack.set_point(now_us, point);
    if (ms % 200 == 0) stack.battery(now_us, 15);
  }
  /// Commands until the next tick. False: it can fly no further.
  bool fly(pinnquad::Commands<double> commands) {
    if (held) return true;
    commands[0] *= rotor_0;
    for (int i = 0; i < Stack::period_ms; ++i) {
      if (vehicle_.step(body_, commands, 1e-3) != pinnquad::Status::ok) return false;
    }
    return true;
  }

 private:
  pinnquad::Vector3<double> noise(double deviation) {
    pinnquad::Vector3<double> result;
    for (int i = 0; i < 3; ++i) result[i] = deviation * pinnquad::standard_normal(engine_);
    return result;
  }

  Vehicle vehicle_;
  pinnquad::VehicleState<double> body_{};
  std::mt19937_64 engine_{11};
};

/// Hover for twelve seconds, then a gentle eight.
inline pinnquad::TrajectoryPoint<double> strange_course(double time_s) {
  pinnquad::FigureEight<double> eight;
  eight.center_m = {0, 0, -20};
  eight.half_length_m = 2;
  eight.half_width_m = 1;
  eight.period_s = 8;
  pinnquad::TrajectoryPoint<double> point = eight.sample(time_s < 12 ? 0 : time_s - 12);
  if (time_s < 12) {
    point = {};
    point.position_m = eight.center_m;
  }
  return point;
}

}  // namespace pinnquad::autopilot::test
