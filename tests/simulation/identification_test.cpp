// SPDX-License-Identifier: MIT
// Vehicles of all airframes, drawn anew for each flight, found again in noisy recordings: their intervals hold the
// truth as often as they say. PINNQUAD_IDENTIFIED_FLIGHTS=200 in the environment is the whole study (a minute).
#include "pinnquad/regression/identification.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <string>

#include "pinnquad/aero/drag.hpp"
#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/px4_sih.hpp"
#include "pinnquad/dynamics/airframes/racer_5_inch.hpp"
#include "pinnquad/regression/identified_airframe.hpp"
#include "pinnquad/simulation/flights.hpp"

using namespace pinnquad;

namespace {

struct DrawnVehicle {
  Airframe<double> airframe{};
  LinearDamping damping;
  double offset_x_arms = 0, offset_y_arms = 0;  ///< of the centre of gravity
};

using Vehicle = Quadrotor<double, QuadraticDrag, LinearDamping>;

/// One of the airframes, its numbers moved.
DrawnVehicle drawn_vehicle(std::size_t kind, std::mt19937_64& engine) {
  DrawnVehicle drawn;
  Airframe<double>& a = drawn.airframe;
  const std::array<Airframe<double>, 4> kinds = {
      airframe_value<PaperQuadrotor, double>(), airframe_value<Crazyflie, double>(),
      airframe_value<Racer5Inch, double>(), airframe_value<Px4Sih, double>()};
  a = kinds[kind % kinds.size()];
  for (double& moment : a.inertia_kg_m2) moment *= uniform(engine, 0.8, 1.25);
  a.inertia_kg_m2[2] = std::min(a.inertia_kg_m2[2], 0.98 * (a.inertia_kg_m2[0] + a.inertia_kg_m2[1]));
  a.mass_kg *= uniform(engine, 0.9, 1.15);
  a.rotor_time_constant_s = uniform(engine, 0.02, 0.06);
  a.drag_deadband_m_s = 0;
  drawn.offset_x_arms = uniform(engine, -0.03, 0.03);
  drawn.offset_y_arms = uniform(engine, -0.03, 0.03);
  const double offset_x_m = drawn.offset_x_arms * a.rotors[0].x_m, offset_y_m = drawn.offset_y_arms * a.rotors[0].y_m;
  for (RotorMount<double>& rotor : a.rotors) {
    rotor.x_m -= offset_x_m;
    rotor.y_m -= offset_y_m;
  }
  for (double& area : a.drag_area_m2) area *= uniform(engine, 0.5, 1.5);
  drawn.damping = {uniform(engine, 0.1, 0.5) * a.mass_kg, uniform(engine, 0.3, 1.5) * a.inertia_kg_m2[0]};
  return drawn;
}

std::array<std::array<double, rotor_count>, 3> signs_of(const Airframe<double>& airframe) {
  return {allocation_signs(airframe, 0), allocation_signs(airframe, 1), allocation_signs(airframe, 2)};
}

/// Rows of a log every so many ticks of 2 ms: 250, 100 and 20 Hz.
constexpr std::array<int, 3> ticks_a_row = {2, 5, 25};

/// An agile flight, a minute, of coarse rows four; its gyro, velocity and attitude noisy, its commands late.
Flight recorded(const DrawnVehicle& drawn, std::mt19937_64& engine, int ticks, double latency_s) {
  const Vehicle vehicle(drawn.airframe, paper_site<double>(), QuadraticDrag{}, drawn.damping);
  REQUIRE(vehicle.status() == Status::ok);
  FlightPlan plan;
  plan.controls_per_sample = ticks;
  plan.samples = static_cast<std::size_t>((ticks > 10 ? 240 : 60) / plan.sample_period_s());
  RecorderErrors errors;
  errors.gyro_noise_rad_s = 0.05;
  errors.velocity_noise_m_s = 0.05;
  errors.attitude_noise_rad = 0.01;
  errors.command_latency_s = latency_s;
  const auto pilot = AgileFlight::pilot(vehicle, std::mt19937_64(engine()));
  const RecordedFlight flown =
      fly(vehicle, pilot, plan, NoisyRecorder<std::mt19937_64>(std::mt19937_64(engine()), errors));
  REQUIRE(flown.report.end == FlightEnd::completed);
  return flown.flight;
}

std::size_t flights_asked_for() {
  constexpr std::size_t usual = 20;
  const char* text = std::getenv("PINNQUAD_IDENTIFIED_FLIGHTS");
  return text != nullptr ? std::size_t(std::strtoul(text, nullptr, 10)) : usual;
}

}  // namespace

