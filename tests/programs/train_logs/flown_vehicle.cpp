// SPDX-License-Identifier: MIT
// The vehicle that models of logs are trained for: identified in flights of one that is known, given and contradicted,
// or assumed where the flights do not tell it.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "simulated_dataset.hpp"
#include "training/closed_loop.hpp"
#include "training/fits.hpp"
#include "training/flown_vehicle.hpp"

namespace {

using pinnquad::Sample;

/// Turns and climbs otherwise than the paper's quadrotor, with slow rotors.
programs::NamedAirframe other_vehicle() {
  programs::NamedAirframe made{"other", pinnquad::airframe_value<pinnquad::Px4Sih, double>()};
  made.value.mass_kg = 1.3;
  made.value.inertia_kg_m2 = {0.03, 0.02, 0.04};
  made.value.drag_area_m2 = {0.1, 0.1, 0.1};
  return made;
}

pinnquad::logs::ImportedDataset flights_of(const pinnquad::Airframe<double>& airframe) {
  using namespace pinnquad;
  const auto vehicle = flight_vehicle<AgileFlight>(airframe);
  logs::ImportedDataset dataset;
  for (int seed = 1; seed <= 3; ++seed) {
    FlightPlan plan = AgileFlight::plan();
    plan.samples = 3000;
    Flight flight =
        fly(vehicle, AgileFlight::pilot(vehicle, std::mt19937_64(static_cast<std::uint64_t>(seed))), plan).flight;
    flight.name = "flight" + std::to_string(seed);
    dataset.sources.push_back(flight.name + ".csv");
    dataset.flights.add(std::move(flight));
  }
  return dataset;
}

const pinnquad::logs::ImportedDataset& flights() {
  static const pinnquad::logs::ImportedDataset dataset = flights_of(other_vehicle().value);
  return dataset;
}

programs::FlownVehicle flown(const std::optional<programs::NamedAirframe>& given,
                             const pinnquad::logs::ImportedDataset& dataset) {
  programs::HoldOutChoice choice;
  choice.names = {"flight2"};
  return programs::flown_vehicle(given, dataset, dataset.sources, programs::folds_of(dataset.flights, choice));
}

/// No command says anything of the pitch.
pinnquad::logs::ImportedDataset without_pitch() {
  pinnquad::logs::ImportedDataset dataset;
  dataset.sources = flights().sources;
  for (pinnquad::Flight flight : flights().flights.flights()) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise;
    for (Sample& sample : flight) sample.body_rates_rad_s[1] = noise(random);
    dataset.flights.add(std::move(flight));
  }
  return dataset;
}

}  // namespace

TEST_CASE("the vehicle of flights without an airframe is the one that flew, by those that are not held out") {
  const programs::FlownVehicle vehicle = flown({}, flights());
  CHECK(vehicle.flights == std::vector<std::string>{"flight1", "flight3"});
  REQUIRE(vehicle.identified());
  CHECK(vehicle.is_known());
  CHECK(vehicle.airframe.name == "identified");
  const auto truth = pinnquad::logs::rotor_effects(other_vehicle().value);
  const auto found = pinnquad::logs::rotor_effects(vehicle.airframe.value);
  CHECK(found[0] == doctest::Approx(truth[0]).epsilon(0.03));
  for (std::size_t axis = 1; axis < 4; ++axis) CHECK(found[axis] == doctest::Approx(truth[axis]).epsilon(0.06));
  CHECK(vehicle.airframe.value.rotor_time_constant_s ==
        doctest::Approx(other_vehicle().value.rotor_time_constant_s).epsilon(0.2));
  const nlohmann::json told = programs::vehicle_json(vehicle);
  CHECK(told["numbers"]["roll_effectiveness_rad_s2"]["low"] < truth[1]);
  CHECK(programs::identified_in_words(vehicle.asked->found).find("yaw effectiveness") != std::string::npos);

  const programs::IdentifiedQuadrotor quadrotor = programs::identified_quadrotor(*vehicle.asked);
  pinnquad::Commands<double> of_truth{}, of_found{};
  using Vehicle = pinnquad::Quadrotor<double, pinnquad::QuadraticDrag>;
  REQUIRE(pinnquad::hover_trim(Vehicle(other_vehicle().value), {0, 0, -20}, of_truth) == pinnquad::Status::ok);
  REQUIRE(pinnquad::hover_trim(quadrotor, {0, 0, -20}, of_found) == pinnquad::Status::ok);
  for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
    CHECK(of_found[i] == doctest::Approx(of_truth[i]).epsilon(0.03));
  }
}

