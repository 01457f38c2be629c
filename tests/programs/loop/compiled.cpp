// SPDX-License-Identifier: MIT
// Flies a model of a user's own, with a window and a column, as flight code would: from its header, compiled. Prints
// RMSE and largest error in m, ticks that the model answered, all ticks.
#include <cstdio>

#include <model.hpp>  // struct Own, by the include path

#include "pinnquad/simulation/tracking.hpp"

namespace {

using namespace pinnquad;

struct HeldVoltage {
  template <class Inputs>
  void operator()(const State<double>&, std::uint64_t, Inputs& present) const noexcept {
    present.template column<BatteryVoltage>() = Own::Scalar(15.2);
  }
};

}  // namespace

int main() {
  using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;
  using Inverse = InverseDynamics<Own, Extend<TrainingGuard, Fallback<AnalyticInverse<Vehicle>>>>;
  const Vehicle vehicle(airframe_value<Own::Vehicle, double>(), paper_site<double>());
  const FlightController<double> controller(
      {}, flight_limits(vehicle.airframe(), vehicle.rotor_scale(vehicle.surroundings({}, 0))));
  FigureEight<double> eight;  // as it is, the paper's quadrotor can fly it
  eight.center_m = {0, 0, -20};
  const NetworkInverse<Inverse, HeldVoltage> policy(Inverse(AnalyticInverse<Vehicle>(vehicle)), HeldVoltage{});
  const auto flown = track(vehicle, eight, controller, policy);
  std::printf("%.9f %.9f %u %u\n", flown.rmse_m, flown.max_error_m, flown.fallback.asked - flown.fallback.fallbacks(),
              flown.fallback.asked);
}