TEST_CASE("intervals of simulated flights hold the vehicle's numbers in 90 or more of 100, and not in all") {
  const std::size_t flights = flights_asked_for();
  std::map<std::string, std::size_t> held;
  for (std::size_t flight = 0; flight < flights; ++flight) {
    std::mt19937_64 engine(1000 + flight);
    const DrawnVehicle drawn = drawn_vehicle(flight, engine);
    // ticks of 2 ms: rows have the command of the tick before, half a tick late, so that odd delays are exact
    const double latency_s = 0.001 * (1 + 2 * std::floor(uniform(engine, 0, 10)));
    const Flight rows = recorded(drawn, engine, ticks_a_row[flight / 4 % 3], latency_s);
    const Airframe<double>& a = drawn.airframe;
    const Identification found = identify({rows, {0, rows.size()}}, signs_of(a));
    const auto check = [&](const std::string& name, const Estimate& estimate, double truth) {
      held[name] += estimate.holds(truth) ? 1 : 0;
      CAPTURE(flight);
      CAPTURE(name);
      // three times as far: a wrong formula, not chance
      CHECK(std::abs(estimate.value - truth) <= 3 * estimate.half_width);
    };
    const double thrust_N = a.max_rotor_thrust_N();
    const std::array<double, 3>& j = a.inertia_kg_m2;
    const double arm_x_m = (a.rotors[0].x_m - a.rotors[1].x_m) / 2, arm_y_m = (a.rotors[0].y_m - a.rotors[1].y_m) / 2;
    check("thrust", found.thrust_m_s2, thrust_N / a.mass_kg);
    const std::array<double, 3> torque_N_m = {arm_y_m * thrust_N, arm_x_m * thrust_N, a.max_rotor_torque_N_m()};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string of = " " + std::to_string(axis);
      check("effectiveness" + of, found.effectiveness_rad_s2[axis], torque_N_m[axis] / j[axis]);
      check("damping" + of, found.damping_1_s[axis], drawn.damping.rate_damping_N_m_s / j[axis]);
      check("gyroscopic" + of, found.gyroscopic[axis], (j[(axis + 1) % 3] - j[(axis + 2) % 3]) / j[axis]);
      check("linear drag" + of, found.linear_drag_1_s[axis], drawn.damping.drag_N_s_m / a.mass_kg);
      check("quadratic drag" + of, found.quadratic_drag_1_m[axis],
            a.drag_area_m2[axis] * rated_air_density_kg_m3<double> / a.mass_kg);
    }
    check("offset y", found.imbalance[0], drawn.offset_y_arms);
    check("offset x", found.imbalance[1], -drawn.offset_x_arms);
    check("lag", found.lag_s, a.rotor_time_constant_s);
    check("delay", found.delay_s, -latency_s);
    check("response", found.response_s, a.rotor_time_constant_s - latency_s);
    check("fall after rise", found.fall_after_rise_s, 0);
  }
  // 90 to 99 % of many flights; of few, what chance leaves of them in a thousandth of the cases
  const double few = flights < 100 ? 0.8 : 0.9;
  for (const auto& one : held) {
    const std::string& name = one.first;
    const std::size_t count = one.second;
    CAPTURE(name);
    MESSAGE(name << ": " << count << " of " << flights);
    CHECK(double(count) >= few * double(flights));
    if (flights >= 100) CHECK(double(count) <= 0.99 * double(flights));
  }
}