TEST_CASE("an airframe that is given stays, and is contradicted where the flights exclude it by more than a fifth") {
  const programs::FlownVehicle right = flown(other_vehicle(), flights());
  CHECK(right.airframe.name == "other");
  CHECK(right.doubts.empty());
  programs::NamedAirframe wrong = other_vehicle();
  wrong.value.inertia_kg_m2[0] *= 1.5;
  const programs::FlownVehicle doubted = flown(wrong, flights());
  CHECK(doubted.airframe.value.inertia_kg_m2[0] == wrong.value.inertia_kg_m2[0]);
  REQUIRE(doubted.doubts.size() == 1);
  CHECK(doubted.doubts.front().find("roll effectiveness") == 0);
  wrong = other_vehicle();
  wrong.value.mass_kg *= 1.5;  // the turns stay
  REQUIRE(flown(wrong, flights()).doubts.size() == 1);
  CHECK(flown(wrong, flights()).doubts.front().find("the hover command") == 0);
}

TEST_CASE("flights that do not tell a vehicle leave it assumed: it hovers as they do, and is not flown") {
  const pinnquad::logs::ImportedDataset dataset = without_pitch();
  const programs::FlownVehicle vehicle = flown({}, dataset);
  CHECK_FALSE(vehicle.identified());
  CHECK_FALSE(vehicle.is_known());
  CHECK(vehicle.airframe.name == "paper_quadrotor, assumed");
  CHECK(std::count(vehicle.unknown.begin(), vehicle.unknown.end(), "pitch effectiveness") == 1);
  CHECK(pinnquad::logs::rotor_effects(vehicle.airframe.value)[0] ==
        doctest::Approx(pinnquad::logs::rotor_effects(other_vehicle().value)[0]).epsilon(0.05));
  CHECK(programs::vehicle_json(vehicle)["airframe"] == "assumed");
  const programs::NamedAirframe given = other_vehicle();
  CHECK(flown(given, dataset).is_known());

  // refused before a number is asked for
  pinnquad::logs::ImportedDataset still = dataset;
  still.flights = {};
  for (pinnquad::Flight flight : dataset.flights.flights()) {
    for (Sample& sample : flight) sample.body_rates_rad_s.setZero();
    still.flights.add(std::move(flight));
  }
  const programs::FlownVehicle refused = flown({}, still);
  CHECK(refused.asked->why_not.find("w_x") != std::string::npos);
  CHECK(refused.unknown.size() == 4);
  CHECK(pinnquad::logs::rotor_effects(refused.airframe.value)[0] ==
        doctest::Approx(pinnquad::logs::rotor_effects(other_vehicle().value)[0]).epsilon(0.1));
}

TEST_CASE("damping, linear drag and trim act on the identified vehicle where the flights tell them") {
  pinnquad::Identification found;
  found.thrust_m_s2 = {5, 0};
  found.effectiveness_rad_s2[2] = {4, 0};
  found.imbalance[2] = {0.1, 0.01};
  found.damping_1_s = {{{3, 1}, {2, 1.5}, {-1, 0.1}}};
  found.linear_drag_1_s = {{{0.5, 0.1}, {0.4, 0.3}, {-0.2, 0.05}}};
  found.by_velocity_rad_s_m = {{{0.7, 0.1}, {-0.3, 0.1}, {0.1, 0.1}}};
  const programs::IdentifiedAir air(found);
  const auto airframe = other_vehicle().value;
  pinnquad::AeroCondition<double> condition;
  condition.body_rates_rad_s = {2, -1, 1};
  condition.air_relative_velocity_m_s = {1, -2, 3};
  const auto wrench = air.wrench(condition, airframe);
  CHECK(wrench.torque_N_m[0] == doctest::Approx((-3 * 2 + 0.7 * -2) * airframe.inertia_kg_m2[0]));
  CHECK(wrench.torque_N_m[1] == doctest::Approx(-0.3 * 1 * airframe.inertia_kg_m2[1]));
  const double trim_rad_s2 = 0.1 * 4 * pinnquad::standard_gravity_m_s2<double> / 5;
  CHECK(wrench.torque_N_m[2] == doctest::Approx(trim_rad_s2 * airframe.inertia_kg_m2[2]));
  CHECK(wrench.force_N[0] == doctest::Approx(-0.5 * airframe.mass_kg));
  CHECK(wrench.force_N[1] == 0);
  CHECK(wrench.force_N[2] == 0);
}

