// SPDX-License-Identifier: MIT
// Flies what train.cpp has exported, with nothing of the trainer: self test, closed loop on a sagging battery; with the
// voltage measured, and told that the pack is full.
#include <doctest/doctest.h>

#include "battery.hpp"
#include "pinnquad/flight.hpp"
#include "pinnquad/simulation/tracking.hpp"
#include "voltage_model.hpp"
#include "window_model.hpp"

namespace {

using namespace battery;

/// The voltage as a loop has it from its sensor; `offset_V` is what a wrong one adds.
struct Voltmeter {
  Pack pack;
  double offset_V = 0;

  template <class Inputs>
  void operator()(const State<double>& /*state*/, std::uint64_t time_us, Inputs& inputs) const noexcept {
    inputs.template column<BatteryVoltage>() = float(pack.voltage_V(seconds_of(time_us)) + offset_V);
  }
};

constexpr double start_V = 15.6;

template <class FeedForward>
TrackingResult<double> flown(const FeedForward& feed_forward) {
  const Vehicle quadrotor = vehicle(start_V);
  FigureEight<double> eight;
  eight.center_m = Vector3<double>(0, 0, -30);
  const double scale = quadrotor.rotor_scale(quadrotor.surroundings({}, 0));
  return track(quadrotor, eight, FlightController<double>({}, flight_limits(quadrotor.airframe(), scale)),
               feed_forward);
}

template <class Inverse>
TrackingResult<double> flown_by(const Inverse& inverse, double offset_V) {
  return flown(NetworkInverse<Inverse, Voltmeter>(inverse, Voltmeter{Pack{start_V}, offset_V}));
}

using Formula = AnalyticInverse<Vehicle>;
using Falling = Extend<TrainingGuard, Fallback<Formula>>;

}  // namespace

TEST_CASE_TEMPLATE("an exported model with a measured input tests itself and flies by it", Model, VoltageModel,
                   WindowModel) {
  CHECK(self_test(InverseDynamics<Model>()) == Status::ok);
  using Guarded = InverseDynamics<Model, Falling>;
  const Guarded inverse{Falling(Formula(vehicle(start_V)))};
  const TrackingResult<double> told = flown_by(inverse, 0);
  const TrackingResult<double> wrong = flown_by(inverse, 1.0);
  MESSAGE("rmse ", told.rmse_m, " m; told 1 V too much ", wrong.rmse_m, " m; fell back ", told.fallback.fallbacks(),
          " of ", told.fallback.asked);
  CHECK(told.status == Status::ok);
  CHECK(told.rmse_m < 0.7 * wrong.rmse_m);
  CHECK(told.fallback.fallbacks() < told.fallback.asked / 20);
  // a pack such as it never saw: flown as at the edge of the voltages that it knows
  const TrackingResult<double> beyond = flown_by(inverse, 4.0);
  CHECK(beyond.fallback.of(Status::outside_envelope) == 0);
  CHECK(beyond.rmse_m == flown_by(inverse, 40.0).rmse_m);
  CHECK(beyond.rmse_m > wrong.rmse_m);
}

TEST_CASE("a model with a past warms up: the fallback flies until the window is full, without one the rigid body") {
  using Guarded = InverseDynamics<WindowModel, Falling>;
  const Guarded inverse{Falling(Formula(vehicle(start_V)))};
  const TrackingResult<double> result = flown_by(inverse, 0);
  CHECK(result.status == Status::ok);
  CHECK(result.fallback.of(Status::warming_up) == 25);  // 50 ms at 500 Hz
  const TrackingResult<double> alone = flown_by(InverseDynamics<WindowModel>(), 0);
  CHECK(alone.status == Status::ok);
  CHECK(alone.declined == Status::warming_up);
  CHECK(alone.flown_s == result.flown_s);
}