TEST_CASE("an identified vehicle answers commands as the one that flew, of another mass and other arms") {
  std::mt19937_64 engine(7);
  const DrawnVehicle drawn = drawn_vehicle(0, engine);
  const Flight rows = recorded(drawn, engine, ticks_a_row[1], 0.001);
  const Airframe<double>& truth = drawn.airframe;
  const Identification found = identify({rows, {0, rows.size()}}, signs_of(truth));
  Airframe<double> like = airframe_value<Px4Sih, double>();
  like.mass_kg = 3;
  const auto made = identified_airframe(found, like);
  REQUIRE(made.has_value());
  CHECK(made->value.mass_kg == 3);
  CHECK(made->value.rotor_time_constant_s == doctest::Approx(truth.rotor_time_constant_s).epsilon(0.1));
  const AllocationMatrix<double> of_made = allocation(made->value), of_truth = allocation(truth);
  for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
    CAPTURE(rotor);
    CHECK(of_made[0][rotor] / 3 == doctest::Approx(of_truth[0][rotor] / truth.mass_kg).epsilon(0.01));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      CAPTURE(axis);
      CHECK(of_made[axis + 1][rotor] / made->value.inertia_kg_m2[axis] ==
            doctest::Approx(of_truth[axis + 1][rotor] / truth.inertia_kg_m2[axis]).epsilon(0.03));
    }
  }
  // the gyroscopic terms tell the third moment over the others; the arms of both are square
  CHECK(made->value.inertia_kg_m2[2] / made->value.inertia_kg_m2[0] ==
        doctest::Approx(truth.inertia_kg_m2[2] / truth.inertia_kg_m2[0]).epsilon(0.1));
}

TEST_CASE("rotors that rise faster than they fall, a thrust curve and a battery are found") {
  std::mt19937_64 engine(8);
  DrawnVehicle drawn = drawn_vehicle(3, engine);
  for (RotorMount<double>& rotor : drawn.airframe.rotors) {
    rotor.rise_time_constant_s = 0.03;
    rotor.fall_time_constant_s = 0.06;
    rotor.thrust_curve = 0.5;
  }
  Flight rows = recorded(drawn, engine, ticks_a_row[0], 0.001);
  ExtraColumn battery;
  battery.name = "battery_voltage";
  battery.unit = "V";
  for (std::size_t row = 0; row < rows.size(); ++row) {  // a voltage that wanders and does nothing
    battery.values.push_back(15 + 0.5 * std::sin(0.7 * rows[row].time_s));
  }
  rows.add_column(battery);
  IdentificationSettings settings;
  settings.fit_thrust_curve = true;
  const Identification found = identify({rows, {0, rows.size()}}, signs_of(drawn.airframe), settings);
  CHECK(found.thrust_curve.value == doctest::Approx(0.5).epsilon(0.1));
  CHECK(found.rise_s.value == doctest::Approx(0.03).epsilon(0.15));
  CHECK(found.fall_s.value == doctest::Approx(0.06).epsilon(0.15));
  CHECK(found.fall_after_rise_s.low() > 0);
  CHECK(found.mean_voltage_V == doctest::Approx(15).epsilon(0.02));
  CHECK(found.battery.holds(0));
  CHECK(found.battery.half_width < 0.2);
  const auto made = identified_airframe(found, airframe_value<Px4Sih, double>());
  REQUIRE(made.has_value());
  CHECK(made->value.rotors[0].thrust_curve == found.thrust_curve.value);
  CHECK(made->value.rotors[1].fall_time_constant_s == found.fall_s.value);
}

