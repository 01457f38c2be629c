// SPDX-License-Identifier: MIT
// A residual wrench that is learnt: the rotors' state of rows, what a row has beyond the rigid body, and how much of
// the simulator's own truth the network explains on a flight that it has not seen.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "pinnquad/dynamics/airframes/light_quadrotor.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "study/wrench_fit.hpp"

using namespace pinnquad;
using namespace study;

namespace {

Airframe<double> airframe() { return airframe_value<LightQuadrotor, double>(); }

/// `harder`, a row every 10 ms.
Flight flown(std::uint64_t seed, std::size_t rows) {
  FlightPlan plan = HarderFlight::plan();
  plan.controls_per_sample = 5;
  plan.samples = rows;
  const auto vehicle = flight_vehicle<HarderFlight>(airframe());
  RecordedFlight recorded = fly(vehicle, HarderFlight::pilot(vehicle, std::mt19937_64(seed)), plan);
  REQUIRE(recorded.flight.size() == rows);
  return recorded.flight;
}

}  // namespace

TEST_CASE("the rotors of a row are its commands behind the lag") {
  Flight flight;
  for (int row = 0; row < 100; ++row) {
    Sample sample;
    sample.time_s = 0.002 * row;
    const double u = row < 10 ? 0.3 : 0.7;
    sample.commands = {u, u, 1 - u, 0.5};
    flight.push_back(sample);
  }
  const Flight with = with_rotor_states(flight, airframe());
  const double kept = 0.020 / 0.022;  // of a step of 2 ms, by backward differences
  for (std::size_t row : {9u, 10u, 11u, 50u, 99u}) {
    const double left = row < 10 ? 1.0 : std::pow(kept, static_cast<double>(row) - 9);
    CHECK(with.column("rotor_1")->values[row] == doctest::Approx(0.7 - 0.4 * left));
    CHECK(with.column("rotor_3")->values[row] == doctest::Approx(0.3 + 0.4 * left));
    CHECK(with.column("rotor_4")->values[row] == doctest::Approx(0.5));
  }
  // a lag that was taken out of the commands is none
  CHECK(with_rotor_states(flight, airframe(), 0.020).column("rotor_1")->values[10] == doctest::Approx(0.7));
}

TEST_CASE("the residual wrench of a row is that of the simulator's effects") {
  const auto vehicle = flight_vehicle<HarderFlight>(airframe());
  const Quadrotor<double, StandardAtmosphere> rigid(airframe(), paper_site<double>());
  VehicleState<double> state;
  state.body.position_m = {0, 0, -30};
  state.body.velocity_m_s = {4, 2, -1};
  state.body.attitude = from_euler<double>({0.2, -0.3, 1});
  state.body.body_rates_rad_s = {1, -0.5, 0.2};
  state.rotors = {0.4, 0.5, 0.6, 0.45};
  const Sample sample = ExactRecorder{}(vehicle, state, state.rotors);
  const auto truth = vehicle.evaluate(state.body, state.rotors, 0.0).aerodynamic;
  const Accelerations<double> found = residual_wrench_of(sample, state.rotors, rigid);
  CHECK((found.linear_m_s2 - truth.force_N / airframe().mass_kg).norm() <= 1e-9);
  CHECK((found.angular_rad_s2 - inertia_solved(airframe(), truth.torque_N_m)).norm() <= 1e-9);
}

TEST_CASE("a network explains the residual wrench of a flight that it has not seen") {
  const Flight flight = with_rotor_states(flown(1, 6000), airframe());
  const Flight unseen = with_rotor_states(flown(2, 2000), airframe());
  WrenchTraining how;
  how.epochs = 30;
  int asked = 0;
  const WrenchModel model = fit_wrench(RowSet(flight, {0, 4800}), RowSet(flight, {4800, 6000}),
                                       GivenAirframe("light_quadrotor", airframe()), how, [&](int) {
                                         ++asked;
                                         return true;
                                       });
  CHECK(asked == 30);
  const WrenchJudgement judged = judge_wrench(model, RowSet(unseen, {0, unseen.size()}));
  const std::array<double, 6> least = {0.9, 0.9, 0.95, 0.6, 0.6, 0.8};
  for (std::size_t k = 0; k < least.size(); ++k) {
    CAPTURE(k);
    CHECK(judged.r_squared[k] >= least[k]);
  }
}
