// SPDX-License-Identifier: MIT
// The exported demo model on ordinary flights that it was not trained on: how often its guard falls back, and what for.
// Here and not beside the guard, because inference may not include simulation.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>

#include "../examples/models/demo_quadrotor.hpp"
#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "support/long_flight.hpp"

namespace {

using namespace pinnquad;

using Flight = AgileFlight;
using Vehicle = Flight::Vehicle;
using Formula = AnalyticInverse<Vehicle>;
using FallingBack = Extend<TrainingGuard, Fallback<Formula>>;
using FlownAlone = InverseDynamics<DemoQuadModel, FallingBack>;

constexpr double largest_fallback_share = 0.05;

struct Tally {
  int rows = 0;
  std::array<int, static_cast<std::size_t>(status_count)> by_status{};
  double network_error = 0, fallback_error = 0;  ///< sums over rows of the mean |command - formula|

  int of(Status status) const { return by_status[static_cast<std::size_t>(status)]; }
};

/// Then both answer (Fallback in inference/guard.hpp).
template <class Report>
bool outside_by_angular_acceleration_alone(const Report& report) {
  bool other = false;
  for (std::size_t i = 0; i < report.excess.size(); ++i) other |= (i < 3 || i > 5) && report.excess[i] > 0;
  return report.worst_feature >= 0 && !other;
}

Tally flown(std::uint64_t seed, double max_speed_m_s) {
  const Vehicle vehicle(airframe_value<PaperQuadrotor, double>(), paper_site<double>(), {}, {});
  const Formula formula(vehicle);
  const FlownAlone inverse{FallingBack(formula)};
  Tally tally;
  const auto row = [&](const auto& flies) {
    const auto inputs = sample_inputs<MotionInputs<float>>(flies.recording().back());
    const PlaceAndTime<double> place{flies.vehicle().body.position_m, flies.vehicle().time_s};
    Commands<float> commands{}, expected{};
    FlownAlone::Report report;
    const Status status = inverse.predict(inputs, place, commands, report);
    ++tally.rows;
    ++tally.by_status[static_cast<std::size_t>(status)];
    REQUIRE(formula(inputs, place, expected) == Status::ok);
    double error = 0;
    for (std::size_t i = 0; i < 4; ++i) error += std::fabs(static_cast<double>(commands[i] - expected[i])) / 4;
    if (!outside_by_angular_acceleration_alone(report)) {
      (status == Status::fell_back ? tally.fallback_error : tally.network_error) += error;
    }
  };
  const auto recorded = fly(vehicle, Flight::pilot(vehicle, std::mt19937_64(seed), max_speed_m_s), Flight::plan(), row);
  REQUIRE(recorded.report.status == Status::ok);
  return tally;
}

/// Checks what holds of every flight; the share of rows that fell back.
double checked_share(std::uint64_t seed, double max_speed_m_s) {
  const Tally tally = flown(seed, max_speed_m_s);
  const int fallbacks = tally.of(Status::fell_back);
  const double share = static_cast<double>(fallbacks) / tally.rows;
  CHECK(tally.rows == 15000);
  CHECK(tally.of(Status::ok) + fallbacks == tally.rows);
  CHECK(tally.fallback_error == 0);
  CHECK(tally.network_error > 0);
  CHECK(tally.network_error / tally.of(Status::ok) < 0.05);  // in commands
  return share;
}

}  // namespace

TEST_CASE("ordinary flights: the network flies nearly all of them, the formula the rest, and nobody declines" *
          pinnquad::test::long_flight()) {
  double sum = 0;
  for (const std::uint64_t seed : {1001u, 1002u, 1003u}) {
    const double share = checked_share(seed, PilotStyle{}.max_speed_m_s);
    CHECK(share <= largest_fallback_share);
    sum += share;
  }
  CHECK(sum > 0);  // or the fallback was not tried
}

TEST_CASE("flown faster than it was trained, the network gives way to the formula") {
  CHECK(checked_share(1004, 1.5 * PilotStyle{}.max_speed_m_s) > 0.02);
}

TEST_CASE(
    "a pure roll demand in level hover: inside the envelope, far from the data, too little torque "
    "(docs/in_flight.md)") {
  const Vehicle vehicle(airframe_value<PaperQuadrotor, double>(), paper_site<double>(), {}, {});
  const Formula formula(vehicle);
  const PlaceAndTime<double> place{Vector3<double>(0, 0, -20), 0};
  const auto torque = [](const Commands<float>& u) { return -u[0] + u[1] + u[2] - u[3]; };
  for (const float roll_rad_s2 : {-60.0F, -50.0F, -40.0F, 40.0F, 50.0F, 60.0F}) {
    CAPTURE(roll_rad_s2);
    MotionInputs<float> inputs;
    inputs.angular_acceleration_rad_s2[0] = roll_rad_s2;
    Commands<float> alone{}, wanted{};
    CHECK(FlownAlone{FallingBack(formula)}.predict(inputs, place, alone) == Status::ok);
    REQUIRE(formula(inputs, place, wanted) == Status::ok);
    CHECK(torque(alone) / torque(wanted) < 0.8F);
  }
}