TEST_CASE("numbers that no quadrotor has make no airframe") {
  const Airframe<double> like = airframe_value<Px4Sih, double>();
  Identification usual;
  usual.thrust_m_s2 = {5, 0.1};
  usual.effectiveness_rad_s2 = {{{40, 1}, {40, 1}, {3.3, 0.1}}};
  usual.lag_s = {0.05, 0.005};
  usual.delay_s = {0.005, 0.002};
  REQUIRE(identified_airframe(usual, like).has_value());
  CHECK(!unlike_axes(usual));
  const auto refused = [&](const std::string& key, const auto& change) {
    CAPTURE(key);
    Identification found = usual;
    change(found);
    CHECK_FALSE(identified_airframe(found, like).has_value());
    const auto number = implausible_number(found, like);
    REQUIRE(number.has_value());
    CHECK(number->key == key);
    CHECK(!number->range.holds(number->value));
  };
  refused("rotor_lag_s", [](Identification& found) { found.lag_s = {1.33, 0.1}; });
  refused("fall_s", [](Identification& found) {
    found.rise_s = {0.05, 0.01};
    found.fall_s = {0.3, 0.02};
    found.fall_after_rise_s = {0.25, 0.03};
  });
  refused("delay_s", [](Identification& found) { found.delay_s = {-0.528, 0.074}; });
  refused("delay_s", [](Identification& found) { found.delay_s = {0.3, 0.05}; });
  refused("roll_effectiveness_rad_s2", [](Identification& found) { found.effectiveness_rad_s2[0] = {3, 0.5}; });
  refused("pitch_effectiveness_rad_s2", [](Identification& found) { found.effectiveness_rad_s2[1] = {2300, 50}; });
  refused("yaw_effectiveness_rad_s2", [](Identification& found) { found.effectiveness_rad_s2[2] = {300, 5}; });
  refused("inertia_x", [](Identification& found) {
    found.effectiveness_rad_s2 = {{{1400, 5}, {1400, 5}, {3, 1}}}, found.thrust_m_s2 = {2.6, 0.1};
  });
  // what the flights do not tell to a half is not taken, and refuses nothing
  Identification vague = usual;
  vague.lag_s = {1.33, 1.2};
  vague.delay_s = {0.3, 0.4};
  CHECK(identified_airframe(vague, like).has_value());
  Identification unlike = usual;
  unlike.effectiveness_rad_s2[1] = {12, 1};
  CHECK(unlike_axes(unlike).value_or(0) == doctest::Approx(40.0 / 12));
  CHECK(identified_airframe(unlike, like).has_value());
}

TEST_CASE("of commands that were filtered before they were logged no lag is told that the fit did not converge to") {
  std::mt19937_64 engine(3);
  const Vehicle vehicle(airframe_value<Px4Sih, double>(), paper_site<double>(), QuadraticDrag{}, LinearDamping{});
  FlightPlan plan;
  plan.controls_per_sample = 5;
  plan.samples = 6000;
  RecorderErrors errors;
  errors.gyro_noise_rad_s = 0.02;
  errors.velocity_noise_m_s = 0.03;
  errors.attitude_noise_rad = 0.005;
  Flight rows = fly(vehicle, AgileFlight::pilot(vehicle, engine), plan,
                    NoisyRecorder<std::mt19937_64>(std::mt19937_64(5), errors))
                    .flight;
  constexpr double filter_s = 0.1;
  const double share = 1 - std::exp(-plan.sample_period_s() / filter_s);
  Commands<double> logged = rows[0].commands;
  for (Sample& sample : rows) {
    for (std::size_t k = 0; k < rotor_count; ++k) logged[k] += share * (sample.commands[k] - logged[k]);
    sample.commands = logged;
  }
  const Identification found = identify({rows, {0, rows.size()}}, signs_of(airframe_value<Px4Sih, double>()));
  CHECK_FALSE(is_told(found.lag_s, 0.5));
  CHECK((found.delay_held || std::abs(found.delay_s.value) <= 0.3));
}

TEST_CASE("a vehicle that stands still, or that turns against its commands, is none") {
  std::mt19937_64 engine(9);
  const DrawnVehicle drawn = drawn_vehicle(0, engine);
  const Flight rows = recorded(drawn, engine, ticks_a_row[1], 0.001);
  Flight still = rows, backwards = rows;
  for (Sample& sample : still) {
    sample.commands = {0.5, 0.5, 0.5, 0.5};
    sample.body_rates_rad_s.setZero();
  }
  const Airframe<double>& a = drawn.airframe;
  const Identification of_still = identify({still, {0, still.size()}}, signs_of(a));
  CHECK(std::isinf(of_still.effectiveness_rad_s2[0].half_width));
  CHECK(of_still.signed_sum_deviation[0] == 0);
  CHECK_FALSE(identified_airframe(of_still, a).has_value());
  for (Sample& sample : backwards) sample.body_rates_rad_s[0] *= -1;
  const Identification of_backwards = identify({backwards, {0, backwards.size()}}, signs_of(a));
  CHECK(of_backwards.effectiveness_rad_s2[0].high() < 0);
  CHECK_FALSE(identified_airframe(of_backwards, a).has_value());
  CHECK(identify({rows, {0, 20}}, signs_of(a)).duration_s == 0);
}
