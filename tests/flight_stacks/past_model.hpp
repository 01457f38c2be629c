// SPDX-License-Identifier: MIT
// A model with a window and the battery voltage, as a header exports one: the linear inverse of the paper's quadrotor
// about its hover, of the weighted motions of the window's instants, more thrust the emptier the battery is.
#pragma once

#include <array>
#include <cstddef>

#include "../support/as_header.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/exported/model.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/features/windowed.hpp"

namespace pinnquad::autopilot::test {

template <std::size_t Size>
constexpr std::array<float, Size> of_all(float value) noexcept {
  std::array<float, Size> x{};
  for (float& number : x) number = value;
  return x;
}

template <int Taps>
struct PastNumbersOf {
  using Scalar = float;
  using Features = PartlyWindowed<WithColumns<AccelerationFeatures, BatteryVoltage>, AccelerationFeatures, Taps,
                                  PeriodMicroseconds<20000>>;
  using Network = pinnquad::Network<float, InputSize<Features::size>, Dense<4>>;
  using Outputs = CommandOutputs;
  using Vehicle = PaperQuadrotor;

  static constexpr const char* name = "past_model";
  static constexpr const char* provenance = "tests/flight_stacks/past_model.hpp";

  /// Of an instant, the present one first: they add up to 1, and the further back, the less it counts.
  static constexpr double tap_weight(int tap) noexcept { return 2.0 * (Taps - tap) / (Taps * (Taps + 1)); }
  static constexpr float per_volt = -0.01f, rated_V = 15;  ///< of every command

  using FeatureVector = std::array<float, Features::size>;
  static constexpr std::size_t inputs = Features::size;
  static constexpr std::size_t voltage = 6;  ///< in X

  /// Weights, output by output, then biases.
  static constexpr std::array<float, 4 * inputs + 4> parameters = [] {
    std::array<float, 4 * inputs + 4> all{};
    constexpr Airframe<double> a = airframe_value<Vehicle, double>();
    const double thrust_N = a.max_rotor_thrust_N(), torque_N_m = a.max_rotor_torque_N_m();
    for (std::size_t rotor = 0; rotor < 4; ++rotor) {
      const auto& mount = a.rotors[rotor];
      const double yaw_N_m = mount.spin == Spin::counter_clockwise ? torque_N_m : -torque_N_m;
      const std::array<double, 6> motion = {0,
                                            0,
                                            -a.mass_kg / (4 * thrust_N),
                                            -a.inertia_kg_m2[0] / (4 * mount.y_m * thrust_N),
                                            a.inertia_kg_m2[1] / (4 * mount.x_m * thrust_N),
                                            a.inertia_kg_m2[2] / (4 * yaw_N_m)};
      for (int tap = 0; tap < Taps; ++tap) {
        const std::size_t first = tap == 0 ? 0 : voltage + 1 + 6 * static_cast<std::size_t>(tap - 1);
        for (std::size_t i = 0; i < 6; ++i) {
          all[inputs * rotor + first + i] = static_cast<float>(tap_weight(tap) * motion[i]);
        }
      }
      all[inputs * rotor + voltage] = per_volt;
      all[4 * inputs + rotor] = -per_volt * rated_V;
    }
    return all;
  }();

  static constexpr Scaler<float, Features::size> input{};
  static constexpr Scaler<float, 4> output{};

  static constexpr double most_V = 16;
  static constexpr FeatureVector envelope_lower = of_all<inputs>(-200), envelope_upper = [] {
    FeatureVector upper = of_all<inputs>(200);
    upper[voltage] = static_cast<float>(most_V);
    return upper;
  }();

  static constexpr std::array<FeatureVector, 2> golden_features = {of_all<inputs>(0.5f), of_all<inputs>(-2.0f)};
  static constexpr std::array<std::array<float, 4>, 2> golden_commands = [] {
    std::array<std::array<float, 4>, 2> all{};
    for (std::size_t vector = 0; vector < all.size(); ++vector) {
      for (std::size_t rotor = 0; rotor < 4; ++rotor) {
        float sum = parameters[4 * inputs + rotor];
        for (std::size_t i = 0; i < inputs; ++i) sum += parameters[inputs * rotor + i] * golden_features[vector][i];
        all[vector][rotor] = sum;
      }
    }
    return all;
  }();
};

template <int Taps>
using PastModelOf = pinnquad::test::AsHeader<PastNumbersOf<Taps>>;
using PastModel = PastModelOf<3>;

}  // namespace pinnquad::autopilot::test
