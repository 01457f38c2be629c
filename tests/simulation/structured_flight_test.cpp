// SPDX-License-Identifier: MIT
// The shipped structured model as feed-forward, in the demo's closed loop: as good as the formula, never asked outside
// its envelope, and better than the formula of a vehicle whose parameters are wrong. And one that knows the altitude,
// near the ground.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../examples/models/demo_quadrotor.hpp"
#include "../examples/models/structured_quadrotor.hpp"
#include "models/near_ground_quadrotor.hpp"
#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"
#include "pinnquad/simulation/tracking.hpp"

using namespace pinnquad;

namespace {

using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;

Vehicle vehicle_of(const Airframe<double>& airframe) { return Vehicle(airframe, paper_site<double>(), {}, {}); }

/// Flown on the vehicle as it is; the feedback is the same whatever is fed forward.
template <class FeedForward>
TrackingResult<double> flown(const FeedForward& feed_forward) {
  const Vehicle vehicle = vehicle_of(airframe_value<PaperQuadrotor, double>());
  FigureEight<double> eight;
  eight.center_m = {0, 0, -20};
  eight.period_s = 7.5;
  const FlightController<double> controller(
      {}, flight_limits(vehicle.airframe(), vehicle.rotor_scale(vehicle.surroundings({}, 0))));
  return track(vehicle, eight, controller, feed_forward);
}

template <class Model>
TrackingResult<double> flown_by() {
  using Guarded = InverseDynamics<Model, TrainingGuard>;  // no fallback: what it declines is lost
  return flown(NetworkInverse<Guarded>(Guarded()));
}

struct Wrong {
  const char* what;
  double mass, inertia, thrust;
};

Airframe<double> told(const Wrong& wrong) {
  Airframe<double> airframe = airframe_value<PaperQuadrotor, double>();
  airframe.mass_kg *= wrong.mass;
  for (double& moment : airframe.inertia_kg_m2) moment *= wrong.inertia;
  airframe.thrust_coefficient *= wrong.thrust;
  return airframe;
}

}  // namespace

TEST_CASE("a structured model flies the figure-eight as the formula does") {
  const auto structured = flown_by<StructuredQuadModel>(), paper = flown_by<DemoQuadModel>();
  const auto formula = flown(AnalyticInverse<Vehicle>(vehicle_of(airframe_value<PaperQuadrotor, double>())));
  REQUIRE(structured.status == Status::ok);
  CAPTURE(paper.rmse_m);
  CAPTURE(formula.rmse_m);
  CHECK(structured.fallback.fallbacks() == 0);
  CHECK(structured.rmse_m < 0.012);
  CHECK(structured.rmse_m < 1.1 * formula.rmse_m);
  CHECK(structured.rmse_m < 0.5 * paper.rmse_m);
}

TEST_CASE("better than the formula of a vehicle whose parameters are a tenth wrong") {
  const double structured = flown_by<StructuredQuadModel>().rmse_m;
  for (const Wrong& wrong : {Wrong{"heavier", 1.1, 1.1, 1}, Wrong{"lighter", 0.9, 0.9, 1},
                             Wrong{"weak rotors", 1, 1, 1.1}, Wrong{"strong rotors", 1, 1, 0.9}}) {
    const std::string what = wrong.what;
    CAPTURE(what);
    CHECK(structured < 0.5 * flown(AnalyticInverse<Vehicle>(vehicle_of(told(wrong)))).rmse_m);
  }
}

namespace {

using NearGround = Quadrotor<double, StandardAtmosphere, QuadraticDrag, GroundEffect<Conyers>>;

/// The altitude given to the model.
struct Altimeter {
  bool stuck;  ///< at a height where the ground is hardly felt

  void operator()(const State<double>& state, std::uint64_t, MotionInputsWithAltitude<float>& present) const noexcept {
    const double height_m = paper_site<double>().ground_z_m - state.position_m[2];
    present.altitude_m = stuck ? 1.2F : static_cast<float>(height_m);
  }
};

/// A lying eight that rises and sinks between 0.2 and 1.2 m above the ground, in ground effect.
template <class FeedForward>
TrackingResult<double> flown_low(const FeedForward& feed_forward) {
  const Airframe<double> airframe = airframe_value<PaperQuadrotor, double>();
  const NearGround vehicle(airframe, paper_site<double>());
  FigureEight<double> eight;
  eight.center_m = {0, 0, vehicle.site().ground_z_m - 0.7};
  eight.half_length_m = 1;
  eight.half_width_m = eight.half_height_m = 0.5;
  eight.period_s = 10.7;
  const FlightController<double> controller(
      {}, flight_limits(vehicle.airframe(), vehicle.rotor_scale(vehicle.surroundings({}, 0))));
  return track(vehicle, eight, controller, feed_forward);
}

}  // namespace

TEST_CASE("near the ground a structured model that knows the altitude flies, and one that is not told it does not") {
  using Guarded = InverseDynamics<NearGroundQuadModel, TrainingGuard>;
  using Inverse = NetworkInverse<Guarded, Altimeter>;
  const auto told = flown_low(Inverse(Guarded(), Altimeter{false})), stuck = flown_low(Inverse(Guarded(), {true}));
  const auto formula = flown_low(AnalyticInverse<Vehicle>(vehicle_of(airframe_value<PaperQuadrotor, double>())));
  REQUIRE(told.status == Status::ok);
  CAPTURE(told.rmse_m);
  CAPTURE(stuck.rmse_m);
  CAPTURE(formula.rmse_m);
  CHECK(told.fallback.fallbacks() == 0);
  CHECK(told.rmse_m < 0.01);
  CHECK(told.rmse_m < 0.2 * formula.rmse_m);  // which knows no ground effect
  CHECK(told.rmse_m < 0.2 * stuck.rmse_m);
}