TEST_CASE("a vehicle that leaves its path by more than the figure, or falls, is lost") {
  const auto flown = [](double model_m, double trim_m, const char* status) {
    return nlohmann::json{{"half_length_m", 0.5},
                          {"model", {{"status", status}, {"largest_error_m", model_m}}},
                          {"without_jerk", {{"status", "ok"}, {"largest_error_m", trim_m}}}};
  };
  CHECK_FALSE(programs::lost_vehicle(flown(1.9, 1, "ok")));
  CHECK(programs::lost_vehicle(flown(2.1, 1, "ok")));
  CHECK(programs::lost_vehicle(flown(0.1, 1, "not_finite")));
  CHECK(programs::lost_vehicle(flown(std::nan(""), 1, "ok")));
  CHECK_FALSE(programs::lost_vehicle({}));
  CHECK_FALSE(programs::lost_vehicle({{"why_not", "no vehicle"}}));
}

TEST_CASE(
    "beside the formula's, commands of motors that were swapped move the wrong way, whatever the feedback makes good") {
  using namespace pinnquad;
  const auto airframe = PaperQuadrotor::value<double>();
  const Quadrotor<double, QuadraticDrag> vehicle(airframe);
  const AnalyticInverse<Quadrotor<double, QuadraticDrag>> formula(vehicle);
  struct Swapped {
    AnalyticInverse<Quadrotor<double, QuadraticDrag>> formula;
    std::array<std::size_t, 4> order;
    double scale;
    Status operator()(const State<double>& state, const Accelerations<double>& desired, std::uint64_t time_us,
                      Commands<double>& commands) const noexcept {
      Commands<double> own{};
      const Status status = formula(state, desired, time_us, own);
      for (std::size_t i = 0; i < 4; ++i) commands[i] = scale * own[order[i]];
      return status;
    }
  };
  const auto compared = [&](const std::array<std::size_t, 4>& order, double scale) {
    programs::ComparedCommands sums;
    programs::ComparedPolicy<Swapped, decltype(formula)> policy{{formula, order, scale}, formula, airframe, &sums};
    std::mt19937_64 random(3);
    State<double> state;
    state.velocity_m_s = {1, 0.5, 0};
    for (int tick = 0; tick < 200; ++tick) {
      Accelerations<double> desired;
      for (int axis = 0; axis < 3; ++axis) desired.angular_rad_s2[axis] = uniform(random, -3, 3);
      desired.linear_m_s2[2] = uniform(random, -1, 1);
      Commands<double> commands{};
      CHECK(policy(state, desired, 0, commands) == Status::ok);
    }
    return programs::comparison_json(sums);
  };
  const auto same = compared({0, 1, 2, 3}, 1);
  CHECK(programs::turned_round(same).empty());
  for (const char* sum : programs::sum_names) {
    CHECK(same[sum]["slope"].get<double>() == doctest::Approx(1));
    CHECK(same[sum]["rms_difference"].get<double>() < 1e-9);
  }
  CHECK(compared({0, 1, 2, 3}, 0.8)["yaw"]["slope"].get<double>() == doctest::Approx(0.8));
  const auto swapped = compared({1, 0, 3, 2}, 1);
  CHECK(swapped["thrust"]["slope"].get<double>() == doctest::Approx(1));
  CHECK(programs::turned_round(swapped).find("against the formula's") != std::string::npos);
  CHECK(programs::unfit_to_fly(
            {{"model", {{"answered_share", 1}, {"status", "ok"}, {"largest_error_m", 0.1}, {"rmse_m", 0.1}}},
             {"formula", {{"rmse_m", 0.1}}},
             {"without_jerk", {{"largest_error_m", 0.1}, {"rmse_m", 0.2}}},
             {"half_length_m", 1},
             {"against_formula", swapped}}) == programs::turned_round(swapped));
}
