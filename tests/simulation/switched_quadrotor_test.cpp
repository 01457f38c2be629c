// SPDX-License-Identifier: MIT
// Effects switched at run time: to the bit the vehicle that names those that are on, also where they change in flight.
#include "pinnquad/simulation/switched_quadrotor.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <random>

#include "pinnquad/dynamics/airframes/light_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/simulation/simulator.hpp"

namespace {

using namespace pinnquad;

const Airframe<double> airframe = airframe_value<PaperQuadrotor, double>();
const Site<double> site = paper_site<double>();
constexpr PeriodicWind breeze{{0.0, 1.0, 0.0}, 1.0, 0.5, 7.0};
constexpr double start_height_m = 0.6;  // Z/R = 5.2: within both formulas' reach

SwitchedQuadrotor switched(GroundEffectModel model = GroundEffectModel::none) {
  SwitchedEffects effects = switched_effects<Quadrotor<double, StandardAtmosphere, QuadraticDrag>>();
  switch_effect(effects, breeze);
  set_ground_effect(effects, model);
  return quadrotor_with(effects, airframe, site);
}
template <class Value>
bool same_bits(const Value& a, const Value& b) {
  return std::memcmp(&a, &b, sizeof(Value)) == 0;
}

/// A vehicle in a turn, low and in wind, whose rotors all do something else.
VehicleState<double> turning() {
  VehicleState<double> state;
  state.body.position_m = Vector3<double>(0.3, -0.4, site.ground_z_m - 0.17);
  state.body.velocity_m_s = Vector3<double>(2.5, -1.2, -0.7);
  state.body.attitude = normalized(Quaternion<double>{0.95, 0.15, -0.2, 0.1});
  state.body.body_rates_rad_s = Vector3<double>(0.7, -0.4, 0.9);
  state.rotors = {0.52, 0.61, 0.48, 0.57};
  state.time_s = 1.75;
  return state;
}

/// The same loads and the same inverse; the same flight where `steps` says so.
template <class Vehicle>
void check_same(const SwitchedEffects& effects, const Vehicle& named, const Airframe<double>& flown, int steps) {
  const SwitchedQuadrotor quadrotor = quadrotor_with(effects, flown, site);
  REQUIRE(quadrotor.status() == named.status());
  VehicleState<double> a = turning(), b = turning();
  CHECK(same_bits(quadrotor.evaluate(a.body, a.rotors, a.time_s).motion,
                  named.evaluate(b.body, b.rotors, b.time_s).motion));
  Commands<double> of_a{}, of_b{};
  const Accelerations<double> motion{Vector3<double>(0.5, -0.3, 1.0), Vector3<double>(3, -2, 0.5)};
  REQUIRE(inverse_commands(quadrotor, a.body, motion, a.time_s, of_a) ==
          inverse_commands(named, b.body, motion, b.time_s, of_b));
  CHECK(same_bits(of_a, of_b));
  if (steps == 0) return;
  const Commands<double> held = {0.55, 0.5, 0.56, 0.51};
  for (int i = 0; i < steps; ++i) {
    REQUIRE(quadrotor.step(a, held, 0.001) == Status::ok);
    REQUIRE(named.step(b, held, 0.001) == Status::ok);
    REQUIRE(same_bits(a, b));
  }
}

/// Effects whose values by default do nothing are given some.
DrydenTurbulence<> some(const DrydenTurbulence<>& /*calm*/) {
  std::mt19937_64 engine(3);
  return DrydenTurbulence<>(engine, DrydenParameters::low_altitude(6, 20), 6);
}
ConstantWind some(const ConstantWind& /*calm*/) { return {{3, -2, 0.5}}; }
RotorFault some(const RotorFault& /*sound*/) { return {2, 0.8, 1}; }
Payload some(const Payload& /*none*/) { return {0.2, 1}; }
template <class Effect>
Effect some(const Effect& effect) {
  return effect;
}

template <class Effect, Usually usually>
void check_alone(const Switched<Effect, usually>& /*effect*/, const Airframe<double>& flown) {
  SwitchedEffects effects;
  switch_effect(effects, some(Effect{}));
  check_same(effects, Quadrotor<double, Effect>(flown, site, some(Effect{})), flown, 0);
}

template <class... Effects>
void check_all(const Quadrotor<double, Effects...>* /*type*/, const Airframe<double>& flown, int steps) {
  SwitchedEffects effects;
  (switch_effect(effects, some(Effects{})), ...);
  check_same(effects, Quadrotor<double, Effects...>(flown, site, some(Effects{})...), flown, steps);
}

}  // namespace

