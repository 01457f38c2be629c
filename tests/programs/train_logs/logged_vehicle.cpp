// SPDX-License-Identifier: MIT
// The vehicle that logs show: found again in flights of one that is known, and turned down where the commands do not
// fly it.
#include <doctest/doctest.h>

#include <cmath>

#include "simulated_dataset.hpp"
#include "training/closed_loop.hpp"
#include "training/fits.hpp"
#include "training/logged_vehicle.hpp"

namespace {

using pinnquad::Sample;

programs::NamedAirframe paper_quadrotor() {
  programs::NamedAirframe given;
  given.name = pinnquad::PaperQuadrotor::name;
  given.value = pinnquad::airframe_value<pinnquad::PaperQuadrotor, double>();
  return given;
}

programs::LoggedEffects effects_of(const pinnquad::Flight& flight) {
  return programs::logged_effects({flight, {0, flight.size()}}, programs::axis_signs(paper_quadrotor()));
}

}  // namespace

TEST_CASE("thrust, turning and drag of a known vehicle are found in its flight") {
  const auto truth = paper_quadrotor().value;
  const pinnquad::Flight flight = pinnquad_test::simulated_flight("flight", 1, 6000);
  const programs::LoggedEffects effects = effects_of(flight);
  const double density = pinnquad::rated_air_density_kg_m3<double>;
  const double rotor_N = truth.thrust_coefficient * density * std::pow(truth.max_rotor_speed_rev_s, 2) *
                         std::pow(truth.propeller_diameter_m, 4);
  const double rotor_N_m = rotor_N * truth.power_coefficient / truth.thrust_coefficient * truth.propeller_diameter_m /
                           (2 * 3.141592653589793);
  CHECK(effects.thrust_m_s2 == doctest::Approx(rotor_N / truth.mass_kg).epsilon(0.02));
  // the rotors' lag of 5 ms takes a little of the quick turns
  CHECK(effects.turn_rad_s2[0] ==
        doctest::Approx(rotor_N * truth.rotors[0].y_m / truth.inertia_kg_m2[0]).epsilon(0.08));
  CHECK(effects.turn_rad_s2[1] ==
        doctest::Approx(rotor_N * truth.rotors[0].x_m / truth.inertia_kg_m2[1]).epsilon(0.08));
  CHECK(effects.turn_rad_s2[2] == doctest::Approx(rotor_N_m / truth.inertia_kg_m2[2]).epsilon(0.05));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    CHECK(effects.drag_per_m[axis] == doctest::Approx(truth.drag_area_m2[axis] * density / truth.mass_kg).epsilon(0.1));
  }

  const auto made = programs::logged_vehicle(truth, effects);
  REQUIRE(made.has_value());
  pinnquad::HoverTrim<double> of_truth, of_made;
  using Vehicle = pinnquad::Quadrotor<double, pinnquad::QuadraticDrag>;
  REQUIRE(pinnquad::hover_trim(Vehicle(truth), {0, 0, -20}, of_truth) == pinnquad::Status::ok);
  REQUIRE(pinnquad::hover_trim(Vehicle(*made), {0, 0, -20}, of_made) == pinnquad::Status::ok);
  for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
    CHECK(of_made.commands[i] == doctest::Approx(of_truth.commands[i]).epsilon(0.02));
  }
}

TEST_CASE("the damping and the trim of the turns are found apart from what the commands do, and act on the vehicle") {
  const auto truth = paper_quadrotor().value;
  pinnquad::Flight flight = pinnquad_test::simulated_flight("flight", 2, 3000);
  const auto signs = programs::axis_signs(paper_quadrotor());
  for (Sample& sample : flight) {
    for (int axis = 0; axis < 3; ++axis) {
      const double turn = pinnquad::signed_sum(signs[std::size_t(axis)], sample.commands);
      sample.angular_acceleration_rad_s2[axis] =
          (80 - 20 * axis) * turn - (3 - axis) * sample.body_rates_rad_s[axis] + axis;
    }
  }
  const programs::LoggedEffects effects = effects_of(flight);
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    CHECK(effects.turn_rad_s2[std::size_t(axis)] == doctest::Approx(80 - 20 * axis));
    CHECK(effects.damping_1_s[std::size_t(axis)] == doctest::Approx(3 - axis));
    CHECK(effects.trim_rad_s2[std::size_t(axis)] == doctest::Approx(axis).scale(1));
  }
  pinnquad::AeroCondition<double> condition;
  condition.body_rates_rad_s = {2, -1, 0};
  const programs::LoggedTorque torque{effects.damping_1_s, effects.trim_rad_s2};
  const auto wrench = torque.wrench(condition, truth);
  CHECK(wrench.torque_N_m[0] == doctest::Approx(-6 * truth.inertia_kg_m2[0]));
  CHECK(wrench.torque_N_m[1] == doctest::Approx((1 + 2) * truth.inertia_kg_m2[1]));
  CHECK(wrench.torque_N_m[2] == doctest::Approx(2 * truth.inertia_kg_m2[2]));

  // what would drive a turn on is no damping
  for (Sample& sample : flight) sample.angular_acceleration_rad_s2[0] += 9 * sample.body_rates_rad_s[0];
  CHECK(effects_of(flight).damping_1_s[0] == 0);
}

TEST_CASE("a vehicle that leaves its path by more than the figure, or falls, is lost") {
  const auto flown = [](double model_m, double trim_m, const char* status) {
    return nlohmann::json{{"half_length_m", 0.5},
                          {"model", {{"status", status}, {"largest_error_m", model_m}}},
                          {"hover_trim", {{"status", "ok"}, {"largest_error_m", trim_m}}}};
  };
  CHECK_FALSE(programs::lost_vehicle(flown(1.9, 1, "ok")));
  CHECK(programs::lost_vehicle(flown(2.1, 1, "ok")));
  CHECK(programs::lost_vehicle(flown(0.1, 1, "not_finite")));
  CHECK(programs::lost_vehicle(flown(std::nan(""), 1, "ok")));
  CHECK_FALSE(programs::lost_vehicle({}));
  CHECK_FALSE(programs::lost_vehicle({{"why_not", "no vehicle"}}));
}

TEST_CASE("commands that do not fly the vehicle show none; air that pushes along is no drag") {
  const auto truth = paper_quadrotor().value;
  const pinnquad::Flight flight = pinnquad_test::simulated_flight("flight", 1, 3000);
  pinnquad::Flight turned = flight, pushed = flight;
  for (Sample& sample : turned) sample.angular_acceleration_rad_s2[1] *= -1;
  CHECK_FALSE(programs::logged_vehicle(truth, effects_of(turned)).has_value());
  for (Sample& sample : pushed) sample.linear_acceleration_m_s2[0] += 3 * sample.velocity_m_s[0];
  CHECK(effects_of(pushed).drag_per_m[0] == 0);
  CHECK(programs::logged_vehicle(truth, effects_of(pushed)).has_value());

  pinnquad::Flight still = flight;
  for (Sample& sample : still) {
    sample.linear_acceleration_m_s2 += pinnquad::cross<double>(sample.body_rates_rad_s, sample.velocity_m_s);
    sample.velocity_m_s.setZero();  // as a log without velocity is imported
  }
  for (const double drag : effects_of(still).drag_per_m) CHECK(drag == 0);
  CHECK(programs::logged_vehicle(truth, effects_of(still)).has_value());
}