TEST_CASE("each effect alone has the bits of the vehicle that names it") {
  Airframe<double> tilted = airframe;
  tilted.rotors[1].axis = {0.05, 0.0, -0.99874921777};
  for (const Airframe<double>& flown : {airframe, tilted}) {
    std::apply([&flown](const auto&... effect) { (check_alone(effect, flown), ...); }, SwitchedEffects{});
  }
}

TEST_CASE("without effects, and under those of each flight, a flight has the same bits") {
  const auto check = [](auto* type) {
    check_all(type, airframe, 200);
    check_all(type, airframe_value<LightQuadrotor, double>(), 200);
  };
  check(static_cast<Quadrotor<double>*>(nullptr));
  check(static_cast<AgileFlight::Vehicle*>(nullptr));
  check(static_cast<NearGroundFlight::Vehicle*>(nullptr));
  check(static_cast<WindyFlight::Vehicle*>(nullptr));
  check(static_cast<HarderFlight::Vehicle*>(nullptr));
}

TEST_CASE("one effect beside the usual ones is not passed over") {
  using Loaded = Quadrotor<double, StandardAtmosphere, QuadraticDrag, Payload>;
  using Dragless = Quadrotor<double, StandardAtmosphere, PeriodicWind>;
  check_all(static_cast<Loaded*>(nullptr), airframe, 200);
  check_all(static_cast<Dragless*>(nullptr), airframe, 200);
}

TEST_CASE("switched in flight, it flies on from where it is, and another flight") {
  FlightPlan settings;
  settings.start_m = Vector3<double>(0, 0, site.ground_z_m - start_height_m);
  Simulator<SwitchedQuadrotor, SteadyPilot> simulator(switched(), SteadyPilot{}, settings);
  REQUIRE(simulator.advance(0.5));
  Simulator<SwitchedQuadrotor, SteadyPilot> as_it_was = simulator;
  const VehicleState<double> at_switch = simulator.vehicle();
  simulator.set_quadrotor(switched(GroundEffectModel::conyers));
  CHECK(same_bits(simulator.vehicle(), at_switch));
  REQUIRE(simulator.advance(0.002));
  REQUIRE(as_it_was.advance(0.002));
  CHECK(simulator.vehicle().body.velocity_m_s[2] < as_it_was.vehicle().body.velocity_m_s[2]);  // the ground lifts
}

TEST_CASE("hover near the ground needs 1 / r of the command") {
  const auto calm = [](GroundEffectModel model) { return flight_vehicle<AgileFlight>(airframe, model); };
  constexpr double agreement = 2e-6;  // of the inverse's rounds
  for (const double height_m : {0.2, 0.4, 0.9}) {
    CAPTURE(height_m);
    FlightPlan settings;
    settings.start_m = Vector3<double>(0, 0, site.ground_z_m - height_m);
    Simulator<SwitchedQuadrotor, SteadyPilot> simulator(calm(GroundEffectModel::none), SteadyPilot{}, settings);
    const double x = height_m / (airframe.propeller_diameter_m / 2);
    Commands<double> none{}, cheeseman_bennett{}, conyers{};
    REQUIRE(simulator.hover_commands(none) == Status::ok);
    simulator.set_quadrotor(calm(GroundEffectModel::cheeseman_bennett));
    REQUIRE(simulator.hover_commands(cheeseman_bennett) == Status::ok);
    simulator.set_quadrotor(calm(GroundEffectModel::conyers));
    REQUIRE(simulator.hover_commands(conyers) == Status::ok);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(none[i] / cheeseman_bennett[i] ==
            doctest::Approx(CheesemanBennett{}.thrust_ratio(x, airframe)).epsilon(agreement));
      CHECK(none[i] / conyers[i] == doctest::Approx(Conyers{}.thrust_ratio(x, airframe)).epsilon(agreement));
    }
  }
}
